/* What Python calls of the arms' mathematics. */
#include <string.h>

#include "arm.h"
#include "general.h"
#include "line_keeping.h"
#include "matrix6.h"
#include "python.h"
#include "rate_scaling.h"

/* call_NAME does what is said for each item i, and returns `sum`. */
#define EACH(name, ...)                                                                           \
    static Py_ssize_t call_##name(real *const *a, Py_ssize_t items)                               \
    {                                                                                             \
        Py_ssize_t sum = 0;                                                                       \
        for (Py_ssize_t i = 0; i < items; i++) {                                                  \
            __VA_ARGS__                                                                           \
        }                                                                                         \
        return sum;                                                                               \
    }

/* Array k as a struct for all items, and the numbers and rows of item i in it. */
#define THE(type, k) ((const type *)a[k])
#define ONE(type, k) ((type *)a[k] + i)
#define PART(k, numbers) (a[k] + (numbers) * i)
#define ROWS(k, count) ((real(*)[JOINTS])a[k] + (count) * i)

static struct frame pose_of(const real position[3], const real rotation[9])
{
    struct frame pose;
    memcpy(pose.position, position, sizeof pose.position);
    memcpy(pose.rotation, rotation, sizeof pose.rotation);
    return pose;
}

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

EACH(chain_forward, posture turned; chain_posture(THE(struct chain, 0), PART(1, JOINTS), &turned);
     memcpy(PART(2, 3), turned.tool.position, sizeof turned.tool.position);
     memcpy(PART(3, 9), turned.tool.rotation, sizeof turned.tool.rotation);
     sum += !are_finite(turned.tool.position, 3);)
FUNCTION(chain_forward, {WHOLE, NUMBERS(struct chain)}, {ITEMS, JOINTS}, {WRITTEN, 3},
         {WRITTEN, 9})

/* As square matrices, four rows of four. */
static void write_square(const struct frame *frame, real square[4][4])
{
    for (int row = 0; row < 3; row++) {
        memcpy(square[row], frame->rotation + 3 * row, 3 * sizeof(real));
        square[row][3] = frame->position[row];
        square[3][row] = 0;
    }
    square[3][3] = 1;
}

EACH(chain_displacements, struct frame moved[JOINTS + 1];
     chain_displacements(THE(struct chain, 0), PART(1, JOINTS), moved);
     for (int k = 0; k <= JOINTS; k++)
         write_square(&moved[k], (real(*)[4])a[2] + 4 * ((JOINTS + 1) * i + k));)
FUNCTION(chain_displacements, {WHOLE, NUMBERS(struct chain)}, {ITEMS, JOINTS},
         {WRITTEN, 16 * (JOINTS + 1)})

EACH(chain_jacobian, posture turned; chain_posture(THE(struct chain, 0), PART(1, JOINTS), &turned);
     chain_jacobian(&turned, ROWS(2, 6));)
FUNCTION(chain_jacobian, {WHOLE, NUMBERS(struct chain)}, {ITEMS, JOINTS}, {WRITTEN, 6 * JOINTS})

/* The smallest singular value of each Jacobian, its metres divided by a length. */
EACH(chain_sigma_min, real jacobian[6][JOINTS]; posture turned;
     chain_posture(THE(struct chain, 0), PART(2, JOINTS), &turned);
     chain_jacobian(&turned, jacobian); scale_jacobian(*a[1], jacobian);
     a[3][i] = smallest_singular_value(jacobian);)
FUNCTION(chain_sigma_min, {WHOLE, NUMBERS(struct chain)}, {WHOLE, 1}, {ITEMS, JOINTS},
         {WRITTEN, 1})

EACH(closed_branches, struct frame pose = pose_of(PART(1, 3), PART(2, 9));
     closed_branches(THE(struct closed_form, 0), &pose, PART(3, JOINTS),
                     ROWS(4, CLOSED_BRANCHES));)
FUNCTION(closed_branches, {WHOLE, NUMBERS(struct closed_form)}, {ITEMS, 3}, {ITEMS, 9},
         {ITEMS, JOINTS}, {WRITTEN, CLOSED_BRANCHES * JOINTS})

EACH(closed_gap, struct frame pose = pose_of(PART(1, 3), PART(2, 9));
     closed_gap(THE(struct closed_form, 0), &pose, ONE(struct gap, 3));)
FUNCTION(closed_gap, {WHOLE, NUMBERS(struct closed_form)}, {ITEMS, 3}, {ITEMS, 9},
         {WRITTEN, NUMBERS(struct gap)})

/* All branches, unwrapped, and NaN; how many of the joints to be near to are not finite. */
EACH(arm_branches, struct frame pose = pose_of(PART(1, 3), PART(2, 9));
     real(*rows)[JOINTS] = ROWS(4, MOST_BRANCHES); const real *near = PART(3, JOINTS);
     int count = arm_branches(THE(struct arm, 0), &pose, near, rows);
     for (int k = 0; k < count; k++) unwrap(&THE(struct arm, 0)->ranges, near, rows[k]);
     fill_nan(rows + count, rows + MOST_BRANCHES); sum += !are_finite(near, JOINTS);)
FUNCTION(arm_branches, {WHOLE, NUMBERS(struct arm)}, {ITEMS, 3}, {ITEMS, 9}, {ITEMS, JOINTS},
         {WRITTEN, MOST_BRANCHES * JOINTS})

EACH(arm_inverse, struct frame pose = pose_of(PART(1, 3), PART(2, 9));
     sum += !arm_inverse(THE(struct arm, 0), &pose, PART(3, JOINTS), PART(4, JOINTS));)
FUNCTION(arm_inverse, {WHOLE, NUMBERS(struct arm)}, {ITEMS, 3}, {ITEMS, 9}, {ITEMS, JOINTS},
         {WRITTEN, JOINTS})

EACH(arm_miss, struct frame pose = pose_of(PART(1, 3), PART(2, 9));
     arm_miss(THE(struct arm, 0), &pose, PART(3, 6));)
FUNCTION(arm_miss, {WHOLE, NUMBERS(struct arm)}, {ITEMS, 3}, {ITEMS, 9}, {WRITTEN, 6})

/* Candidates, and NaN; a[1] is the length and the loop. For how many poses they are certain. */
EACH(general_candidates, struct frame pose = pose_of(PART(2, 3), PART(3, 9));
     real(*rows)[JOINTS] = ROWS(4, MOST_CANDIDATES); int are_certain;
     int count = general_candidates(THE(struct chain, 0), a[1][0], (int)a[1][1], &pose, rows,
                                    &are_certain);
     fill_nan(rows + count, rows + MOST_CANDIDATES); sum += are_certain;)
FUNCTION(general_candidates, {WHOLE, NUMBERS(struct chain)}, {WHOLE, 2}, {ITEMS, 3}, {ITEMS, 9},
         {WRITTEN, MOST_CANDIDATES * JOINTS})

static Py_ssize_t call_arm_along(real *const *a, Py_ssize_t items)
{
    arm_along(THE(struct arm, 0), (const real(*)[3])a[2], (const real(*)[9])a[3], (long)items,
              a[1], (real(*)[JOINTS])a[4]);
    return 0;
}
FUNCTION(arm_along, {WHOLE, NUMBERS(struct arm)}, {WHOLE, JOINTS}, {ITEMS, 3}, {ITEMS, 9},
         {WRITTEN, JOINTS})

EACH(decompose, decompose(THE(struct chain, 0), *a[1], PART(2, JOINTS), ONE(struct decomposed, 3));)
FUNCTION(decompose, {WHOLE, NUMBERS(struct chain)}, {WHOLE, 1}, {ITEMS, JOINTS},
         {WRITTEN, NUMBERS(struct decomposed)})

EACH(turning, turning(THE(struct decomposed, 0), PART(1, JOINTS), PART(2, 6));)
FUNCTION(turning, {WHOLE, NUMBERS(struct decomposed)}, {ITEMS, JOINTS}, {WRITTEN, 6})

EACH(line_rates, line_rates(THE(struct decomposed, 0), *a[1], PART(2, 6), a[3] ? PART(3, 6) : NULL,
                            ONE(struct line, 4));)
FUNCTION(line_rates, {WHOLE, NUMBERS(struct decomposed)}, {WHOLE, 1}, {ITEMS, 6}, {OPTIONAL, 6},
         {WRITTEN, NUMBERS(struct line)})

EACH(damped_rates, damped_rates(THE(struct decomposed, 0), *a[1], PART(2, 6), PART(3, JOINTS));)
FUNCTION(damped_rates, {WHOLE, NUMBERS(struct decomposed)}, {WHOLE, 1}, {ITEMS, 6},
         {WRITTEN, JOINTS})

/* Adds what is missed in a tick of a[1][1] seconds to the way back; it and the tool's twist are in
   metres again. */
EACH(part_driven, real missed[6]; real *back = PART(4, 6), *moving = PART(6, 6);
     a[5][i] = part_driven(THE(struct decomposed, 0), PART(2, 6), PART(3, JOINTS), missed, moving);
     for (int k = 0; k < 6; k++) back[k] += a[1][1] * missed[k] * (k < 3 ? a[1][0] : 1);
     for (int k = 0; k < 3; k++) moving[k] *= a[1][0];)
FUNCTION(part_driven, {WHOLE, NUMBERS(struct decomposed)}, {WHOLE, 2}, {ITEMS, 6}, {ITEMS, JOINTS},
         {WRITTEN, 6}, {WRITTEN, 1}, {WRITTEN, 6})

EACH(room_of, room_of(THE(struct joint_limits, 0), PART(1, JOINTS), PART(2, 2 * JOINTS));)
FUNCTION(room_of, {WHOLE, NUMBERS(struct joint_limits)}, {ITEMS, JOINTS}, {WRITTEN, 2 * JOINTS})

EACH(scale_rates, *ONE(struct rate_scale, 5) =
                      scale_rates(THE(struct joint_limits, 0), PART(1, 2 * JOINTS),
                                  PART(2, JOINTS), PART(3, JOINTS), a[4][0], a[4][1]);)
FUNCTION(scale_rates, {WHOLE, NUMBERS(struct joint_limits)}, {ITEMS, 2 * JOINTS}, {ITEMS, JOINTS},
         {ITEMS, JOINTS}, {WHOLE, 2}, {WRITTEN, NUMBERS(struct rate_scale)})

EACH(follow_rates, follow_rates(THE(struct joint_limits, 0), PART(1, 2 * JOINTS), a[3][0],
                                PART(2, JOINTS), a[3][1], PART(4, JOINTS), PART(5, JOINTS));)
FUNCTION(follow_rates, {WHOLE, NUMBERS(struct joint_limits)}, {ITEMS, 2 * JOINTS},
         {ITEMS, JOINTS}, {WHOLE, 2}, {WRITTEN, JOINTS}, {WRITTEN, JOINTS})

PyMethodDef ARM_FUNCTIONS[] = {
    METHOD(chain_forward),
    METHOD(chain_displacements),
    METHOD(chain_jacobian),
    METHOD(chain_sigma_min),
    METHOD(closed_branches),
    METHOD(closed_gap),
    METHOD(arm_branches),
    METHOD(arm_inverse),
    METHOD(arm_miss),
    METHOD(general_candidates),
    METHOD(arm_along),
    METHOD(decompose),
    METHOD(turning),
    METHOD(line_rates),
    METHOD(damped_rates),
    METHOD(part_driven),
    METHOD(room_of),
    METHOD(scale_rates),
    METHOD(follow_rates),
    {NULL, NULL, 0, NULL},
};
