/* Rods from base points to platform joints, and their Jacobian: docs/kinematics.md, 3 and 4. */
#pragma once
#include "crank.h"

/* Six rods in one pose, legs side by side, base axes. */
struct rods {
    real unit[3][LEGS]; /* from base point to platform joint */
    real arm[3][LEGS];  /* R a: from the platform's origin to the joint */
    real length[LEGS];
};

struct rods rods_of(const real base[3][LEGS], const real end[3][LEGS], const real position[3],
                    const real rotation[9]);

/* The Jacobian's columns, row i of which says how fast rod i grows with a twist: (3.1). Rotations
   are divided by `length`. */
void leg_columns(const struct rods *rods, real length, real columns[6][LEGS]);
