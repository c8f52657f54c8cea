/* Maxwell-slip: each spring is stretched by v dt and slips at its deadband. Exact for constant v. */
static inline double duhem_contact(const duhem_params *p, duhem_friction *f, double v, double dt)
{
    double force = 0.0;
    int i;

    for (i = 0; i < DUHEM_STATES; i++) {
        f->z[i] = duhem_clip(f->z[i] + v * dt, p->delta[i]);
        force += p->k[i] * f->z[i];
    }
    return force;
}

/* No force is larger. */
static inline double duhem_bound(const duhem_params *p, const duhem_friction *f, double dt)
{
    double force = 0.0;
    int i;

    (void)f, (void)dt;
    for (i = 0; i < DUHEM_STATES; i++) {
        force += p->k[i] * p->delta[i];
    }
    return force;
}
