/* Choosing among the branches of an inverse, by whole turns, joint ranges and nearness:
   docs/arm-kinematics.md, 11. */
#pragma once
#include "chain.h"

struct ranges {
    real low[JOINTS], high[JOINTS];
};

/* The angle by whole turns within half a turn of another. */
real nearest_turn(real angle, real near);

/* Moves joints by whole turns: nearest to `near` within the ranges where a turn fits, else the
   turn nearest to the range. */
void unwrap(const struct ranges *ranges, const real near[JOINTS], real joints[JOINTS]);

int are_within(const struct ranges *ranges, const real joints[JOINTS]);

/* Which of the unwrapped branches to take, -1 where all are NaN: those within the ranges come
   first, then the nearest. Joints beyond their range by no more than `near` is count as inside: an
   arm that stands there stays on its branch. (11.1). */
int nearest_branch(const struct ranges *ranges, const real near[JOINTS],
                   real (*branches)[JOINTS], int count);

/* The branch that goes on to `ahead`: by whole turns nearest to it, moved there. 0 without any. */
int continued(real (*branches)[JOINTS], int count, const real ahead[JOINTS], real joints[JOINTS]);
