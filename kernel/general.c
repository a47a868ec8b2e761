#include "general.h"

#include "subproblems.h"

enum { EQUATIONS = 14, UNKNOWN = 8, SIZE = 12, DEGREE = 8, SAMPLES = 2 * DEGREE + 1 };

/* A joint's axis: a unit vector and a point. */
struct axis {
    real direction[3], point[3];
};

/* The joints q1 to q6 of a loop, whose product of turns is the displacement (rotation, shift). */
struct loop {
    struct axis joint[JOINTS];
    struct frame moved;
};

/* The fourteen equations (6.2), column by column: of 1, cos, sin of q3, q4 and q5 on the left, of
   q1 and q2 on the right. */
struct equations {
    real left[3][3][3][EQUATIONS];
    real right[3][3][EQUATIONS];
};

/* (6.3): the six equations without q1 and q2, for 1, cos and sin of q3; rows of powers of
   tan(q4/2), each times those of tan(q5/2). */
typedef real six_equations[3][EQUATIONS - UNKNOWN][9];

static void displaced(const struct frame *moved, const struct axis *axis, struct axis *there)
{
    rotate3(moved->rotation, axis->direction, there->direction);
    rotate3(moved->rotation, axis->point, there->point);
    for (int i = 0; i < 3; i++)
        there->point[i] += moved->position[i];
}

/* The joints after `first`, displaced by the pose, then those before. */
static void make_loop(const struct chain *chain, real length, int first, const struct frame *pose,
                      struct loop *loop)
{
    real home[3];
    for (int row = 0; row < 3; row++)
        for (int i = 0; i < 3; i++)
            loop->moved.rotation[3 * row + i] =
                dot3(pose->rotation + 3 * row, chain->tool.rotation + 3 * i);
    rotate3(loop->moved.rotation, chain->tool.position, home);
    for (int i = 0; i < 3; i++)
        loop->moved.position[i] = (pose->position[i] - home[i]) / length;
    for (int n = 0; n < JOINTS; n++) {
        int k = (first + n) % JOINTS;
        struct axis axis;
        for (int i = 0; i < 3; i++) {
            axis.direction[i] = chain->axis[k][i];
            axis.point[i] = chain->point[k][i] / length;
        }
        loop->joint[n] = axis;
        if (first + n < JOINTS)
            displaced(&loop->moved, &axis, &loop->joint[n]);
    }
}

static void turn_axis(const struct axis *about, struct turn turn, struct axis *axis)
{
    real arm[3], direction[3];
    for (int i = 0; i < 3; i++)
        arm[i] = axis->point[i] - about->point[i];
    rotate_about(about->direction, turn, axis->direction, direction);
    rotate_about(about->direction, turn, arm, axis->point);
    for (int i = 0; i < 3; i++) {
        axis->point[i] += about->point[i];
        axis->direction[i] = direction[i];
    }
}

/* Of an axis with direction l and point p: l, p, p.p, p.l, p x l, (p.p) l - 2 (p.l) p. */
static void fourteen(const struct axis *axis, const real origin[3], real values[EQUATIONS])
{
    const real *l = axis->direction;
    real p[3];
    for (int i = 0; i < 3; i++)
        p[i] = axis->point[i] - origin[i];
    values[6] = dot3(p, p);
    values[7] = dot3(p, l);
    cross3(p, l, values + 8);
    for (int i = 0; i < 3; i++) {
        values[i] = l[i];
        values[3 + i] = p[i];
        values[11 + i] = values[6] * l[i] - 2 * values[7] * p[i];
    }
}

/* From values at 0, a quarter and half a turn to the coefficients of 1, cos and sin. */
static void make_coefficients(real *at_0, real *at_1, real *at_2, int count)
{
    for (int i = 0; i < count; i++) {
        real constant = (at_0[i] + at_2[i]) / 2, sine = at_1[i] - constant;
        at_1[i] = at_0[i] - constant;
        at_0[i] = constant;
        at_2[i] = sine;
    }
}

static const struct turn QUARTERS[3] = {{1, 0}, {0, 1}, {-1, 0}};

/* Where q3, q4, q5 take joint 6's axis; the quantities are linear in each one's 1, cos and sin. */
static void sample_left(const struct loop *loop, real left[3][3][3][EQUATIONS])
{
    const struct axis *joint = loop->joint;
    for (int c = 0; c < 3; c++) {
        struct axis by_5 = joint[5];
        turn_axis(&joint[4], QUARTERS[c], &by_5);
        for (int b = 0; b < 3; b++) {
            struct axis by_4 = by_5;
            turn_axis(&joint[3], QUARTERS[b], &by_4);
            for (int a = 0; a < 3; a++) {
                struct axis by_3 = by_4;
                turn_axis(&joint[2], QUARTERS[a], &by_3);
                fourteen(&by_3, joint[2].point, left[a][b][c]);
            }
        }
    }
    for (int k = 0; k < 9; k++)
        make_coefficients(left[k / 3][k % 3][0], left[k / 3][k % 3][1], left[k / 3][k % 3][2],
                          EQUATIONS);
    for (int a = 0; a < 3; a++)
        make_coefficients(left[a][0][0], left[a][1][0], left[a][2][0], 3 * EQUATIONS);
    make_coefficients(left[0][0][0], left[1][0][0], left[2][0][0], 9 * EQUATIONS);
}

/* Where q1 and q2, turned back, take the place that joint 6's axis must have. */
static void sample_right(const struct loop *loop, real right[3][3][EQUATIONS])
{
    const struct axis *joint = loop->joint;
    struct axis target;
    displaced(&loop->moved, &joint[5], &target);
    for (int a = 0; a < 3; a++) {
        struct axis by_1 = target;
        turn_axis(&joint[0], turn_back(QUARTERS[a]), &by_1);
        for (int b = 0; b < 3; b++) {
            struct axis by_2 = by_1;
            turn_axis(&joint[1], turn_back(QUARTERS[b]), &by_2);
            fourteen(&by_2, joint[2].point, right[a][b]);
        }
    }
    for (int a = 0; a < 3; a++)
        make_coefficients(right[a][0], right[a][1], right[a][2], EQUATIONS);
    make_coefficients(right[0][0], right[1][0], right[2][0], 3 * EQUATIONS);
}

/* Householder's reflection of a column, by v of squared length `square`, from row `first` on. */
static void reflect(const real *v, real square, int first, real *column)
{
    real along = 0;
    for (int i = first; i < EQUATIONS; i++)
        along += v[i] * column[i];
    along *= 2 / square;
    for (int i = first; i < EQUATIONS; i++)
        column[i] -= along * v[i];
}

/* Reflections that leave rows 8 to 13 without q1 and q2, and make the rows before a triangle. The
   constants go to the left. */
static void eliminate(struct equations *equations)
{
    real(*left)[EQUATIONS] = equations->left[0][0], (*right)[EQUATIONS] = equations->right[0];
    for (int k = 0; k < UNKNOWN; k++) {
        real v[EQUATIONS], square = 0;
        for (int i = k; i < EQUATIONS; i++) {
            v[i] = right[k + 1][i];
            square += v[i] * v[i];
        }
        real size = real_sqrt(square), first = v[k];
        if (!(size > 0))
            continue;
        v[k] += first > 0 ? size : -size;
        square += 2 * real_fabs(first) * size + square;
        for (int n = 0; n < 9; n++)
            if (n == 0 || n > k)
                reflect(v, square, k, right[n]);
        for (int n = 0; n < 27; n++)
            reflect(v, square, k, left[n]);
    }
    for (int i = 0; i < EQUATIONS; i++)
        left[0][i] -= right[0][i];
}

/* From 1, cos and sin of q4 and of q5 to powers of the tangents of their halves. */
static void make_six(struct equations *equations, six_equations six)
{
    for (int a = 0; a < 3; a++)
        for (int row = 0; row < EQUATIONS - UNKNOWN; row++) {
            real half[3][3];
            for (int b = 0; b < 3; b++) {
                real one = equations->left[a][b][0][UNKNOWN + row];
                real cosine = equations->left[a][b][1][UNKNOWN + row];
                half[b][0] = one + cosine;
                half[b][1] = 2 * equations->left[a][b][2][UNKNOWN + row];
                half[b][2] = one - cosine;
            }
            for (int j = 0; j < 3; j++) {
                six[a][row][j] = half[0][j] + half[1][j];
                six[a][row][3 + j] = 2 * half[2][j];
                six[a][row][6 + j] = half[0][j] - half[1][j];
            }
        }
}

/* The six equations and the same times tan(q4/2), at 1, cos and sin of q3: twelve, for the twelve
   products of powers in them. */
static void twelve(six_equations six, const real at[3], real matrix[SIZE][SIZE])
{
    for (int row = 0; row < SIZE / 2; row++) {
        for (int k = 0; k < SIZE; k++)
            matrix[row][k] = matrix[SIZE / 2 + row][k] = 0;
        for (int k = 0; k < 9; k++) {
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

static void trigonometry(real angle, real at[3])
{
    at[0] = 1;
    at[1] = real_cos(angle);
    at[2] = real_sin(angle);
}

/* The determinant over q3 is a sum of sines and cosines of up to 8 q3: so many samples tell it. */
static void determinant_series(six_equations six, real cosines[DEGREE + 1],
                               real sines[DEGREE + 1])
{
    for (int k = 0; k <= DEGREE; k++)
        cosines[k] = sines[k] = 0;
    for (int n = 0; n < SAMPLES; n++) {
        real at[3], matrix[SIZE][SIZE];
        int order[SIZE];
        trigonometry(REAL_TURN * (real)n / SAMPLES, at);
        twelve(six, at, matrix);
        real value = factors(matrix, order) / SAMPLES;
        struct turn turn = {1, 0}, step = {at[1], at[2]};
        for (int k = 0; k <= DEGREE; k++) {
            cosines[k] += (k ? 2 : 1) * value * turn.cosine;
            sines[k] += 2 * value * turn.sine;
            turn = turn_on(turn, step);
        }
    }
}

/* A complex number; of length one, a turn. */
typedef struct turn complex_number;

static complex_number reciprocal(complex_number z)
{
    real square = z.cosine * z.cosine + z.sine * z.sine;
    return (complex_number){z.cosine / square, -z.sine / square};
}

/* z^8 times the series, for exp(i q3) = z: a polynomial of degree 16. */
static void polynomial_of(const real cosines[DEGREE + 1], const real sines[DEGREE + 1],
                          complex_number polynomial[SAMPLES])
{
    polynomial[DEGREE] = (complex_number){cosines[0], 0};
    for (int k = 1; k <= DEGREE; k++) {
        polynomial[DEGREE + k] = (complex_number){cosines[k] / 2, -sines[k] / 2};
        polynomial[DEGREE - k] = (complex_number){cosines[k] / 2, sines[k] / 2};
    }
}

/* Newton's step p/p' at z. */
static complex_number newton_step(const complex_number polynomial[SAMPLES], complex_number z)
{
    complex_number value = polynomial[SAMPLES - 1], slope = {0, 0};
    for (int k = SAMPLES - 2; k >= 0; k--) {
        slope = turn_on(slope, z);
        slope.cosine += value.cosine;
        slope.sine += value.sine;
        value = turn_on(value, z);
        value.cosine += polynomial[k].cosine;
        value.sine += polynomial[k].sine;
    }
    return turn_on(value, reciprocal(slope));
}

/* All roots at once (Aberth 1973): Newton's steps, each kept away from the other roots. */
static void all_roots(const complex_number polynomial[SAMPLES], complex_number roots[2 * DEGREE])
{
    enum { MOST_STEPS = 30 };
    const real arrived = REAL(1e-10);
    for (int k = 0; k < 2 * DEGREE; k++)
        roots[k] = turn_by(REAL(0.1) + REAL_TURN * (real)k / (2 * DEGREE));
    for (int step = 0, moving = 1; moving && step < MOST_STEPS; step++) {
        moving = 0;
        for (int k = 0; k < 2 * DEGREE; k++) {
            complex_number newton = newton_step(polynomial, roots[k]), sum = {0, 0};
            for (int j = 0; j < 2 * DEGREE; j++)
                if (j != k) {
                    complex_number away = reciprocal(
                        (complex_number){roots[k].cosine - roots[j].cosine,
                                         roots[k].sine - roots[j].sine});
                    sum.cosine += away.cosine;
                    sum.sine += away.sine;
                }
            sum = turn_on(newton, sum);
            sum = turn_on(newton, reciprocal((complex_number){1 - sum.cosine, -sum.sine}));
            if (!isfinite(sum.cosine + sum.sine))
                continue;
            roots[k].cosine -= sum.cosine;
            roots[k].sine -= sum.sine;
            moving |= real_fabs(sum.cosine) + real_fabs(sum.sine) > arrived;
        }
    }
}

/* The angles q3 at which the series is zero, or nearly; how many. */
static int series_roots(const real cosines[DEGREE + 1], const real sines[DEGREE + 1],
                        real angles[MOST_CANDIDATES])
{
    const real nearly = REAL(0.2), rounding = REAL(1e-4);
    complex_number polynomial[SAMPLES], roots[2 * DEGREE];
    int count = 0;
    polynomial_of(cosines, sines, polynomial);
    all_roots(polynomial, roots);
    for (int k = 0; k < 2 * DEGREE; k++) {
        real size = real_sqrt(roots[k].cosine * roots[k].cosine + roots[k].sine * roots[k].sine);
        /* Roots beside the circle are pairs z, 1/z*: one is enough. */
        if (size > 1 - nearly && size < 1 + rounding)
            angles[count++] = turn_angle(roots[k]);
    }
    return count;
}

/* Newton's method on "the matrix is singular": with M v = 0 wanted, M u = M' v gives the step
   -1/(v.u), and u is the next v. */
static void refine(six_equations six, real *q3, real v[SIZE])
{
    enum { STEPS = 3 };
    for (int k = 0; k < SIZE; k++)
        v[k] = 1;
    for (int step = 0; step < STEPS; step++) {
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
        if (real_fabs(change) < REAL(0.1))
            *q3 += change;
    }
}

/* Twice the angle whose sine and cosine are the longest pair of neighbours among powers. */
static real doubled(const real v[SIZE], int apart)
{
    int best = 0;
    real most = 0;
    for (int k = 0; k + apart < SIZE; k++) {
        real square = v[k] * v[k] + v[k + apart] * v[k + apart];
        if (square > most && (apart > 1 || k % 3 < 2)) {
            most = square;
            best = k;
        }
    }
    return 2 * real_atan2(v[best + apart], v[best]);
}

/* q1 and q2 from the triangle of rows 0 to 7, for what is on the left. */
static void inner_joints(const struct equations *equations, const real q[JOINTS], real *q1,
                         real *q2)
{
    const real(*left)[EQUATIONS] = (const real(*)[EQUATIONS])equations->left[0][0];
    const real(*right)[EQUATIONS] = (const real(*)[EQUATIONS])equations->right[0];
    real at[3][3], x[UNKNOWN + 1];
    for (int i = 0; i < 3; i++)
        trigonometry(q[2 + i], at[i]);
    for (int i = UNKNOWN - 1; i >= 0; i--) {
        real sum = 0;
        for (int n = 0; n < 27; n++)
            sum += left[n][i] * at[0][n / 9] * at[1][n / 3 % 3] * at[2][n % 3];
        for (int k = i + 1; k < UNKNOWN; k++)
            sum -= right[k + 1][i] * x[k + 1];
        x[i + 1] = sum / right[i + 1][i];
    }
    *q1 = real_atan2(x[6], x[3]); /* of 1, cos, sin q1, each times those of q2 */
    *q2 = real_atan2(x[2], x[1]);
}

/* q6 is what is left of the turn. */
static real last_joint(const struct loop *loop, const real q[JOINTS])
{
    real across[3], there[3];
    perpendicular(loop->joint[5].direction, across);
    rotate3(loop->moved.rotation, across, there);
    for (int n = 0; n < JOINTS - 1; n++) {
        real back[3];
        rotate_about(loop->joint[n].direction, turn_by(-q[n]), there, back);
        for (int i = 0; i < 3; i++)
            there[i] = back[i];
    }
    return turn_angle(facing(loop->joint[5].direction, across, there, (struct turn){1, 0}));
}

static void eliminated(const struct chain *chain, real length, int first, const struct frame *pose,
                       struct loop *loop, struct equations *equations, six_equations six)
{
    make_loop(chain, length, first, pose, loop);
    sample_left(loop, equations->left);
    sample_right(loop, equations->right);
    eliminate(equations);
    make_six(equations, six);
}

int general_candidates(const struct chain *chain, real length, int first, const struct frame *pose,
                       real candidates[MOST_CANDIDATES][JOINTS])
{
    struct loop loop;
    struct equations equations;
    six_equations six;
    real cosines[DEGREE + 1], sines[DEGREE + 1], roots[MOST_CANDIDATES];
    eliminated(chain, length, first, pose, &loop, &equations, six);
    determinant_series(six, cosines, sines);
    int count = series_roots(cosines, sines, roots);
    for (int n = 0; n < count; n++) {
        real v[SIZE], q[JOINTS];
        q[2] = roots[n];
        refine(six, &q[2], v);
        q[3] = doubled(v, 3);
        q[4] = doubled(v, 1);
        inner_joints(&equations, q, &q[0], &q[1]);
        q[5] = last_joint(&loop, q);
        for (int i = 0; i < JOINTS; i++)
            candidates[n][(first + i) % JOINTS] = q[i];
    }
    return count;
}
