/* What the legs need of 6 x 6 matrices, row by row. */
#ifndef KERNEL_MATRIX6_H
#define KERNEL_MATRIX6_H

#include "real.h"

/* Solves M x = b by Gauss's elimination with row pivots. M is destroyed, b becomes x. Returns the
   determinant; where it is 0, b is of no use. */
real eliminate6(real matrix[6][6], real b[6]);

/* The smallest singular value, by Jacobi's rotations of pairs of rows until all are orthogonal
   (Hestenes 1958). The matrix is destroyed. NaN for NaN. */
real smallest_singular_value(real matrix[6][6]);

/* Whether it is at least `minimum`: at a fraction of the cost, for M M' - minimum^2 I has no
   eigenvalue below 0 then, which its pivots tell. docs/workspace.md, 3. */
int keeps_singular_value(real matrix[6][6], real minimum);

#endif
