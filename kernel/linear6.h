/* Six damped equations, and singular vectors: docs/arm-kinematics.md, 6 and 8. */
#pragma once
#include "real.h"

/* Solves (A' A + damping I) x = A' b, damping > 0, by Cholesky's factors: the damped step of
   Levenberg and Marquardt. */
void damped6(real matrix[6][6], real damping, const real right[6], real solution[6]);

/* A = U S V': columns of `left`, falling values, rows of `right` (V transposed). */
struct svd6 {
    real left[6][6];
    real sigma[6];
    real right[6][6];
};

/* By rotations from one side (matrix6.h): small values keep their digits. */
void svd6(real matrix[6][6], struct svd6 *parts);
