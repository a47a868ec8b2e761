#include "determinant.h"

#include "subproblems.h"

/* The six equations and the same times tan(q4/2), at 1, cos and sin of q3: twelve, for the twelve
   products of powers in them. */
static void twelve(six_equations six, const real at[3], real matrix[SIZE][SIZE])
{
    for (int row = 0; row < SIZE / 2; row++) {
        for (int k = 0; k < SIZE; k++)
            matrix[row][k] = matrix[SIZE / 2 + row][k] = 0;
        for (int k = 0; k < POWERS; k++) {
            real entry = 0;
            for (int a = 0; a < 3; a++)
                entry += at[a] * six[a][row][k];
            matrix[row][k] = matrix[SIZE / 2 + row][3 + k] = entry;
        }
    }
}

/* Gauss's factors in place, with the rows in another order; the determinant. */
static real factors(real matrix[SIZE][SIZE], int order[SIZE])
{
    real determinant = 1;
    for (int k = 0; k < SIZE; k++)
        order[k] = k;
    for (int k = 0; k < SIZE; k++) {
        int pivot = k;
        for (int i = k + 1; i < SIZE; i++)
            if (real_fabs(matrix[order[i]][k]) > real_fabs(matrix[order[pivot]][k]))
                pivot = i;
        if (pivot != k) {
            int kept = order[k];
            order[k] = order[pivot];
            order[pivot] = kept;
            determinant = -determinant;
        }
        real *row = matrix[order[k]];
        determinant *= row[k];
        if (real_fabs(row[k]) < REAL_EPSILON * REAL_EPSILON)
            row[k] = REAL_EPSILON * REAL_EPSILON;
        for (int i = k + 1; i < SIZE; i++) {
            real *other = matrix[order[i]], factor = other[k] / row[k];
            other[k] = factor;
            for (int j = k + 1; j < SIZE; j++)
                other[j] -= factor * row[j];
        }
    }
    return determinant;
}

/* Solves with the factors; the solution's length is made 1, and returned. */
static real solve_with(real matrix[SIZE][SIZE], const int order[SIZE], const real right[SIZE],
                       real solution[SIZE])
{
    real square = 0;
    for (int i = 0; i < SIZE; i++) {
        solution[i] = right[order[i]];
        for (int k = 0; k < i; k++)
            solution[i] -= matrix[order[i]][k] * solution[k];
    }
    for (int i = SIZE - 1; i >= 0; i--) {
        for (int k = i + 1; k < SIZE; k++)
            solution[i] -= matrix[order[i]][k] * solution[k];
        solution[i] /= matrix[order[i]][i];
        square += solution[i] * solution[i];
    }
    real size = real_sqrt(square);
    for (int i = 0; i < SIZE; i++)
        solution[i] /= size;
    return size;
}

void trigonometry(real angle, real at[3])
{
    at[0] = 1;
    at[1] = real_cos(angle);
    at[2] = real_sin(angle);
}

/* The determinant over q3 is a sum of sines and cosines of up to 8 q3. Of 9 q3 it has nothing but
   the errors of the values. */
void determinant_series(six_equations six, struct series *series)
{
    enum { SAMPLES = ROOTS + 3 };
    real cosines[DEGREE + 2] = {0}, sines[DEGREE + 2] = {0};
    for (int n = 0; n < SAMPLES; n++) {
        real at[3], matrix[SIZE][SIZE];
        int order[SIZE];
        trigonometry(REAL_TURN * (real)n / SAMPLES, at);
        twelve(six, at, matrix);
        real value = factors(matrix, order) / SAMPLES;
        struct turn turn = {1, 0}, step = {at[1], at[2]};
        for (int k = 0; k <= DEGREE + 1; k++) {
            cosines[k] += (k ? 2 : 1) * value * turn.cosine;
            sines[k] += 2 * value * turn.sine;
            turn = turn_on(turn, step);
        }
    }
    for (int k = 0; k <= DEGREE; k++) {
        series->cosines[k] = cosines[k];
        series->sines[k] = sines[k];
    }
    series->error = real_fabs(cosines[DEGREE + 1]) + real_fabs(sines[DEGREE + 1]);
}

/* Newton's method on "the matrix is singular": with M v = 0 wanted, M u = M' v gives the step
   -1/(v.u), and u is the next v. Step 0 only finds v, by inverse iteration. */
void refine(six_equations six, real room, real *q3, real v[SIZE])
{
    const int steps = room < REAL(0.1) ? 3 : 2;
    for (int k = 0; k < SIZE; k++)
        v[k] = 1;
    for (int step = 0; step < steps; step++) {
        real at[3], matrix[SIZE][SIZE], slope[SIZE][SIZE], right[SIZE], u[SIZE];
        int order[SIZE];
        trigonometry(*q3, at);
        twelve(six, at, matrix);
        real turned[3] = {0, -at[2], at[1]};
        twelve(six, turned, slope);
        for (int i = 0; i < SIZE; i++) {
            right[i] = 0;
            for (int k = 0; k < SIZE; k++)
                right[i] += slope[i][k] * v[k];
        }
        factors(matrix, order);
        real size = solve_with(matrix, order, step ? right : v, u), along = 0;
        for (int k = 0; k < SIZE; k++) {
            along += v[k] * u[k];
            v[k] = u[k];
        }
        real change = step ? -1 / (size * along) : 0;
        if (real_fabs(change) < room / 4)
            *q3 += change;
    }
}

static real dot12(const real a[SIZE], const real b[SIZE])
{
    real sum = 0;
    for (int k = 0; k < SIZE; k++)
        sum += a[k] * b[k];
    return sum;
}

/* Two vectors that the matrix almost takes to zero, by inverse iteration. */
static void null_pair(six_equations six, real q3, real pair[2][SIZE])
{
    enum { STEPS = 2 };
    real at[3], matrix[SIZE][SIZE], next[SIZE];
    int order[SIZE];
    trigonometry(q3, at);
    twelve(six, at, matrix);
    factors(matrix, order);
    for (int k = 0; k < SIZE; k++) {
        pair[0][k] = 1;
        pair[1][k] = k % 2 ? -1 : 1;
    }
    for (int step = 0; step < STEPS; step++)
        for (int n = 0; n < 2; n++) {
            solve_with(matrix, order, pair[n], next);
            real along = n ? dot12(next, pair[0]) : 0;
            for (int k = 0; k < SIZE; k++)
                pair[n][k] = next[k] - along * pair[0][k];
            real size = real_sqrt(dot12(pair[n], pair[n]));
            for (int k = 0; k < SIZE; k++)
                pair[n][k] /= size;
        }
}

/* Where two branches have almost the same q3, each one's powers are a mixture w of the pair: those
   from x = tan(q4/2) on are x times those from 1 on, so that w is an eigenvector of A = G^-1 H, at
   right angles to the rows of A - x 1, of which the longer is taken. How many there are. */
int separated(six_equations six, real q3, real powers[2][SIZE])
{
    real pair[2][SIZE], g[2][2], h[2][2], a[2][2];
    null_pair(six, q3, pair);
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) {
            g[i][j] = h[i][j] = 0;
            for (int k = 0; k + 3 < SIZE; k++) {
                g[i][j] += pair[i][k] * pair[j][k];
                h[i][j] += pair[i][k] * pair[j][k + 3];
            }
        }
    real determinant = g[0][0] * g[1][1] - g[0][1] * g[1][0];
    for (int j = 0; j < 2; j++) {
        a[0][j] = (g[1][1] * h[0][j] - g[0][1] * h[1][j]) / determinant;
        a[1][j] = (g[0][0] * h[1][j] - g[1][0] * h[0][j]) / determinant;
    }
    real middle = (a[0][0] + a[1][1]) / 2;
    real square = middle * middle - (a[0][0] * a[1][1] - a[0][1] * a[1][0]);
    if (!(square > 0))
        return 0;
    for (int n = 0; n < 2; n++) {
        real x = middle + (n ? real_sqrt(square) : -real_sqrt(square));
        int row = real_fabs(a[0][1]) + real_fabs(a[0][0] - x)
                  < real_fabs(a[1][0]) + real_fabs(a[1][1] - x);
        real w[2] = {row ? a[1][1] - x : -a[0][1], row ? -a[1][0] : a[0][0] - x};
        for (int k = 0; k < SIZE; k++)
            powers[n][k] = w[0] * pair[0][k] + w[1] * pair[1][k];
    }
    return 2;
}
