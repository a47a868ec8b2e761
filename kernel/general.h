/* All branches of any six joints, by elimination: docs/arm-kinematics.md, 6.1. */
#pragma once
#include "chain.h"

enum { MOST_CANDIDATES = 48 };

/* Joints near which every branch of a pose is; how many. Lengths are divided by `length`. Of the
   loops, 0 to 11 (elimination.h), some have no use for an arm: a determinant that is always 0. */
int general_candidates(const struct chain *chain, real length, int which, const struct frame *pose,
                       real candidates[MOST_CANDIDATES][JOINTS], int *are_certain);
