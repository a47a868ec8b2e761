/* Arms whose inverse is a closed form, with eight branches: docs/arm-kinematics.md, 4 and 5. */
#pragma once
#include "chain.h"

enum { CLOSED_BRANCHES = 8 };

/* Axes 2 and 3 parallel; 4, 5 and 6 meet in `centre`; or 4 is parallel too, and 5 and 6 meet. */
struct closed_form {
    struct chain chain;
    real centre[3];
    real has_parallel_axes;
};

/* All branches, NaN where one does not close; `near` gives what the pose leaves free. */
void closed_branches(const struct closed_form *form, const struct frame *pose,
                     const real near[JOINTS], real branches[CLOSED_BRANCHES][JOINTS]);

/* Which triangle of 4, step 1 or 2, does not close: what has to be reached is `distance` from joint
   1's axis or else from the shoulder, may be `least` to `most`. */
struct gap {
    real is_at_shoulder;
    real distance;
    real least, most;
};

void closed_gap(const struct closed_form *form, const struct frame *pose, struct gap *gap);
