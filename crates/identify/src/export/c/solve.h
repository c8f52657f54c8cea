/* a v + F(v) - b, where F is the contact's force after dt at v. */
static inline double duhem_excess(const duhem_params *p, const duhem_friction *f, double a, double b,
                                  double dt, double v)
{
    duhem_friction trial = *f;

    return a * v - b + duhem_contact(p, &trial, v, dt);
}

/* The v at which a v + F(v) = b, the first one met from the v given, and moves the contact on to it; its force
 * in *force. Widening steps until the sign changes, 18 at most, then Ridders' method, 60 times at most, each
 * of which halves the bracket or better. */
static inline double duhem_solve(const duhem_params *p, duhem_friction *f, double a, double b, double dt,
                                 double v, double *force)
{
    const double farthest = (fabs(b) + duhem_bound(p, f, dt)) / a;
    double low = duhem_clip(v, farthest), at_low = duhem_excess(p, f, a, b, dt, low);
    double high = low, at_high = at_low, step = -duhem_sgn(at_low) * farthest * 1e-9;
    int i;

    for (i = 0; i < 18 && at_low * at_high > 0.0; i++) {
        low = high, at_low = at_high;
        high = duhem_clip(low + step, farthest);
        at_high = duhem_excess(p, f, a, b, dt, high);
        step *= 4.0;
    }
    for (i = 0; i < 60 && at_low * at_high < 0.0 && fabs(high - low) > 1e-16 * farthest; i++) {
        const double middle = 0.5 * (low + high);
        const double at_middle = duhem_excess(p, f, a, b, dt, middle);
        const double root = sqrt(at_middle * at_middle - at_low * at_high);
        const double way = (middle - low) * duhem_sgn(at_low - at_high) * at_middle;
        const double next = root > 0.0 ? middle + way / root : middle;
        const double at_next = duhem_excess(p, f, a, b, dt, next);

        if (at_middle * at_next < 0.0) {
            low = middle, at_low = at_middle;
            high = next, at_high = at_next;
        } else if (at_low * at_next < 0.0) {
            high = next, at_high = at_next;
        } else {
            low = next, at_low = at_next;
        }
    }
    if (fabs(at_low) < fabs(at_high)) {
        high = low;
    }
    *force = duhem_contact(p, f, high, dt);
    return high;
}
