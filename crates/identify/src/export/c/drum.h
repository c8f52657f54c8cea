/* I a = k_m i - T_f - (F_10 - F_20) r - (k_1 + k_2) r^2 q: inertia, stiffness, damping, and what drives. */
static inline double duhem_mass(const duhem_params *p)
{
    return p->inertia;
}

static inline double duhem_stiffness(const duhem_params *p)
{
    return (p->k_1 + p->k_2) * p->radius * p->radius;
}

static inline double duhem_damping(const duhem_params *p)
{
    (void)p;
    return 0.0;
}

static inline double duhem_drive(const duhem_params *p, double input, double q)
{
    (void)q;
    return p->motor_constant * input - (p->f_10 - p->f_20) * p->radius;
}
