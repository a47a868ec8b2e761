/* Cholesky's factor L of a positive definite matrix, M = L L'. Rows are `width` apart; of M the
   lower triangle is read, and becomes L with its diagonal inverted. Inline, so that loops of a
   known size are unrolled. */
#pragma once
#include "real.h"

/* Pivots below `least` become it; 0 where one of them is not positive even so. */
static inline int factorise(int size, int width, real *matrix, real least)
{
    for (int i = 0; i < size; i++) {
        real *row = matrix + i * width;
        for (int j = 0; j <= i; j++) {
            const real *other = matrix + j * width;
            real sum = row[j];
            for (int k = 0; k < j; k++)
                sum -= row[k] * other[k];
            if (i == j && !(sum > least))
                sum = least;
            if (i == j && !(sum > 0))
                return 0;
            row[j] = i == j ? 1 / real_sqrt(sum) : sum * other[j];
        }
    }
    return 1;
}

/* v becomes L^-1 v. */
static inline void divide_by_factor(int size, int width, const real *factor, real *v)
{
    for (int i = 0; i < size; i++) {
        for (int k = 0; k < i; k++)
            v[i] -= factor[i * width + k] * v[k];
        v[i] *= factor[i * width + i];
    }
}

/* v becomes L'^-1 v. */
static inline void divide_by_transposed(int size, int width, const real *factor, real *v)
{
    for (int i = size - 1; i >= 0; i--) {
        for (int k = i + 1; k < size; k++)
            v[i] -= factor[k * width + i] * v[k];
        v[i] *= factor[i * width + i];
    }
}
