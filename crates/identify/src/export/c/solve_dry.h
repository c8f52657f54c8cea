/* The v at which a v + F = b, where F is any force up to F_C at rest; the force in *force. */
static inline double duhem_solve(const duhem_params *p, duhem_friction *f, double a, double b, double dt,
                                 double v, double *force)
{
    (void)f, (void)dt, (void)v;
    *force = duhem_clip(b, DUHEM_DRY(p));
    return (b - *force) / a;
}
