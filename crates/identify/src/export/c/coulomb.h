/* Coulomb: F = F_C sgn v, 0 at rest. */
static inline double duhem_contact(const duhem_params *p, duhem_friction *f, double v, double dt)
{
    (void)f, (void)dt;
    return p->f_c * duhem_sgn(v);
}
