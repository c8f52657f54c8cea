/* m a = F_e - F - k_s q: mass, stiffness, damping, and what drives. */
static inline double duhem_mass(const duhem_params *p)
{
    return p->mass;
}

static inline double duhem_stiffness(const duhem_params *p)
{
    return p->stiffness;
}

static inline double duhem_damping(const duhem_params *p)
{
    (void)p;
    return 0.0;
}

static inline double duhem_drive(const duhem_params *p, double input, double q)
{
    (void)p, (void)q;
    return input;
}
