/* Dahl: with w = 1 - (F/F_C) sgn v, abs(w)^(1-gamma) falls by (1-gamma) (sigma/F_C) abs(v) dt, for gamma = 1
 * log abs(w) by (sigma/F_C) abs(v) dt; for gamma < 1 it ends at w = 0. Exact for constant v. */
static inline double duhem_contact(const duhem_params *p, duhem_friction *f, double v, double dt)
{
    const double s = duhem_sgn(v);
    const double w = 1.0 - s * f->z[0] / p->f_c;
    const double way = p->sigma / p->f_c * fabs(v) * dt;
    const double e = 1.0 - p->gamma;
    double left;

    if (s == 0.0 || w == 0.0) {
        return f->z[0];
    }
    if (e == 0.0) {
        left = exp(-way);
    } else {
        const double fall = e * way * pow(fabs(w), -e);
        left = fall < 1.0 ? exp(log1p(-fall) / e) : 0.0;
    }
    f->z[0] = s * p->f_c * (1.0 - w * left);
    return f->z[0];
}

/* No force is larger. */
static inline double duhem_bound(const duhem_params *p, const duhem_friction *f, double dt)
{
    (void)dt;
    return fmax(p->f_c, fabs(f->z[0]));
}
