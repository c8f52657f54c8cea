/* Moves the contact on by dt [s] at constant velocity and returns the friction at the end of it: the force of
 * the model, plus sigma_2 velocity, plus offset; positive when it opposes a positive velocity. Exact. */
static inline double duhem_friction_step(const duhem_params *p, duhem_friction *f, double velocity,
                                         double dt)
{
    f->force = duhem_contact(p, f, velocity, dt) + p->sigma_2 * velocity + p->offset;
    return f->force;
}
