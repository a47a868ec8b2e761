/* 6 x 6 matrices, row by row: equations, and singular values, docs/kinematics.md, 5.1. */
#pragma once
#include "real.h"

/* For (3.2) of docs/kinematics.md: solves M x = b by Gauss's elimination with row pivots. M is
   destroyed, b becomes x. Returns the determinant; where it is 0, b is of no use. */
real eliminate6(real matrix[6][6], real b[6]);

/* Solves (A' A + damping I) x = A' b, damping > 0, by Cholesky's factors: the damped step of
   Levenberg and Marquardt, docs/arm-kinematics.md, 6.2. */
void damped6(real matrix[6][6], real damping, const real right[6], real solution[6]);

real dot6(const real a[6], const real b[6]);
real size6(const real a[6]);

/* The smallest singular value. The matrix is destroyed. NaN for NaN. */
real smallest_singular_value(real matrix[6][6]);

/* Whether it is at least `minimum`: at a fraction of the cost, for M M' - minimum^2 I has no
   eigenvalue below 0 then, which its pivots tell. docs/workspace.md, 3. */
int keeps_singular_value(real matrix[6][6], real minimum);

/* A = U S V': columns of `left`, falling values, rows of `right` (V transposed); small values keep
   their digits. docs/arm-kinematics.md, 8. */
struct svd6 {
    real left[6][6];
    real sigma[6];
    real right[6][6];
};

void svd6(real matrix[6][6], struct svd6 *parts);
