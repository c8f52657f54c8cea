/* Reads velocities and durations, writes the friction at the end of each. */
#include "model.h"
#include <stdio.h>

int main(void)
{
    const duhem_params p = DUHEM_PARAMS;
    duhem_friction f = DUHEM_FRICTION;
    double velocity, dt;

    while (scanf("%lf %lf", &velocity, &dt) == 2) {
        printf("%.17g\n", duhem_friction_step(&p, &f, velocity, dt));
    }
    return 0;
}
