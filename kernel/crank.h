/* Legs with a crank and a rod: docs/kinematics.md, 2. */
#ifndef KERNEL_CRANK_H
#define KERNEL_CRANK_H

#include "real.h"

enum { LEGS = 6 };

/* One leg, in metres and radians; the axes are unit vectors of the base frame. */
struct crank_leg {
    real centre[3];   /* of the crank's turning, base frame */
    real normal[3];   /* tangent x up: the crank's axis */
    real tangent[3];  /* where the crank's angle is 0 */
    real up[3];       /* where it is a right angle */
    real platform[3]; /* where the rod ends, platform frame */
    real crank;       /* length */
    real rod;         /* length */
};

struct crank_legs {
    struct crank_leg leg[LEGS];
    real middle; /* angles are given within half a turn of it */
};

/* The crank angles (6) of one pose: elbow out, or nearest to `near` (6, may be null), see (2.2).
   NaN for a leg that does not close. Returns how many do not. */
int crank_inverse(const struct crank_legs *legs, const real position[3], const real rotation[9],
                  const real *near, real angles[LEGS]);

#endif
