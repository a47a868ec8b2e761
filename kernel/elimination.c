#include "elimination.h"

#include "se3.h"
#include "subproblems.h"

static void displaced(const struct frame *moved, const struct axis *axis, struct axis *there)
{
    rotate3(moved->rotation, axis->direction, there->direction);
    moved_point(moved, axis->point, there->point);
}

int loop_joint(int loop, int n)
{
    int k = (loop + n) % JOINTS;
    return loop < JOINTS ? k : JOINTS - 1 - k;
}

/* The joints from the one at which the loop begins on, displaced by the pose, then those before;
   backwards they turn about the opposite axes, to the pose as seen from the tool. */
static void make_loop(const struct chain *chain, real length, int which, const struct frame *pose,
                      struct loop *loop)
{
    displacement(chain, pose, &loop->moved);
    for (int i = 0; i < 3; i++)
        loop->moved.position[i] /= length;
    if (which >= JOINTS)
        loop->moved = inverted(&loop->moved);
    for (int n = 0; n < JOINTS; n++) {
        int k = loop_joint(which, n);
        struct axis axis;
        for (int i = 0; i < 3; i++) {
            axis.direction[i] = which < JOINTS ? chain->axis[k][i] : -chain->axis[k][i];
            axis.point[i] = chain->point[k][i] / length;
        }
        loop->joint[n] = axis;
        if (which % JOINTS + n < JOINTS)
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
        real v[EQUATIONS] = {0}, square = 0;
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
        for (int row = 0; row < REMAINING; row++) {
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

void eliminate_two(const struct chain *chain, real length, int which, const struct frame *pose,
                   struct loop *loop, struct equations *equations, six_equations six)
{
    make_loop(chain, length, which, pose, loop);
    sample_left(loop, equations->left);
    sample_right(loop, equations->right);
    eliminate(equations);
    make_six(equations, six);
}
