/* What Python calls of the platforms' mathematics. Points and directions come as Python has them,
   leg by leg. */
#include <string.h>

#include "braking.h"
#include "capsules.h"
#include "descent.h"
#include "least_distance.h"
#include "limits.h"
#include "matrix6.h"
#include "newton.h"
#include "python.h"
#include "rods.h"
#include "se3.h"
#include "stack.h"
#include "vector.h"

static void by_axis(const real points[3 * LEGS], real columns[3][LEGS])
{
    for (int i = 0; i < LEGS; i++)
        for (int k = 0; k < 3; k++)
            columns[k][i] = points[3 * i + k];
}

static void by_leg(real columns[3][LEGS], real points[3 * LEGS])
{
    for (int i = 0; i < LEGS; i++)
        for (int k = 0; k < 3; k++)
            points[3 * i + k] = columns[k][i];
}

static Py_ssize_t call_leg_inverse(real *const *a, Py_ssize_t items)
{
    Py_ssize_t open = 0;
    for (Py_ssize_t i = 0; i < items; i++)
        open += leg_inverse((const struct legs *)a[0], a[1] + 3 * i, a[2] + 9 * i,
                            a[3] ? a[3] + LEGS * i : NULL, a[4] + LEGS * i);
    return open;
}
FUNCTION(leg_inverse, {WHOLE, NUMBERS(struct legs)}, {ITEMS, 3}, {ITEMS, 9}, {OPTIONAL, LEGS},
         {WRITTEN, LEGS})

static Py_ssize_t call_leg_branches(real *const *a, Py_ssize_t items)
{
    Py_ssize_t open = 0;
    for (Py_ssize_t i = 0; i < items; i++)
        open += leg_branches((const struct legs *)a[0], a[1] + 3 * i, a[2] + 9 * i,
                             a[3] + LEGS * i, a[4] + LEGS * i);
    return open;
}
FUNCTION(leg_branches, {WHOLE, NUMBERS(struct legs)}, {ITEMS, 3}, {ITEMS, 9}, {WRITTEN, LEGS},
         {WRITTEN, LEGS})

static Py_ssize_t call_leg_points(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++) {
        real points[3][LEGS];
        leg_points((const struct legs *)a[0], a[1] + LEGS * i, points);
        by_leg(points, a[2] + 3 * LEGS * i);
    }
    return 0;
}
FUNCTION(leg_points, {WHOLE, NUMBERS(struct legs)}, {ITEMS, LEGS}, {WRITTEN, 3 * LEGS})

static Py_ssize_t call_leg_gains(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++) {
        real unit[3][LEGS];
        by_axis(a[2] + 3 * LEGS * i, unit);
        leg_gains((const struct legs *)a[0], a[1] + LEGS * i, unit, a[3] + LEGS * i);
    }
    return 0;
}
FUNCTION(leg_gains, {WHOLE, NUMBERS(struct legs)}, {ITEMS, LEGS}, {ITEMS, 3 * LEGS},
         {WRITTEN, LEGS})

/* What screws add to the joints of linear legs, and its rows for a unit twist. */
static Py_ssize_t call_screw_turns(real *const *a, Py_ssize_t items)
{
    const struct legs *legs = (const struct legs *)a[0];
    real base[3][LEGS];
    memcpy(base, legs->shape.centre, sizeof base);
    for (Py_ssize_t i = 0; i < items; i++) {
        const real *rotation = a[2] + 9 * i;
        real columns[6][LEGS] = {{0}};
        struct rods rods = rods_of(base, legs->shape.end, a[1] + 3 * i, rotation);
        screw_lengths(&legs->screws, &rods, rotation, a[3] + LEGS * i);
        add_screw_columns(&legs->screws, &rods, rotation, 1, columns);
        for (int leg = 0; leg < LEGS; leg++)
            for (int k = 0; k < 6; k++)
                a[4][36 * i + 6 * leg + k] = columns[k][leg];
    }
    return 0;
}
FUNCTION(screw_turns, {WHOLE, NUMBERS(struct legs)}, {ITEMS, 3}, {ITEMS, 9}, {WRITTEN, LEGS},
         {WRITTEN, 36})

/* Platform joints, base points, poses: the rods' unit vectors, and the leg Jacobian. */
static Py_ssize_t call_leg_jacobian(real *const *a, Py_ssize_t items)
{
    struct newton_problem problem;
    const struct newton_problem *ends = &problem;
    real columns[6][LEGS];
    by_axis(a[0], problem.end);
    for (Py_ssize_t i = 0; i < items; i++) {
        by_axis(a[1] + 3 * LEGS * i, problem.base);
        struct rods rods = rods_of(problem.base, ends->end, a[2] + 3 * i, a[3] + 9 * i);
        by_leg(rods.unit, a[4] + 3 * LEGS * i);
        leg_columns(&rods, 1, columns);
        for (int leg = 0; leg < LEGS; leg++)
            for (int k = 0; k < 6; k++)
                a[5][36 * i + 6 * leg + k] = columns[k][leg];
    }
    return 0;
}
FUNCTION(leg_jacobian, {WHOLE, 3 * LEGS}, {ITEMS, 3 * LEGS}, {ITEMS, 3}, {ITEMS, 9},
         {WRITTEN, 3 * LEGS}, {WRITTEN, 36})

static Py_ssize_t call_smallest_singular_value(real *const *a, Py_ssize_t items)
{
    real matrix[6][6];
    for (Py_ssize_t i = 0; i < items; i++) {
        for (int row = 0; row < 6; row++)
            for (int k = 0; k < 6; k++)
                matrix[row][k] = a[1][36 * i + 6 * row + k] / (k < 3 ? 1 : *a[0]);
        a[2][i] = smallest_singular_value(matrix);
    }
    return 0;
}
FUNCTION(smallest_singular_value, {WHOLE, 1}, {ITEMS, 36}, {WRITTEN, 1})

static Py_ssize_t call_forward_by_lengths(real *const *a, Py_ssize_t items)
{
    struct newton_problem problem;
    by_axis(a[0], problem.end);
    problem.screws = NULL;
    for (Py_ssize_t i = 0; i < items; i++) {
        real *position = a[6] + 3 * i, *rotation = a[7] + 9 * i;
        by_axis(a[2] + 3 * LEGS * i, problem.base);
        memcpy(problem.length, a[3] + LEGS * i, sizeof problem.length);
        memcpy(position, a[4] + 3 * i, 3 * sizeof(real));
        memcpy(rotation, a[5] + 9 * i, 9 * sizeof(real));
        ((struct newton_report *)a[8])[i] =
            newton(&problem, (const struct newton_rules *)a[1], position, rotation);
    }
    return 0;
}
FUNCTION(forward_by_lengths, {WHOLE, 3 * LEGS}, {WHOLE, NUMBERS(struct newton_rules)},
         {ITEMS, 3 * LEGS}, {ITEMS, LEGS}, {ITEMS, 3}, {ITEMS, 9}, {WRITTEN, 3}, {WRITTEN, 9},
         {WRITTEN, NUMBERS(struct newton_report)})

static Py_ssize_t call_platform_forward(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++) {
        real *position = a[5] + 3 * i, *rotation = a[6] + 9 * i;
        memcpy(position, a[3] + 3 * i, 3 * sizeof(real));
        memcpy(rotation, a[4] + 9 * i, 9 * sizeof(real));
        ((struct newton_report *)a[7])[i] =
            platform_forward((const struct platform *)a[0], (const struct newton_rules *)a[1],
                             a[2] + LEGS * i, position, rotation);
    }
    return 0;
}
FUNCTION(platform_forward, {WHOLE, NUMBERS(struct platform)},
         {WHOLE, NUMBERS(struct newton_rules)}, {ITEMS, LEGS}, {ITEMS, 3}, {ITEMS, 9},
         {WRITTEN, 3}, {WRITTEN, 9}, {WRITTEN, NUMBERS(struct newton_report)})

static Py_ssize_t call_limited_values(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++)
        limited_values((const struct platform *)a[0], a[1] + 3 * i, a[2] + 9 * i, a[3] + LEGS * i,
                       a[4] + VALUES * i);
    return 0;
}
FUNCTION(limited_values, {WHOLE, NUMBERS(struct platform)}, {ITEMS, 3}, {ITEMS, 9}, {ITEMS, LEGS},
         {WRITTEN, VALUES})

/* Stack; whether each end begins where the one before came to, all of the row then ending with the
   first that does not settle; ends; free twists; sections; whether they settled. */
static Py_ssize_t call_stack_sections(real *const *a, Py_ssize_t items)
{
    const struct stack *stack = (const struct stack *)a[0];
    for (Py_ssize_t i = 0; i < items; i++) {
        struct placement end, sections[MOST_SECTIONS];
        real *free = a[4] + 6 * MOST_SECTIONS * i;
        a[7][i] = 0;
        if (i > 0 && *a[1] != 0) {
            if (a[7][i - 1] == 0)
                continue;
            memcpy(free, free - 6 * MOST_SECTIONS, 6 * MOST_SECTIONS * sizeof(real));
        }
        memcpy(end.position, a[2] + 3 * i, sizeof end.position);
        memcpy(end.rotation, a[3] + 9 * i, sizeof end.rotation);
        a[7][i] = stack_sections(stack, &end, free, sections);
        for (int k = 0; k < (int)stack->count; k++) {
            memcpy(a[5] + 3 * (MOST_SECTIONS * i + k), sections[k].position, 3 * sizeof(real));
            memcpy(a[6] + 9 * (MOST_SECTIONS * i + k), sections[k].rotation, 9 * sizeof(real));
        }
    }
    return 0;
}
FUNCTION(stack_sections, {WHOLE, NUMBERS(struct stack)}, {WHOLE, 1}, {ITEMS, 3}, {ITEMS, 9},
         {WRITTEN, 6 * MOST_SECTIONS}, {WRITTEN, 3 * MOST_SECTIONS}, {WRITTEN, 9 * MOST_SECTIONS},
         {WRITTEN, 1})

static Py_ssize_t call_limit_ranges(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++)
        ((struct limit_ranges *)a[3])[i] =
            limit_ranges((const struct platform *)a[0], a[1] + VALUES * i, a[2] + VALUES * i);
    return 0;
}
FUNCTION(limit_ranges, {WHOLE, NUMBERS(struct platform)}, {ITEMS, VALUES}, {ITEMS, VALUES},
         {WRITTEN, NUMBERS(struct limit_ranges)})

/* Writes 1 for a configuration that keeps all limits, else 0; returns how many do. */
static Py_ssize_t call_keeps_limits(real *const *a, Py_ssize_t items)
{
    Py_ssize_t count = 0;
    for (Py_ssize_t i = 0; i < items; i++) {
        int kept = keeps_limits((const struct platform *)a[0], (const struct limit_ranges *)a[1],
                                a[2] + 3 * i, a[3] + 9 * i, a[4] + LEGS * i);
        a[5][i] = kept;
        count += kept;
    }
    return count;
}
FUNCTION(keeps_limits, {WHOLE, NUMBERS(struct platform)}, {WHOLE, NUMBERS(struct limit_ranges)},
         {ITEMS, 3}, {ITEMS, 9}, {ITEMS, LEGS}, {WRITTEN, 1})

static Py_ssize_t call_rotation_exp(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++)
        rotation_exp(a[0] + 3 * i, a[1] + 9 * i);
    return 0;
}
FUNCTION(rotation_exp, {ITEMS, 3}, {WRITTEN, 9})

static Py_ssize_t call_rotation_log(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++)
        rotation_log(a[0] + 9 * i, a[1] + 3 * i);
    return 0;
}
FUNCTION(rotation_log, {ITEMS, 9}, {WRITTEN, 3})

static Py_ssize_t call_quaternion_of(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++)
        quaternion_of(a[0] + 9 * i, a[1] + 4 * i);
    return 0;
}
FUNCTION(quaternion_of, {ITEMS, 9}, {WRITTEN, 4})

/* Tolerance; quaternions. Returns how many are longer or shorter than one by more than that. */
static Py_ssize_t call_rotation_of(real *const *a, Py_ssize_t items)
{
    Py_ssize_t others = 0;
    for (Py_ssize_t i = 0; i < items; i++) {
        const real *q = a[1] + 4 * i;
        real length = real_sqrt(dot3(q, q) + q[3] * q[3]);
        others += !(real_fabs(length - 1) <= a[0][0]);
        rotation_of(q, a[2] + 9 * i);
    }
    return others;
}
FUNCTION(rotation_of, {WHOLE, 1}, {ITEMS, 4}, {WRITTEN, 9})

static Py_ssize_t call_moved(real *const *a, Py_ssize_t items)
{
    Py_ssize_t endless = 0;
    for (Py_ssize_t i = 0; i < items; i++) {
        real *position = a[3] + 3 * i, *rotation = a[4] + 9 * i, sum = 0;
        memcpy(position, a[0] + 3 * i, 3 * sizeof(real));
        memcpy(rotation, a[1] + 9 * i, 9 * sizeof(real));
        se3_move(a[2] + 6 * i, position, rotation);
        for (int k = 0; k < 3; k++)
            sum += real_fabs(position[k]) + real_fabs(rotation[4 * k]);
        endless += !(sum < INFINITY);
    }
    return endless;
}
FUNCTION(moved, {ITEMS, 3}, {ITEMS, 9}, {ITEMS, 6}, {WRITTEN, 3}, {WRITTEN, 9})

static Py_ssize_t call_twist_between(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++)
        se3_twist(a[0] + 3 * i, a[1] + 9 * i, a[2] + 3 * i, a[3] + 9 * i, a[4] + 6 * i);
    return 0;
}
FUNCTION(twist_between, {ITEMS, 3}, {ITEMS, 9}, {ITEMS, 3}, {ITEMS, 9}, {WRITTEN, 6})

static Py_ssize_t call_least_distance(real *const *a, Py_ssize_t items)
{
    return least_distance(a[0], (const real(*)[6])a[1], a[2], items, a[3]);
}
FUNCTION(least_distance, {WHOLE, 6}, {ITEMS, 6}, {ITEMS, 1}, {WRITTEN, 1})

/* Platform, lowest and highest values, pivot; clearance and most steps; target; start; end. */
static Py_ssize_t call_descended(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++) {
        const struct descent descent = {
            .platform = (const struct platform *)a[0],
            .low = a[1],
            .high = a[2],
            .pivot = a[3],
            .clearance = a[4][0],
            .target_position = a[5] + 3 * i,
            .target_rotation = a[6] + 9 * i,
        };
        memcpy(a[9] + 3 * i, a[7] + 3 * i, 3 * sizeof(real));
        memcpy(a[10] + 9 * i, a[8] + 9 * i, 9 * sizeof(real));
        descend(&descent, (int)a[4][1], a[9] + 3 * i, a[10] + 9 * i);
    }
    return 0;
}
FUNCTION(descended, {WHOLE, NUMBERS(struct platform)}, {WHOLE, VALUES}, {WHOLE, VALUES},
         {WHOLE, 3}, {WHOLE, 2}, {ITEMS, 3}, {ITEMS, 9}, {ITEMS, 3}, {ITEMS, 9}, {WRITTEN, 3},
         {WRITTEN, 9})

/* Platform, ranges, frame, bounds; the present pose, joints and rates; twists; their paths. Returns
   the index of the first twist with no obstacle, or how many there are; paths beyond are 0. */
static Py_ssize_t call_first_free_path(real *const *a, Py_ssize_t items)
{
    const struct jogged machine = {(const struct platform *)a[0], (const struct limit_ranges *)a[1],
                                   (const struct jog_frame *)a[2], (const struct jog_bounds *)a[3]};
    const struct jog_state from = {a[4], a[5], a[6], a[7]};
    struct braking_path *paths = (struct braking_path *)a[9];
    memset(paths, 0, (size_t)items * sizeof *paths);
    Py_ssize_t i = 0;
    for (; i < items; i++) {
        paths[i] = braking_path(&machine, &from, a[8] + 6 * i);
        if (paths[i].obstacle == NOTHING)
            break;
    }
    return i;
}
FUNCTION(first_free_path, {WHOLE, NUMBERS(struct platform)}, {WHOLE, NUMBERS(struct limit_ranges)},
         {WHOLE, NUMBERS(struct jog_frame)}, {WHOLE, NUMBERS(struct jog_bounds)}, {WHOLE, 3},
         {WHOLE, 9}, {WHOLE, LEGS}, {WHOLE, LEGS}, {ITEMS, 6},
         {WRITTEN, NUMBERS(struct braking_path)})

/* Two segments of six numbers each; their distance. */
static Py_ssize_t call_segment_distance(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++)
        a[2][i] = segment_distance(a[0] + 6 * i, a[1] + 6 * i);
    return 0;
}
FUNCTION(segment_distance, {ITEMS, 6}, {ITEMS, 6}, {WRITTEN, 1})

/* Segments and boxes; how far each segment is from breaking the rule of its box. */
static Py_ssize_t call_box_clearance(real *const *a, Py_ssize_t items)
{
    const struct box *boxes = (const struct box *)a[1];
    for (Py_ssize_t i = 0; i < items; i++)
        a[2][i] = box_clearance(a[0] + 6 * i, boxes + i);
    return 0;
}
FUNCTION(box_clearance, {ITEMS, 6}, {ITEMS, NUMBERS(struct box)}, {WRITTEN, 1})

PyMethodDef PLATFORM_FUNCTIONS[] = {
    METHOD(leg_inverse),
    METHOD(leg_branches),
    METHOD(leg_points),
    METHOD(leg_gains),
    METHOD(screw_turns),
    METHOD(leg_jacobian),
    METHOD(smallest_singular_value),
    METHOD(forward_by_lengths),
    METHOD(platform_forward),
    METHOD(limited_values),
    METHOD(stack_sections),
    METHOD(limit_ranges),
    METHOD(keeps_limits),
    METHOD(rotation_exp),
    METHOD(rotation_log),
    METHOD(quaternion_of),
    METHOD(rotation_of),
    METHOD(moved),
    METHOD(twist_between),
    METHOD(least_distance),
    METHOD(descended),
    METHOD(first_free_path),
    METHOD(segment_distance),
    METHOD(box_clearance),
    {NULL, NULL, 0, NULL},
};
