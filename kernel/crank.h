/* Legs with a crank and a rod: docs/kinematics.md, 2. */
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

/* From crank axes to platform joints, base axes. */
void leg_gaps(const struct crank_legs *legs, const real position[3], const real rotation[9],
              real gap[3][LEGS]);

/* The crank angles of one pose with the elbow out and in, within half a turn of `middle`, see
   (2.2); `in` may be null. NaN for a leg that does not close. Returns how many do not. */
int crank_elbows(const struct crank_legs *legs, const real position[3], const real rotation[9],
                 real out[LEGS], real *in);
