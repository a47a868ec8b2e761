/* The roots of a sum of sines and cosines: docs/arm-kinematics.md, 6.1. */
#pragma once
#include "real.h"

enum { DEGREE = 8, ROOTS = 2 * DEGREE };

/* Of cos(k q) and sin(k q), k = 0 to 8. */
struct series {
    real cosines[DEGREE + 1], sines[DEGREE + 1];
    real error; /* of each of them, about */
};

/* The angles at which the series is zero, or nearly, and how far the next root is; how many. */
int series_roots(const struct series *series, real angles[ROOTS], real rooms[ROOTS],
                 int *are_certain);
