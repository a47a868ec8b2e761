/* All branches of any six joints, by elimination: docs/arm-kinematics.md, 6. */
#ifndef KERNEL_GENERAL_H
#define KERNEL_GENERAL_H

#include "chain.h"

enum { MOST_CANDIDATES = 48 };

/* Joints near which every branch of a pose is; how many. Lengths are divided by `length`. The loop
   of the joints begins after joint `first`, 0 to 5, two before the joint that is solved for: some
   have no use for an arm, as a determinant that is always 0. */
int general_candidates(const struct chain *chain, real length, int first, const struct frame *pose,
                       real candidates[MOST_CANDIDATES][JOINTS]);

#endif
