/* The inverse of any arm with six joints: docs/arm-kinematics.md, 4 to 6 and 11. */
#pragma once
#include "branches.h"
#include "closed_forms.h"

enum { MOST_BRANCHES = 16 }; /* of six revolute joints */
enum { MOST_LOOPS = 4 };

/* Which closed form an arm has. */
enum { NO_FORM, ALMOST_CLOSED, CLOSED };

/* Four joints, of which a branch may turn the first and the last by half a turn, if the two between
   mirror their angles: each and its image have a sum, 6.1. `joint` is the first, 0 to 2; -1: none. */
struct mirror {
    real joint, sum[2];
};

struct arm {
    struct chain chain;      /* as built */
    struct closed_form form; /* its own, or that of the arm that it almost is */
    real closes;             /* NO_FORM, ALMOST_CLOSED or CLOSED */
    real length;             /* divides metres beside radians */
    struct ranges ranges;
    real loops[MOST_LOOPS]; /* of `general_candidates`, the best first; -1: no more have a use */
    struct mirror mirror;
    struct chain solved; /* what is eliminated: the chain, or almost, if no loop has a use for it */
};

/* The branches of a pose, in the first rows; how many rows, some of which may be NaN. `near` gives
   what the pose leaves free, and where to begin. 4 and 5, or 6.1, 6.2 and 6.4. */
int arm_branches(const struct arm *arm, const struct frame *pose, const real near[JOINTS],
                 real branches[MOST_BRANCHES][JOINTS]);

/* The branch to take from `near`; 0 and NaN where there is none. Nearby it is continued, 6.3;
   else the choice is (11.1). */
int arm_inverse(const struct arm *arm, const struct frame *pose, const real near[JOINTS],
                real joints[JOINTS]);

/* The twist that is left to a pose that is not reached, at the best of 33 attempts: 6.2. */
void arm_miss(const struct arm *arm, const struct frame *pose, real miss[6]);

/* Joints on one branch along a row of poses, from `near` on: continuous, whatever the ranges. Where
   there is no closed form, by 6.3. */
void arm_along(const struct arm *arm, const real (*positions)[3], const real (*rotations)[9],
               long count, const real near[JOINTS], real (*joints)[JOINTS]);
