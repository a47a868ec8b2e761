#include "linear6.h"

#include "cholesky.h"
#include "matrix6.h"

static void swap(real *a, real *b)
{
    real kept = *a;
    *a = *b;
    *b = kept;
}

/* The lower half of A' A + damping I, and A' b. */
static void normal_equations(real a[6][6], real damping, const real b[6],
                             real normal[6][6], real right[6])
{
    for (int i = 0; i < 6; i++) {
        right[i] = 0;
        for (int row = 0; row < 6; row++)
            right[i] += a[row][i] * b[row];
        for (int j = 0; j <= i; j++) {
            real sum = i == j ? damping : 0;
            for (int row = 0; row < 6; row++)
                sum += a[row][i] * a[row][j];
            normal[i][j] = sum;
        }
    }
}

void damped6(real matrix[6][6], real damping, const real right[6], real solution[6])
{
    real normal[6][6];
    normal_equations(matrix, damping, right, normal, solution);
    factorise(6, 6, normal[0], damping / 2); /* rounding */
    divide_by_factor(6, 6, normal[0], solution);
    divide_by_transposed(6, 6, normal[0], solution);
}

/* Exchanges rows so that the lengths of `columns` fall. */
static void sort_rows(real columns[6][6], real sigma[6], real right[6][6])
{
    for (int i = 0; i < 6; i++)
        sigma[i] = real_sqrt(dot6(columns[i], columns[i]));
    for (int i = 1; i < 6; i++)
        for (int j = i; j > 0 && sigma[j] > sigma[j - 1]; j--) {
            swap(&sigma[j], &sigma[j - 1]);
            for (int k = 0; k < 6; k++) {
                swap(&columns[j][k], &columns[j - 1][k]);
                swap(&right[j][k], &right[j - 1][k]);
            }
        }
}

/* What is left of the unit vector k without its parts along the first rows; its squared length. */
static real remainder_of(int k, real rows[6][6], int count, real vector[6])
{
    for (int i = 0; i < 6; i++)
        vector[i] = i == k;
    for (int twice = 0; twice < 2; twice++)
        for (int row = 0; row < count; row++) {
            real along = dot6(vector, rows[row]);
            for (int i = 0; i < 6; i++)
                vector[i] -= along * rows[row][i];
        }
    return dot6(vector, vector);
}

/* Rows of length one; those that have no direction left get one at a right angle to all before. */
static void make_unit_rows(real rows[6][6], const real sigma[6])
{
    for (int i = 0; i < 6; i++) {
        real other[6], *row = rows[i], size = sigma[i];
        if (!(sigma[i] > 12 * REAL_EPSILON * sigma[0])) {
            /* Of six unit vectors one at least keeps a sixth of its squared length. */
            int k = 0;
            while (k + 1 < 6 && remainder_of(k, rows, i, other) < REAL(0.1))
                k++;
            size = real_sqrt(remainder_of(k, rows, i, row));
        }
        for (int j = 0; j < 6; j++)
            row[j] /= size;
    }
}

void svd6(real matrix[6][6], struct svd6 *parts)
{
    enum { MOST_SWEEPS = 20 };
    real columns[6][6];
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) {
            columns[j][i] = matrix[i][j];
            parts->right[i][j] = i == j;
        }
    for (int sweep = 0, turned = 1; sweep < MOST_SWEEPS && turned; sweep++) {
        turned = 0;
        for (int i = 0; i < 6; i++)
            for (int j = i + 1; j < 6; j++) {
                struct rotation6 by = rotation6(columns[i], columns[j]);
                rotate6(&by, columns[i], columns[j]);
                rotate6(&by, parts->right[i], parts->right[j]);
                turned |= by.is_far;
            }
    }
    sort_rows(columns, parts->sigma, parts->right);
    make_unit_rows(columns, parts->sigma);
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
            parts->left[i][j] = columns[j][i];
}
