/* M a = gain input - F: mass, stiffness, damping, and what drives. */
static inline double duhem_mass(const duhem_params *p)
{
    return p->inertia;
}

static inline double duhem_stiffness(const duhem_params *p)
{
    (void)p;
    return 0.0;
}

static inline double duhem_damping(const duhem_params *p)
{
    (void)p;
    return 0.0;
}

static inline double duhem_drive(const duhem_params *p, double input, double q)
{
    (void)q;
    return p->gain * input;
}
