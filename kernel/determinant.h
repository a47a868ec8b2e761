/* Where the twelve equations of docs/arm-kinematics.md, (6.3), have a solution: 6.1. */
#pragma once
#include "elimination.h"
#include "polynomial.h"

enum { SIZE = 12 };

/* 1, cos and sin. */
void trigonometry(real angle, real at[3]);

/* The determinant over q3, from its values at 19 angles. */
void determinant_series(six_equations six, struct series *series);

/* Newton's method on "M is singular", in steps below a quarter of the room to the next root; v are
   the twelve powers there. */
void refine(six_equations six, real room, real *q3, real v[SIZE]);

/* Where two branches have almost the same q3, the powers of each; 2, or 0 where there are none. */
int separated(six_equations six, real q3, real powers[2][SIZE]);
