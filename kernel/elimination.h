/* Six equations for three of six joints: docs/arm-kinematics.md, 6.1, (6.1) to (6.3). */
#pragma once
#include "chain.h"

enum { EQUATIONS = 14, UNKNOWN = 8, REMAINING = EQUATIONS - UNKNOWN, POWERS = 9 };

/* A joint's axis: a unit vector and a point. */
struct axis {
    real direction[3], point[3];
};

/* The joints q1 to q6 of a loop, whose product of turns is the displacement (rotation, shift). */
struct loop {
    struct axis joint[JOINTS];
    struct frame moved;
};

/* The fourteen equations (6.2), column by column: of 1, cos, sin of q3, q4 and q5 on the left, of
   q1 and q2 on the right. */
struct equations {
    real left[3][3][3][EQUATIONS];
    real right[3][3][EQUATIONS];
};

/* (6.3): the six equations without q1 and q2, for 1, cos and sin of q3; rows of powers of
   tan(q4/2), each times those of tan(q5/2). */
typedef real six_equations[3][REMAINING][POWERS];

/* Twice as many loops as joints: they begin after joint 0 to 5, or go backwards. */
enum { LOOPS = 2 * JOINTS };

/* The joint, 0 to 5, that is q1 (n = 0) to q6 of a loop. */
int loop_joint(int loop, int n);

/* A loop, in lengths of `length`; its equations, of which rows 8 to 13 are without q1 and q2, and
   the rows before a triangle for them; and those six. */
void eliminate_two(const struct chain *chain, real length, int which, const struct frame *pose,
                   struct loop *loop, struct equations *equations, six_equations six);
