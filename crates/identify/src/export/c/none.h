/* No friction of the contact. */
static inline double duhem_contact(const duhem_params *p, duhem_friction *f, double v, double dt)
{
    (void)p, (void)f, (void)v, (void)dt;
    return 0.0;
}
