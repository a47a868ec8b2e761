#include "least_distance.h"

#include "vector.h"

#define NOTHING_LEFT REAL(1e-12) /* of what the residual is the rest of */
#define DEPENDENT REAL(1e-20) /* squared sine to the columns before */
#define TOLERANCE (10 * REAL_EPSILON)
enum { ROWS = 7, STEPS_PER_COLUMN = 3 };

/* While it is searched for, a weight is above 0 for a column in use, and BLOCKED for one that has
   just proved of no use. */
#define BLOCKED REAL(-1.0)

/* The least squares problem min |E u - f|, u >= 0: columns of E are a normal, and below it what
   the target lacks of its bound; f is 0 but for a 1 at the end. */
struct problem {
    const real *target;
    const real (*normals)[6];
    const real *slack;
    ptrdiff_t count;
};

/* Columns in use, at most as many as rows. */
struct used {
    ptrdiff_t column[ROWS];
    real weight[ROWS];
    int count;
};

static void column_of(const struct problem *p, ptrdiff_t i, real column[ROWS])
{
    column[6] = -p->slack[i];
    for (int k = 0; k < 6; k++) {
        column[k] = p->normals[i][k];
        column[6] -= column[k] * p->target[k];
    }
}

static real dot7(const real a[ROWS], const real b[ROWS])
{
    real sum = 0;
    for (int k = 0; k < ROWS; k++)
        sum += a[k] * b[k];
    return sum;
}

/* The weights that bring the columns in use nearest to f, whatever their signs; by orthogonal
   columns (modified Gram-Schmidt). 0 where they are dependent. */
static int solve(const struct problem *p, const struct used *used, real weight[ROWS])
{
    real q[ROWS][ROWS], r[ROWS][ROWS], right[ROWS], rest[ROWS] = {0};
    rest[6] = 1;
    for (int j = 0; j < used->count; j++) {
        column_of(p, used->column[j], q[j]);
        real before = dot7(q[j], q[j]);
        for (int i = 0; i < j; i++) {
            r[i][j] = dot7(q[i], q[j]);
            for (int k = 0; k < ROWS; k++)
                q[j][k] -= r[i][j] * q[i][k];
        }
        real square = dot7(q[j], q[j]);
        if (!(square > DEPENDENT * before))
            return 0;
        r[j][j] = real_sqrt(square);
        for (int k = 0; k < ROWS; k++)
            q[j][k] /= r[j][j];
        right[j] = dot7(q[j], rest);
        for (int k = 0; k < ROWS; k++)
            rest[k] -= right[j] * q[j][k];
    }
    for (int j = used->count - 1; j >= 0; j--) {
        weight[j] = right[j];
        for (int i = j + 1; i < used->count; i++)
            weight[j] -= r[j][i] * weight[i];
        weight[j] /= r[j][j];
    }
    return 1;
}

/* E u - f for the weights of the columns in use. */
static void put_residual(const struct problem *p, const struct used *used, real residual[ROWS])
{
    for (int k = 0; k < ROWS; k++)
        residual[k] = k == 6 ? -1 : 0;
    for (int j = 0; j < used->count; j++) {
        real column[ROWS];
        column_of(p, used->column[j], column);
        for (int k = 0; k < ROWS; k++)
            residual[k] += used->weight[j] * column[k];
    }
}

/* The column that would bring it nearer the fastest, or -1. */
static ptrdiff_t steepest(const struct problem *p, const real residual[ROWS], const real *state)
{
    ptrdiff_t best = -1;
    real most = TOLERANCE;
    for (ptrdiff_t i = 0; i < p->count; i++) {
        real column[ROWS];
        if (state[i] != 0)
            continue;
        column_of(p, i, column);
        real slope = -dot7(column, residual);
        if (slope > most) {
            most = slope;
            best = i;
        }
    }
    return best;
}

/* Takes the last column into use, and out of use those whose weights would fall below 0 on the
   way. 0 where the last one is of no use. */
static int taken_in(const struct problem *p, struct used *used, real *state)
{
    real solution[ROWS];
    int last = used->count - 1;
    used->weight[last] = 0;
    if (!solve(p, used, solution) || !(solution[last] > 0))
        return 0;
    for (;;) {
        real share = 1;
        int first = -1, kept = 0; /* the first whose weight falls to 0 */
        for (int j = 0; j < used->count; j++) {
            real part = used->weight[j] / (used->weight[j] - solution[j]);
            if (solution[j] <= 0 && !(part >= share)) {
                share = part;
                first = j;
            }
        }
        for (int j = 0; j < used->count; j++) {
            real weight = used->weight[j] + share * (solution[j] - used->weight[j]);
            int is_kept = j != first && weight > 0;
            state[used->column[j]] = is_kept;
            if (!is_kept)
                continue;
            used->column[kept] = used->column[j];
            used->weight[kept++] = weight;
        }
        used->count = kept;
        if (first < 0 || !solve(p, used, solution))
            return 1;
    }
}

int least_distance(const real target[6], const real (*normals)[6], const real *slack,
                   ptrdiff_t count, real *multipliers)
{
    const struct problem p = {target, normals, slack, count};
    struct used used = {.count = 0};
    real residual[ROWS];
    ptrdiff_t steps = STEPS_PER_COLUMN * count;
    for (ptrdiff_t i = 0; i < count; i++)
        multipliers[i] = 0;
    for (put_residual(&p, &used, residual); steps > 0; steps--) {
        ptrdiff_t next = used.count < ROWS ? steepest(&p, residual, multipliers) : -1;
        if (next < 0)
            break;
        struct used before = used;
        used.column[used.count++] = next;
        if (!taken_in(&p, &used, multipliers)) {
            used = before;
            multipliers[next] = BLOCKED;
            continue;
        }
        for (ptrdiff_t i = 0; i < count; i++)
            multipliers[i] = multipliers[i] == BLOCKED ? 0 : multipliers[i];
        put_residual(&p, &used, residual);
    }
    for (ptrdiff_t i = 0; i < count; i++)
        multipliers[i] = 0;
    real whole = 1;
    for (int j = 0; j < used.count; j++) {
        real column[ROWS];
        column_of(&p, used.column[j], column);
        whole += used.weight[j] * real_fabs(column[6]);
        multipliers[used.column[j]] = used.weight[j] / -residual[6];
    }
    return (steps > 0 || count == 0) && -residual[6] > NOTHING_LEFT * whole;
}
