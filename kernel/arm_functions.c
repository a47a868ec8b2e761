/* What Python calls of the arms' mathematics. */
#include "arm.h"
#include "general.h"
#include "line_keeping.h"
#include "matrix6.h"
#include "python.h"
#include "rate_scaling.h"

static int are_finite(const real *numbers, int count)
{
    for (int k = 0; k < count; k++)
        if (!isfinite(numbers[k]))
            return 0;
    return 1;
}

static void fill_nan(real (*from)[JOINTS], real (*to)[JOINTS])
{
    for (real *number = *from; number < *to; number++)
        *number = (real)NAN;
}

/* In sum how many poses are not finite. */
static Py_ssize_t each_chain_forward(real *const *a)
{
    posture turned;
    chain_posture(AS(struct chain, 0), a[1], &turned);
    put_pose(&turned.tool, a[2], a[3]);
    return !are_finite(turned.tool.position, 3);
}

/* As square matrices, four rows of four. */
static Py_ssize_t each_chain_displacements(real *const *a)
{
    struct frame moved[JOINTS + 1];
    chain_displacements(AS(struct chain, 0), a[1], moved);
    for (int k = 0; k <= JOINTS; k++) {
        real(*square)[4] = ROWS(4, 2) + 4 * k;
        for (int row = 0; row < 3; row++) {
            memcpy(square[row], moved[k].rotation + 3 * row, 3 * sizeof(real));
            square[row][3] = moved[k].position[row];
            square[3][row] = 0;
        }
        square[3][3] = 1;
    }
    return 0;
}

static Py_ssize_t each_chain_jacobian(real *const *a)
{
    posture turned;
    chain_posture(AS(struct chain, 0), a[1], &turned);
    chain_jacobian(&turned, ROWS(JOINTS, 2));
    return 0;
}

/* The smallest singular value of each Jacobian, its metres divided by a length. */
static Py_ssize_t each_chain_sigma_min(real *const *a)
{
    real jacobian[6][JOINTS];
    posture turned;
    chain_posture(AS(struct chain, 0), a[2], &turned);
    chain_jacobian(&turned, jacobian);
    scale_jacobian(*a[1], jacobian);
    *a[3] = smallest_singular_value(jacobian);
    return 0;
}

DO(closed_branches, closed_branches(AS(struct closed_form, 0), POSE(1), a[3], ROWS(JOINTS, 4)))
DO(closed_gap, closed_gap(AS(struct closed_form, 0), POSE(1), AS(struct gap, 3)))

/* All branches, unwrapped, and NaN; in sum how many of the joints to be near to are not finite. */
static Py_ssize_t each_arm_branches(real *const *a)
{
    real(*rows)[JOINTS] = ROWS(JOINTS, 4);
    int count = arm_branches(AS(struct arm, 0), POSE(1), a[3], rows);
    for (int k = 0; k < count; k++)
        unwrap(&AS(struct arm, 0)->ranges, a[3], rows[k]);
    fill_nan(rows + count, rows + MOST_BRANCHES);
    return !are_finite(a[3], JOINTS);
}

SUM(arm_inverse, !arm_inverse(AS(struct arm, 0), POSE(1), a[3], a[4]))
DO(arm_miss, arm_miss(AS(struct arm, 0), POSE(1), a[3]))

/* Candidates, and NaN; a[1] is the length and the loop. In sum for how many poses they are
   certain. */
static Py_ssize_t each_general_candidates(real *const *a)
{
    int are_certain;
    real(*rows)[JOINTS] = ROWS(JOINTS, 4);
    int count = general_candidates(AS(struct chain, 0), a[1][0], (int)a[1][1], POSE(2), rows,
                                   &are_certain);
    fill_nan(rows + count, rows + MOST_CANDIDATES);
    return are_certain;
}

static Py_ssize_t all_arm_along(real *const *a, Py_ssize_t items)
{
    arm_along(AS(struct arm, 0), (const real(*)[3])a[2], (const real(*)[9])a[3], (long)items, a[1],
              ROWS(JOINTS, 4));
    return 0;
}

DO(decompose, decompose(AS(struct chain, 0), *a[1], a[2], AS(struct decomposed, 3)))
DO(turning, turning(AS(struct decomposed, 0), a[1], a[2]))
DO(line_rates, line_rates(AS(struct decomposed, 0), *a[1], a[2], a[3], AS(struct line, 4)))
DO(damped_rates, damped_rates(AS(struct decomposed, 0), *a[1], a[2], a[3]))

/* Adds what is missed in a tick of a[1][1] seconds to the way back; it and the tool's twist are in
   metres again. */
static Py_ssize_t each_part_driven(real *const *a)
{
    real missed[6], length = a[1][0], time = a[1][1];
    *a[5] = part_driven(AS(struct decomposed, 0), a[2], a[3], missed, a[6]);
    for (int k = 0; k < 6; k++) {
        real unit = k < 3 ? length : 1;
        a[4][k] += time * missed[k] * unit;
        a[6][k] *= unit;
    }
    return 0;
}

DO(scale_rates, *AS(struct rate_scale, 5) =
                    scale_rates(AS(struct joint_limits, 0), a[1], a[2], a[3], a[4][0], a[4][1]))
DO(follow_rates, follow_rates(AS(struct joint_limits, 0), a[2][0], a[1], a[2][1], a[3], a[4]))

struct function ARM_FUNCTIONS[] = {
    EACH(chain_forward, ONCE(struct chain), IN(real[6]), OUT(real[3]), OUT(real[9])),
    EACH(chain_displacements, ONCE(struct chain), IN(real[6]), OUT(real[JOINTS + 1][4][4])),
    EACH(chain_jacobian, ONCE(struct chain), IN(real[6]), OUT(real[6][6])),
    EACH(chain_sigma_min, ONCE(struct chain), ONCE(real), IN(real[6]), OUT(real)),
    EACH(closed_branches, ONCE(struct closed_form), IN(real[3]), IN(real[9]), IN(real[6]),
         OUT(real[CLOSED_BRANCHES][6])),
    EACH(closed_gap, ONCE(struct closed_form), IN(real[3]), IN(real[9]), OUT(struct gap)),
    EACH(arm_branches, ONCE(struct arm), IN(real[3]), IN(real[9]), IN(real[6]),
         OUT(real[MOST_BRANCHES][6])),
    EACH(arm_inverse, ONCE(struct arm), IN(real[3]), IN(real[9]), IN(real[6]), OUT(real[6])),
    EACH(arm_miss, ONCE(struct arm), IN(real[3]), IN(real[9]), OUT(real[6])),
    EACH(general_candidates, ONCE(struct chain), ONCE(real[2]), IN(real[3]), IN(real[9]),
         OUT(real[MOST_CANDIDATES][6])),
    ALL(arm_along, ONCE(struct arm), ONCE(real[6]), IN(real[3]), IN(real[9]), OUT(real[6])),
    EACH(decompose, ONCE(struct chain), ONCE(real), IN(real[6]), OUT(struct decomposed)),
    EACH(turning, ONCE(struct decomposed), IN(real[6]), OUT(real[6])),
    EACH(line_rates, ONCE(struct decomposed), ONCE(real), IN(real[6]), MAYBE(real[6]),
         OUT(struct line)),
    EACH(damped_rates, ONCE(struct decomposed), ONCE(real), IN(real[6]), OUT(real[6])),
    EACH(part_driven, ONCE(struct decomposed), ONCE(real[2]), IN(real[6]), IN(real[6]),
         OUT(real[6]), OUT(real), OUT(real[6])),
    EACH(scale_rates, ONCE(struct joint_limits), IN(real[6]), IN(real[6]), IN(real[6]),
         ONCE(real[2]), OUT(struct rate_scale)),
    EACH(follow_rates, ONCE(struct joint_limits), IN(real[6]), ONCE(real[2]), OUT(real[6]),
         OUT(real[6])),
    {.each = 0},
};
