/* LuGre: z' = v - abs(v)/r(v) z with r = (F_C + (F_S - F_C) exp(-(v/v_S)^2))/sigma_0, linear in z for
 * constant v, so z goes to r sgn v as exp(-abs(v) dt/r). Exact. The force is sigma_0 z + sigma_1 z'. */
static inline double duhem_contact(const duhem_params *p, duhem_friction *f, double v, double dt)
{
    const double s = v / p->v_s;
    const double r = (p->f_c + (p->f_s - p->f_c) * exp(-s * s)) / p->sigma_0;

    f->z[0] += (r * duhem_sgn(v) - f->z[0]) * -expm1(-fabs(v) * dt / r);
    return p->sigma_0 * f->z[0] + p->sigma_1 * (v - fabs(v) / r * f->z[0]);
}

/* No force is further on the wrong side of zero: where r falls with speed, z is above it, and sigma_1 z'
 * pulls back by sigma_1 (z - r) x exp(-x)/dt with x = abs(v) dt/r, which is below sigma_1 z/(2 dt). */
static inline double duhem_bound(const duhem_params *p, const duhem_friction *f, double dt)
{
    const double z = fmax(fabs(f->z[0]), fmax(p->f_c, p->f_s) / p->sigma_0);

    return (p->sigma_0 + p->sigma_1 / dt) * z;
}
