/* I a = K_t (V - K_t v)/R - m g l sin q - T_f: inertia, stiffness, damping, and what drives. */
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
    return p->torque_constant * p->torque_constant / p->resistance;
}

static inline double duhem_drive(const duhem_params *p, double input, double q)
{
    return p->torque_constant * input / p->resistance - p->mass * 9.81 * p->length * sin(q);
}
