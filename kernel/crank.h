/* Legs with a crank and a rod: docs/kinematics.md, 1 and 2. */
#pragma once
#include "real.h"

enum { LEGS = 6 };

/* Six legs side by side, so that one loop serves all; metres and radians. Axes are unit vectors of
   the base frame. Legs of other kinds use some of it: legs.h. */
struct crank_legs {
    real centre[3][LEGS];  /* of the crank's turning, base frame */
    real normal[3][LEGS];  /* tangent x up: the crank's axis */
    real tangent[3][LEGS]; /* where the crank's angle is 0 */
    real up[3][LEGS];      /* where it is a right angle */
    real end[3][LEGS];     /* of the rod, platform frame */
    real crank[LEGS];      /* length */
    real rod[LEGS];        /* length */
    real middle[LEGS];     /* angles are given within half a turn of it */
};

/* The product of two vectors of leg i. */
static inline real leg_dot(const real a[3][LEGS], const real b[3][LEGS], int i)
{
    return a[0][i] * b[0][i] + a[1][i] * b[1][i] + a[2][i] * b[2][i];
}

/* Of v, fixed to the platform, the vector of leg i along base axis k. */
static inline real leg_turned(const real rotation[9], const real v[3][LEGS], int k, int i)
{
    const real *row = rotation + 3 * k;
    return row[0] * v[0][i] + row[1] * v[1][i] + row[2] * v[2][i];
}

/* v of (2.1): from crank axes to platform joints, base axes. */
void leg_gaps(const struct crank_legs *legs, const real position[3], const real rotation[9],
              real gap[3][LEGS]);

/* The crank angles of one pose with the elbow out and in, (2.4), within half a turn of `middle`;
   `in` may be null. NaN for a leg that does not close. Returns how many do not. */
int crank_elbows(const struct crank_legs *legs, const real position[3], const real rotation[9],
                 real out[LEGS], real *in);
