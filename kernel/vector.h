/* Vectors of three numbers and rotation matrices of nine, row by row. */
#pragma once
#include "real.h"

/* What maps coordinates of one frame to another: the frame's origin, and the rotation, row by row.
   */
struct frame {
    real position[3];
    real rotation[9];
};

static inline real dot3(const real a[3], const real b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void cross3(const real a[3], const real b[3], real product[3])
{
    product[0] = a[1] * b[2] - a[2] * b[1];
    product[1] = a[2] * b[0] - a[0] * b[2];
    product[2] = a[0] * b[1] - a[1] * b[0];
}

static inline void minus3(const real a[3], const real b[3], real difference[3])
{
    for (int i = 0; i < 3; i++)
        difference[i] = a[i] - b[i];
}

/* R v. */
static inline void rotate3(const real rotation[9], const real v[3], real turned[3])
{
    for (int i = 0; i < 3; i++)
        turned[i] = dot3(rotation + 3 * i, v);
}

/* A B. */
static inline void product9(const real a[9], const real b[9], real product[9])
{
    for (int row = 0; row < 9; row += 3)
        for (int column = 0; column < 3; column++)
            product[row + column] =
                a[row] * b[column] + a[row + 1] * b[3 + column] + a[row + 2] * b[6 + column];
}

/* A B'. */
static inline void product9_back(const real a[9], const real b[9], real product[9])
{
    for (int row = 0; row < 9; row += 3)
        for (int column = 0; column < 3; column++)
            product[row + column] = dot3(a + row, b + 3 * column);
}
