/* Newton's method on the joints of any chain: docs/arm-kinematics.md, 6.2 and 6.3. */
#pragma once
#include "chain.h"

/* The joints that continue `near` to a pose beside it; 0 where that is not certain: farther than
   0.05 rad. Where Newton's method does not converge at once, a fold is near: of the two branches
   that meet there, the nearer. 6.3. */
int continue_nearby(const struct chain *chain, real length, const struct frame *pose,
                    const real near[JOINTS], real joints[JOINTS]);

/* Damped steps from `joints` towards a pose; what is left of the error, metres divided by length.
   A start that hardly gets nearer is given up. 6.2. */
real descend_joints(const struct chain *chain, const struct frame *pose, real length, int steps,
             real joints[JOINTS]);

/* About where the branch is that meets the one at `joints` in a fold, for damped steps to start
   from: the end of 6.1. Anywhere, or not finite, where no fold is near. */
void beyond_fold(const struct chain *chain, real length, const real joints[JOINTS],
                 real beyond[JOINTS]);
