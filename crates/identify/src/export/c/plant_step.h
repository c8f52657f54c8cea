/* Moves plant and contact on by dt > 0 [s] with the input held: the velocity at the end from one equation in which
 * spring, damping and friction are those of the end, then q by that velocity. Of first order, stable at every
 * dt at which gravity, taken at the start, is slow. state->friction.force is the friction at the end; at rest
 * under Coulomb friction the force that holds. Bounded time, no allocation, no recursion. */
static inline void duhem_plant_step(const duhem_params *p, duhem_state *state, double input, double dt)
{
    const double k = duhem_stiffness(p);
    const double a = duhem_mass(p) / dt + duhem_damping(p) + p->sigma_2 + k * dt;
    const double b = duhem_mass(p) / dt * state->v + duhem_drive(p, input, state->q) - k * state->q
        - p->offset;
    double force;

    state->v = duhem_solve(p, &state->friction, a, b, dt, state->v, &force);
    state->q += dt * state->v;
    state->friction.force = force + p->sigma_2 * state->v + p->offset;
}
