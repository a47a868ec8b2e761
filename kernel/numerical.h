/* Newton's method on the joints of any chain: docs/arm-kinematics.md, 6. */
#pragma once
#include "chain.h"

/* The twist, in base axes, that takes one pose to another in a unit of time. */
void twist_to_pose(const struct frame *here, const struct frame *pose, real twist[6]);

/* The joints that continue `near` to a pose beside it; 0 where that is not certain: farther than
   0.05 rad. Where Newton's method does not converge at once, a fold is near: of the two branches
   that meet there, the nearer. */
int continue_nearby(const struct chain *chain, real length, const struct frame *pose,
                    const real near[JOINTS], real joints[JOINTS]);

/* Damped steps from `joints` towards a pose; what is left of the error, metres divided by length.
   A start that hardly gets nearer is given up. */
real descend_joints(const struct chain *chain, const struct frame *pose, real length, int steps,
             real joints[JOINTS]);

/* Where the branch should be that meets the one at `joints` in a fold. */
void beyond_fold(const struct chain *chain, real length, const real joints[JOINTS],
                 real beyond[JOINTS]);
