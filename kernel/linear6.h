/* Six linear equations, and the singular values of their matrix. Matrices are row by row. */
#ifndef KERNEL_LINEAR6_H
#define KERNEL_LINEAR6_H

#include "real.h"

enum { SIX = 6, SQUARE = SIX * SIX };

/* Solves A x = b by elimination with pivots; 0 where A is singular. */
int solve6(const real matrix[SQUARE], const real right[SIX], real solution[SIX]);

/* Solves (A' A + damping I) x = A' b, damping > 0, by Cholesky's factors: the damped step of
   Levenberg and Marquardt. */
void damped6(const real matrix[SQUARE], real damping, const real right[SIX], real solution[SIX]);

/* A = U S V': columns of `left`, falling values, rows of `right` (V transposed). */
struct svd6 {
    real left[SQUARE];
    real sigma[SIX];
    real right[SQUARE];
};

/* By Jacobi's rotations from one side (Hestenes): small values keep their digits. */
void svd6(const real matrix[SQUARE], struct svd6 *parts);

#endif
