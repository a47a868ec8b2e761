/* Vectors of three numbers and rotation matrices of nine, row by row. */
#ifndef KERNEL_VECTOR_H
#define KERNEL_VECTOR_H

#include "real.h"

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

/* R v. */
static inline void rotate3(const real rotation[9], const real v[3], real turned[3])
{
    for (int i = 0; i < 3; i++)
        turned[i] = dot3(rotation + 3 * i, v);
}

#endif
