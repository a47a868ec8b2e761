/* What the legs need of 6 x 6 matrices, row by row. */
#pragma once
#include "real.h"

/* Solves M x = b by Gauss's elimination with row pivots. M is destroyed, b becomes x. Returns the
   determinant; where it is 0, b is of no use. */
real eliminate6(real matrix[6][6], real b[6]);

real dot6(const real a[6], const real b[6]);

/* The rotation of two rows in their plane, a' = cosine a - sine b and b' = sine a + cosine b, that
   makes them orthogonal (Hestenes 1958). As convergence is quadratic, a sweep over all pairs in
   which none was far from it is the last. */
struct rotation6 {
    real cosine, sine;
    int is_far;
};

/* The one of a and b; cosine 1 where they are orthogonal but for rounding, and for NaN. */
struct rotation6 rotation6(const real a[6], const real b[6]);

void rotate6(const struct rotation6 *by, real a[6], real b[6]);

/* The smallest singular value, by such rotations until all rows are orthogonal. The matrix is
   destroyed. NaN for NaN. */
real smallest_singular_value(real matrix[6][6]);

/* Whether it is at least `minimum`: at a fraction of the cost, for M M' - minimum^2 I has no
   eigenvalue below 0 then, which its pivots tell. docs/workspace.md, 3. */
int keeps_singular_value(real matrix[6][6], real minimum);
