#include "general.h"

#include "determinant.h"
#include "elimination.h"
#include "subproblems.h"

/* Radians between two q3 that may be the same. */
#define CLOSE REAL(0.02)

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
    real at[3][3], x[UNKNOWN + 1] = {0};
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

int general_candidates(const struct chain *chain, real length, int which, const struct frame *pose,
                       real candidates[MOST_CANDIDATES][JOINTS], int *are_certain)
{
    struct loop loop;
    struct equations equations;
    six_equations six;
    struct series series;
    real roots[ROOTS], rooms[ROOTS];
    eliminate_two(chain, length, which, pose, &loop, &equations, six);
    determinant_series(six, &series);
    int count = series_roots(&series, roots, rooms, are_certain);
    int found = 0;
    for (int n = 0; n < count; n++) {
        real v[3][SIZE], q[JOINTS];
        q[2] = roots[n];
        refine(six, rooms[n], &q[2], v[0]);
        int kinds = rooms[n] < CLOSE ? 1 + separated(six, q[2], v + 1) : 1;
        for (int kind = 0; kind < kinds && found < MOST_CANDIDATES; kind++) {
            q[3] = doubled(v[kind], 3);
            q[4] = doubled(v[kind], 1);
            inner_joints(&equations, q, &q[0], &q[1]);
            q[5] = last_joint(&loop, q);
            for (int i = 0; i < JOINTS; i++)
                candidates[found][loop_joint(which, i)] = q[i];
            found++;
        }
    }
    return found;
}
