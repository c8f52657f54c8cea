/* sgn v, 0 at rest. */
static inline double duhem_sgn(double v)
{
    return v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0;
}

/* x, cut at -limit and limit. */
static inline double duhem_clip(double x, double limit)
{
    return x > limit ? limit : x < -limit ? -limit : x;
}
