/* Down the distance to a target, within all limits: docs/workspace.md, 2. */
#pragma once
#include "limits.h"

/* Poses are those of the pivot, a point of the platform, with the platform's orientation, in the
   base frame. Distances are in metres, rotations made lengths by the platform's. */
struct descent {
    const struct platform *platform;
    const real *low, *high; /* ranges of the limited values */
    const real *pivot;      /* platform frame, m */
    struct frame target;
    real clearance; /* how far inside every limit it stays, in m, to first order */
};

/* Sequential quadratic programming, with the Lagrangian's curvature learnt by BFGS: from a pose
   that keeps all limits to ones nearer the target, until no step brings it nearer. */
void descend(const struct descent *descent, int most_steps, struct frame *place);
