#include "matrix6.h"

enum { MOST_SWEEPS = 40 };

static void swap_rows(real matrix[6][6], real b[6], int i, int j)
{
    for (int k = 0; k < 6; k++) {
        real kept = matrix[i][k];
        matrix[i][k] = matrix[j][k];
        matrix[j][k] = kept;
    }
    real kept = b[i];
    b[i] = b[j];
    b[j] = kept;
}

real eliminate6(real matrix[6][6], real b[6])
{
    real determinant = 1;
    for (int i = 0; i < 6; i++) {
        int pivot = i;
        for (int j = i + 1; j < 6; j++)
            if (real_fabs(matrix[j][i]) > real_fabs(matrix[pivot][i]))
                pivot = j;
        if (pivot != i) {
            swap_rows(matrix, b, i, pivot);
            determinant = -determinant;
        }
        determinant *= matrix[i][i];
        real inverse = 1 / matrix[i][i];
        for (int j = i + 1; j < 6; j++) {
            real factor = matrix[j][i] * inverse;
            for (int k = i + 1; k < 6; k++)
                matrix[j][k] -= factor * matrix[i][k];
            b[j] -= factor * b[i];
        }
    }
    for (int i = 5; i >= 0; i--) {
        for (int k = i + 1; k < 6; k++)
            b[i] -= matrix[i][k] * b[k];
        b[i] /= matrix[i][i];
    }
    return determinant;
}

real dot6(const real a[6], const real b[6])
{
    return (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3]) +
           (a[4] * b[4] + a[5] * b[5]);
}

struct rotation6 rotation6(const real a[6], const real b[6])
{
    struct rotation6 found = {1, 0, 0};
    real aa = dot6(a, a), bb = dot6(b, b), ab = dot6(a, b);
    if (!(ab * ab > REAL_EPSILON * REAL_EPSILON * aa * bb))
        return found;
    real difference = bb - aa, twice = 2 * ab; /* whose ratio is that of 2 cosines and 2 sines */
    real both = real_fabs(difference) + real_sqrt(difference * difference + twice * twice);
    real tangent = (difference < 0 ? -twice : twice) / both;
    found.cosine = 1 / real_sqrt(1 + tangent * tangent);
    found.sine = found.cosine * tangent;
    found.is_far = ab * ab > REAL_EPSILON * aa * bb;
    return found;
}

void rotate6(const struct rotation6 *by, real a[6], real b[6])
{
    real cosine = by->cosine, sine = by->sine;
    if (sine == 0)
        return;
    for (int k = 0; k < 6; k++) {
        real before = a[k];
        a[k] = cosine * before - sine * b[k];
        b[k] = sine * before + cosine * b[k];
    }
}

real smallest_singular_value(real matrix[6][6])
{
    /* Every pair once, in an order in which three neighbours do not wait for each other. */
    static const unsigned char pairs[15][2] = {{0, 1}, {2, 3}, {4, 5}, {0, 2}, {1, 4},
                                               {3, 5}, {0, 3}, {1, 5}, {2, 4}, {0, 4},
                                               {1, 3}, {2, 5}, {0, 5}, {1, 2}, {3, 4}};
    int turned = 1;
    for (int sweep = 0; turned && sweep < MOST_SWEEPS; sweep++) {
        turned = 0;
        for (int i = 0; i < 15; i++) {
            real *a = matrix[pairs[i][0]], *b = matrix[pairs[i][1]];
            struct rotation6 by = rotation6(a, b);
            rotate6(&by, a, b);
            turned |= by.is_far;
        }
    }
    real least = dot6(matrix[0], matrix[0]), sum = least;
    for (int i = 1; i < 6; i++) {
        real square = dot6(matrix[i], matrix[i]);
        least = square < least ? square : least;
        sum += square;
    }
    return real_sqrt(sum >= 0 ? least : sum);
}

int keeps_singular_value(real matrix[6][6], real minimum)
{
    real square[6][6] = {{0}};
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 6; k++)
            for (int j = 0; j < 6; j++)
                square[i][j] += matrix[k][i] * matrix[k][j];
    for (int i = 0; i < 6; i++)
        square[i][i] -= minimum * minimum;
    int is_positive = 1;
    for (int i = 0; i < 6; i++) {
        is_positive &= square[i][i] > 0;
        real inverse = 1 / square[i][i];
        for (int j = i + 1; j < 6; j++) {
            real factor = square[i][j] * inverse;
            for (int k = i; k < 6; k++)
                square[j][k] -= factor * square[i][k];
        }
    }
    return is_positive;
}
