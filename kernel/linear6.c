#include "linear6.h"

static void swap(real *a, real *b)
{
    real kept = *a;
    *a = *b;
    *b = kept;
}

/* Brings the largest entry of a column, from its diagonal on, to the diagonal; 0 if all are 0. */
static int pivot(real a[SQUARE], real b[SIX], int column)
{
    int best = column;
    for (int row = column + 1; row < SIX; row++)
        if (real_fabs(a[SIX * row + column]) > real_fabs(a[SIX * best + column]))
            best = row;
    if (!(real_fabs(a[SIX * best + column]) > 0))
        return 0;
    if (best != column) {
        swap(&b[best], &b[column]);
        for (int k = column; k < SIX; k++)
            swap(&a[SIX * best + k], &a[SIX * column + k]);
    }
    return 1;
}

int solve6(const real matrix[SQUARE], const real right[SIX], real solution[SIX])
{
    real a[SQUARE], b[SIX];
    for (int k = 0; k < SQUARE; k++)
        a[k] = matrix[k];
    for (int k = 0; k < SIX; k++)
        b[k] = right[k];
    for (int column = 0; column < SIX; column++) {
        if (!pivot(a, b, column))
            return 0;
        real inverse = 1 / a[SIX * column + column];
        for (int row = column + 1; row < SIX; row++) {
            real factor = a[SIX * row + column] * inverse;
            b[row] -= factor * b[column];
            for (int k = column + 1; k < SIX; k++)
                a[SIX * row + k] -= factor * a[SIX * column + k];
        }
    }
    for (int row = SIX - 1; row >= 0; row--) {
        real sum = b[row];
        for (int k = row + 1; k < SIX; k++)
            sum -= a[SIX * row + k] * solution[k];
        solution[row] = sum / a[SIX * row + row];
    }
    return 1;
}

/* The lower half of A' A + damping I, and A' b. */
static void normal_equations(const real a[SQUARE], real damping, const real b[SIX],
                             real normal[SQUARE], real right[SIX])
{
    for (int i = 0; i < SIX; i++) {
        right[i] = 0;
        for (int row = 0; row < SIX; row++)
            right[i] += a[SIX * row + i] * b[row];
        for (int j = 0; j <= i; j++) {
            real sum = i == j ? damping : 0;
            for (int row = 0; row < SIX; row++)
                sum += a[SIX * row + i] * a[SIX * row + j];
            normal[SIX * i + j] = sum;
        }
    }
}

void damped6(const real matrix[SQUARE], real damping, const real right[SIX], real solution[SIX])
{
    real l[SQUARE], inverse[SIX];
    normal_equations(matrix, damping, right, l, solution);
    for (int i = 0; i < SIX; i++) {
        for (int j = 0; j <= i; j++) {
            real sum = l[SIX * i + j];
            for (int k = 0; k < j; k++)
                sum -= l[SIX * i + k] * l[SIX * j + k];
            if (i > j)
                l[SIX * i + j] = sum * inverse[j];
            else
                inverse[i] = 1 / real_sqrt(sum > damping / 2 ? sum : damping / 2); /* rounding */
        }
        for (int k = 0; k < i; k++)
            solution[i] -= l[SIX * i + k] * solution[k];
        solution[i] *= inverse[i];
    }
    for (int i = SIX - 1; i >= 0; i--) {
        for (int k = i + 1; k < SIX; k++)
            solution[i] -= l[SIX * k + i] * solution[k];
        solution[i] *= inverse[i];
    }
}

static real dot6(const real a[SIX], const real b[SIX])
{
    real sum = 0;
    for (int k = 0; k < SIX; k++)
        sum += a[k] * b[k];
    return sum;
}

static void turn_rows(real a[SIX], real b[SIX], real cosine, real sine)
{
    for (int k = 0; k < SIX; k++) {
        real x = a[k], y = b[k];
        a[k] = cosine * x - sine * y;
        b[k] = sine * x + cosine * y;
    }
}

/* Turns two rows of `columns` (A's columns) until they are at a right angle; 1 where they were. */
static int made_perpendicular(real columns[SQUARE], real right[SQUARE], int i, int j)
{
    real *a = columns + SIX * i, *b = columns + SIX * j;
    real aa = dot6(a, a), bb = dot6(b, b), ab = dot6(a, b);
    if (!(ab * ab > REAL_EPSILON * REAL_EPSILON * aa * bb))
        return 1;
    real zeta = (bb - aa) / (2 * ab);
    real tangent = 1 / (real_fabs(zeta) + real_sqrt(1 + zeta * zeta));
    if (zeta < 0)
        tangent = -tangent;
    real cosine = 1 / real_sqrt(1 + tangent * tangent);
    turn_rows(a, b, cosine, cosine * tangent);
    turn_rows(right + SIX * i, right + SIX * j, cosine, cosine * tangent);
    return 0;
}

/* Exchanges rows so that the lengths of `columns` fall. */
static void sort_rows(real columns[SQUARE], real sigma[SIX], real right[SQUARE])
{
    for (int i = 0; i < SIX; i++)
        sigma[i] = real_sqrt(dot6(columns + SIX * i, columns + SIX * i));
    for (int i = 1; i < SIX; i++)
        for (int j = i; j > 0 && sigma[j] > sigma[j - 1]; j--) {
            swap(&sigma[j], &sigma[j - 1]);
            for (int k = 0; k < SIX; k++) {
                swap(&columns[SIX * j + k], &columns[SIX * (j - 1) + k]);
                swap(&right[SIX * j + k], &right[SIX * (j - 1) + k]);
            }
        }
}

/* What is left of the unit vector k without its parts along the first rows; its squared length. */
static real remainder_of(int k, const real rows[SQUARE], int count, real vector[SIX])
{
    for (int i = 0; i < SIX; i++)
        vector[i] = i == k;
    for (int twice = 0; twice < 2; twice++)
        for (int row = 0; row < count; row++) {
            real along = dot6(vector, rows + SIX * row);
            for (int i = 0; i < SIX; i++)
                vector[i] -= along * rows[SIX * row + i];
        }
    return dot6(vector, vector);
}

/* Rows of length one; those that have no direction left get one at a right angle to all before. */
static void make_unit_rows(real rows[SQUARE], const real sigma[SIX])
{
    for (int i = 0; i < SIX; i++) {
        real other[SIX], *row = rows + SIX * i, size = sigma[i];
        if (!(sigma[i] > 2 * SIX * REAL_EPSILON * sigma[0])) {
            /* Of six unit vectors one at least keeps a sixth of its squared length. */
            int k = 0;
            while (k + 1 < SIX && remainder_of(k, rows, i, other) < REAL(0.1))
                k++;
            size = real_sqrt(remainder_of(k, rows, i, row));
        }
        for (int j = 0; j < SIX; j++)
            row[j] /= size;
    }
}

void svd6(const real matrix[SQUARE], struct svd6 *parts)
{
    enum { MOST_SWEEPS = 20 };
    real columns[SQUARE];
    for (int i = 0; i < SIX; i++)
        for (int j = 0; j < SIX; j++) {
            columns[SIX * j + i] = matrix[SIX * i + j];
            parts->right[SIX * i + j] = i == j;
        }
    for (int sweep = 0, done = 0; sweep < MOST_SWEEPS && !done; sweep++) {
        done = 1;
        for (int i = 0; i < SIX; i++)
            for (int j = i + 1; j < SIX; j++)
                done &= made_perpendicular(columns, parts->right, i, j);
    }
    sort_rows(columns, parts->sigma, parts->right);
    make_unit_rows(columns, parts->sigma);
    for (int i = 0; i < SIX; i++)
        for (int j = 0; j < SIX; j++)
            parts->left[SIX * i + j] = columns[SIX * j + i];
}
