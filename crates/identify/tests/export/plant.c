/* Reads inputs and durations, writes the displacement, the velocity and the friction at the end of each. */
#include "model.h"
#include <stdio.h>

int main(void)
{
    const duhem_params p = DUHEM_PARAMS;
    duhem_state s = DUHEM_STATE;
    double input, dt;

    while (scanf("%lf %lf", &input, &dt) == 2) {
        duhem_plant_step(&p, &s, input, dt);
        printf("%.17g %.17g %.17g\n", s.q, s.v, s.friction.force);
    }
    return 0;
}
