#include "matrix6.h"

#include "cholesky.h"

enum { MOST_SWEEPS = 40 };

static void swap(real *a, real *b)
{
    real kept = *a;
    *a = *b;
    *b = kept;
}

real eliminate6(real matrix[6][6], real b[6])
{
    real determinant = 1;
    for (int i = 0; i < 6; i++) {
        int pivot = i;
        for (int j = i + 1; j < 6; j++)
            if (real_fabs(matrix[j][i]) > real_fabs(matrix[pivot][i]))
                pivot = j;
        for (int k = 0; pivot != i && k < 6; k++)
            swap(&matrix[i][k], &matrix[pivot][k]);
        if (pivot != i) {
            swap(&b[i], &b[pivot]);
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

real size6(const real a[6])
{
    return real_sqrt(dot6(a, a));
}

static void rotate6(real cosine, real sine, real a[6], real b[6])
{
    for (int k = 0; k < 6; k++) {
        real before = a[k];
        a[k] = cosine * before - sine * b[k];
        b[k] = sine * before + cosine * b[k];
    }
}

/* Turns two rows in their plane so that they become orthogonal, and two others by the same angle,
   if there are any. Whether they were far from it; as convergence is quadratic, a sweep over all
   pairs in which none was is the last. NaN is left as it is. */
static int turn_pair(real a[6], real b[6], real *other_a, real *other_b)
{
    real aa = dot6(a, a), bb = dot6(b, b), ab = dot6(a, b);
    if (!(ab * ab > REAL_EPSILON * REAL_EPSILON * aa * bb))
        return 0;
    real difference = bb - aa, twice = 2 * ab; /* whose ratio is that of 2 cosines and 2 sines */
    real both = real_fabs(difference) + real_sqrt(difference * difference + twice * twice);
    real tangent = (difference < 0 ? -twice : twice) / both;
    real cosine = 1 / real_sqrt(1 + tangent * tangent), sine = cosine * tangent;
    rotate6(cosine, sine, a, b);
    if (other_a)
        rotate6(cosine, sine, other_a, other_b);
    return ab * ab > REAL_EPSILON * aa * bb;
}

/* Rotations from one side until all rows are orthogonal (Hestenes 1958): small singular values, the
   rows' lengths then, keep their digits. `turned`, if not null, is rotated alike. */
static void orthogonalise(real rows[6][6], real (*turned)[6])
{
    /* Every pair once, in an order in which three neighbours do not wait for each other. */
    static const unsigned char pairs[15][2] = {{0, 1}, {2, 3}, {4, 5}, {0, 2}, {1, 4},
                                               {3, 5}, {0, 3}, {1, 5}, {2, 4}, {0, 4},
                                               {1, 3}, {2, 5}, {0, 5}, {1, 2}, {3, 4}};
    int is_far = 1;
    for (int sweep = 0; is_far && sweep < MOST_SWEEPS; sweep++) {
        is_far = 0;
        for (int i = 0; i < 15; i++) {
            int a = pairs[i][0], b = pairs[i][1];
            is_far |= turn_pair(rows[a], rows[b], turned ? turned[a] : 0, turned ? turned[b] : 0);
        }
    }
}

real smallest_singular_value(real matrix[6][6])
{
    orthogonalise(matrix, 0);
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

/* Exchanges rows so that the lengths of `columns` fall. */
static void sort_rows(real columns[6][6], real sigma[6], real right[6][6])
{
    for (int i = 0; i < 6; i++)
        sigma[i] = size6(columns[i]);
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
    real columns[6][6];
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) {
            columns[j][i] = matrix[i][j];
            parts->right[i][j] = i == j;
        }
    orthogonalise(columns, parts->right);
    sort_rows(columns, parts->sigma, parts->right);
    make_unit_rows(columns, parts->sigma);
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
            parts->left[i][j] = columns[j][i];
}
