#include "crank.h"

#include "vector.h"

/* So much nearer, in rad, elbow in must be for a leg to be taken for bent that way: at the edge of
   the reach both branches meet, and a machine that comes back bends its legs as at home. */
#define BRANCHES_MEET REAL(0.1)

/* From crank axis to platform joint, in the leg's own axes: docs/kinematics.md, (2.1). */
static void gap_of(const struct crank_leg *leg, const real position[3], const real rotation[9],
                   real gap[3])
{
    real to_joint[3];
    rotate3(rotation, leg->platform, to_joint);
    for (int i = 0; i < 3; i++)
        to_joint[i] += position[i] - leg->centre[i];
    gap[0] = dot3(to_joint, leg->normal);
    gap[1] = dot3(to_joint, leg->tangent);
    gap[2] = dot3(to_joint, leg->up);
}

static real within_half_a_turn(real angle, real centre)
{
    return angle - REAL_TURN * real_rint((angle - centre) / REAL_TURN);
}

/* Of middle + half (elbow out) and middle - half, modulo whole turns, the one nearest to `near`. */
static real nearest(real middle, real half, real near)
{
    real out = within_half_a_turn(middle + half, near);
    real in = within_half_a_turn(middle - half, near);
    return real_fabs(out - near) <= real_fabs(in - near) + BRANCHES_MEET ? out : in;
}

int crank_inverse(const struct crank_legs *legs, const real position[3], const real rotation[9],
                  const real *near, real angles[LEGS])
{
    int open = 0;
    for (int i = 0; i < LEGS; i++) {
        const struct crank_leg *leg = &legs->leg[i];
        real gap[3];
        gap_of(leg, position, rotation, gap);
        real in_plane = gap[1] * gap[1] + gap[2] * gap[2];
        /* (r - d)(r + d), not r^2 - d^2: the difference keeps its digits. */
        real sum = in_plane + gap[0] * gap[0] + (leg->crank - leg->rod) * (leg->crank + leg->rod);
        real half = real_acos(sum / (2 * leg->crank * real_sqrt(in_plane)));
        real middle = real_atan2(gap[2], gap[1]);
        angles[i] = near ? nearest(middle, half, near[i])
                         : within_half_a_turn(middle + half, legs->middle);
        open += !(real_fabs(half) <= REAL_PI); /* counts what is not a number, too */
    }
    return open;
}
