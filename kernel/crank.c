#include "crank.h"

#include "trigonometry.h"

void leg_gaps(const struct crank_legs *legs, const real position[3], const real rotation[9],
              real gap[3][LEGS])
{
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < LEGS; i++)
            gap[k][i] = leg_turned(rotation, legs->end, k, i) + (position[k] - legs->centre[k][i]);
}

int crank_elbows(const struct crank_legs *legs, const real position[3], const real rotation[9],
                 real out[LEGS], real *in)
{
    real gap[3][LEGS], y[LEGS], z[LEGS], side[LEGS], height[LEGS];
    leg_gaps(legs, position, rotation, gap);
    /* The triangle of crank, rod and gap, seen along the crank's axis: the crank's tip is `side`
       along the gap and `height` across it, both by EC / r. So (2.4). */
    for (int i = 0; i < LEGS; i++) {
        real x = leg_dot(legs->normal, gap, i), r = legs->crank[i], d = legs->rod[i];
        y[i] = leg_dot(legs->tangent, gap, i);
        z[i] = leg_dot(legs->up, gap, i);
        real in_plane = y[i] * y[i] + z[i] * z[i];
        /* (r - d)(r + d), not r^2 - d^2: the difference keeps its digits. */
        side[i] = (in_plane + x * x + (r - d) * (r + d)) / (2 * r);
        height[i] = in_plane - side[i] * side[i];
    }
    int open = 0;
    for (int i = 0; i < LEGS; i++)
        open += !(height[i] >= 0); /* counts what is not a number, too */
    for (int i = 0; i < LEGS; i++) {
        real h = real_sqrt(height[i]);
        real angle = angle_of(side[i] * z[i] + h * y[i], side[i] * y[i] - h * z[i]);
        out[i] = within_half_a_turn(angle, legs->middle[i]);
    }
    for (int i = 0; in && i < LEGS; i++) {
        real h = real_sqrt(height[i]);
        real angle = angle_of(side[i] * z[i] - h * y[i], side[i] * y[i] + h * z[i]);
        in[i] = within_half_a_turn(angle, legs->middle[i]);
    }
    return open;
}
