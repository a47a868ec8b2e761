/* What Python calls of the platforms' mathematics. Points and directions come as Python has them,
   leg by leg. */
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

static void by_axis(const real *points, real columns[][LEGS], int axes)
{
    for (int i = 0; i < LEGS; i++)
        for (int k = 0; k < axes; k++)
            columns[k][i] = points[axes * i + k];
}

static void by_leg(real columns[][LEGS], real *points, int axes)
{
    for (int i = 0; i < LEGS; i++)
        for (int k = 0; k < axes; k++)
            points[axes * i + k] = columns[k][i];
}

SUM(leg_inverse, leg_inverse(AS(struct legs, 0), a[1], a[2], a[3], a[4]))
SUM(leg_branches, leg_branches(AS(struct legs, 0), a[1], a[2], a[3], a[4]))

static Py_ssize_t each_leg_points(real *const *a)
{
    real points[3][LEGS];
    leg_points(AS(struct legs, 0), a[1], points);
    by_leg(points, a[2], 3);
    return 0;
}

static Py_ssize_t each_leg_gains(real *const *a)
{
    real unit[3][LEGS];
    by_axis(a[2], unit, 3);
    leg_gains(AS(struct legs, 0), a[1], unit, a[3]);
    return 0;
}

/* What screws add to the joints of linear legs, and its rows for a unit twist. */
static Py_ssize_t each_screw_turns(real *const *a)
{
    const struct legs *legs = AS(struct legs, 0);
    real columns[6][LEGS] = {{0}};
    struct rods rods = rods_of(legs->shape.centre, legs->shape.end, a[1], a[2]);
    screw_lengths(&legs->screws, &rods, a[2], a[3]);
    add_screw_columns(&legs->screws, &rods, a[2], 1, columns);
    by_leg(columns, a[4], 6);
    return 0;
}

/* Platform joints, base points, poses: the rods' unit vectors, and the leg Jacobian. */
static Py_ssize_t each_leg_jacobian(real *const *a)
{
    real end[3][LEGS], base[3][LEGS], columns[6][LEGS];
    by_axis(a[0], end, 3);
    by_axis(a[1], base, 3);
    struct rods rods = rods_of(base, end, a[2], a[3]);
    by_leg(rods.unit, a[4], 3);
    leg_columns(&rods, 1, columns);
    by_leg(columns, a[5], 6);
    return 0;
}

static Py_ssize_t each_smallest_singular_value(real *const *a)
{
    real matrix[6][6];
    for (int row = 0; row < 6; row++)
        for (int k = 0; k < 6; k++)
            matrix[row][k] = a[1][6 * row + k] / (k < 3 ? 1 : *a[0]);
    *a[2] = smallest_singular_value(matrix);
    return 0;
}

static Py_ssize_t each_forward_by_lengths(real *const *a)
{
    struct newton_problem problem = {.screws = NULL};
    by_axis(a[0], problem.end, 3);
    by_axis(a[2], problem.base, 3);
    memcpy(problem.length, a[3], sizeof problem.length);
    struct frame pose = pose_of(a + 4);
    *AS(struct newton_report, 8) = newton(&problem, AS(struct newton_rules, 1), &pose);
    put_pose(&pose, a[6], a[7]);
    return 0;
}

static Py_ssize_t each_platform_forward(real *const *a)
{
    struct frame pose = pose_of(a + 3);
    *AS(struct newton_report, 7) =
        platform_forward(AS(struct platform, 0), AS(struct newton_rules, 1), a[2], &pose);
    put_pose(&pose, a[5], a[6]);
    return 0;
}

DO(limited_values, limited_values(AS(struct platform, 0), a[1], a[2], a[3], a[4]))

/* Stack; whether each end begins where the one before came to, all of the row then ending with the
   first that does not settle; ends; free twists; sections; whether they settled. */
static Py_ssize_t all_stack_sections(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++) {
        real *const at[2] = {a[2] + 3 * i, a[3] + 9 * i};
        struct frame end = pose_of(at), sections[MOST_SECTIONS];
        real *free = a[4] + 6 * MOST_SECTIONS * i;
        a[7][i] = 0;
        if (i > 0 && *a[1] != 0) {
            if (a[7][i - 1] == 0)
                continue;
            for (int k = 0; k < 6 * MOST_SECTIONS; k++)
                free[k] = free[k - 6 * MOST_SECTIONS];
        }
        a[7][i] = stack_sections(AS(struct stack, 0), &end, free, sections);
        for (int k = 0; k < (int)AS(struct stack, 0)->count; k++)
            put_pose(sections + k, a[5] + 3 * (MOST_SECTIONS * i + k),
                     a[6] + 9 * (MOST_SECTIONS * i + k));
    }
    return 0;
}

DO(limit_ranges, *AS(struct limit_ranges, 3) = limit_ranges(AS(struct platform, 0), a[1], a[2]))

/* Writes 1 for a configuration that keeps all limits, else 0; in sum how many do. */
static Py_ssize_t each_keeps_limits(real *const *a)
{
    int kept = keeps_limits(AS(struct platform, 0), AS(struct limit_ranges, 1), a[2], a[3], a[4]);
    *a[5] = kept;
    return kept;
}

DO(rotation_exp, rotation_exp(a[0], a[1]))
DO(rotation_log, rotation_log(a[0], a[1]))
DO(quaternion_of, quaternion_of(a[0], a[1]))

/* Tolerance; quaternions. In sum how many are longer or shorter than one by more than that. */
static Py_ssize_t each_rotation_of(real *const *a)
{
    const real *q = a[1];
    rotation_of(q, a[2]);
    return !(real_fabs(real_sqrt(dot3(q, q) + q[3] * q[3]) - 1) <= *a[0]);
}

/* In sum how many poses are not finite. */
static Py_ssize_t each_moved(real *const *a)
{
    real sum = 0;
    struct frame pose = pose_of(a);
    se3_move(a[2], &pose);
    put_pose(&pose, a[3], a[4]);
    for (int k = 0; k < 3; k++)
        sum += real_fabs(pose.position[k]) + real_fabs(pose.rotation[4 * k]);
    return !(sum < INFINITY);
}

DO(twist_between, se3_twist(POSE(0), POSE(2), a[4]))

static Py_ssize_t all_least_distance(real *const *a, Py_ssize_t items)
{
    return least_distance(a[0], (const real(*)[6])a[1], a[2], items, a[3]);
}

/* Platform, lowest and highest values, pivot; clearance and most steps; target; start; end. */
static Py_ssize_t each_descended(real *const *a)
{
    const struct descent descent = {
        AS(struct platform, 0), a[1], a[2], a[3], pose_of(a + 5), a[4][0]};
    struct frame pose = pose_of(a + 7);
    descend(&descent, (int)a[4][1], &pose);
    put_pose(&pose, a[9], a[10]);
    return 0;
}

/* Platform, ranges, frame, bounds; the present pose, joints and rates; twists; their paths. Returns
   the index of the first twist with no obstacle, or how many there are; paths beyond are 0. */
static Py_ssize_t all_first_free_path(real *const *a, Py_ssize_t items)
{
    const struct jogged machine = {AS(struct platform, 0), AS(struct limit_ranges, 1),
                                   AS(struct jog_frame, 2), AS(struct jog_bounds, 3)};
    const struct jog_state from = {pose_of(a + 4), a[6], a[7]};
    struct braking_path *paths = AS(struct braking_path, 9);
    memset(paths, 0, (size_t)items * sizeof *paths);
    Py_ssize_t i = 0;
    for (; i < items; i++) {
        paths[i] = braking_path(&machine, &from, a[8] + 6 * i);
        if (paths[i].obstacle == NOTHING)
            break;
    }
    return i;
}

/* Two segments of six numbers each; their distance. */
DO(segment_distance, *a[2] = segment_distance(a[0], a[1]))

/* Segments and boxes; how far each segment is from breaking the rule of its box. */
DO(box_clearance, *a[2] = box_clearance(a[0], AS(struct box, 1)))

struct function PLATFORM_FUNCTIONS[] = {
    EACH(leg_inverse, ONCE(struct legs), IN(real[3]), IN(real[9]), MAYBE(real[6]), OUT(real[6])),
    EACH(leg_branches, ONCE(struct legs), IN(real[3]), IN(real[9]), OUT(real[6]), OUT(real[6])),
    EACH(leg_points, ONCE(struct legs), IN(real[6]), OUT(real[6][3])),
    EACH(leg_gains, ONCE(struct legs), IN(real[6]), IN(real[6][3]), OUT(real[6])),
    EACH(screw_turns, ONCE(struct legs), IN(real[3]), IN(real[9]), OUT(real[6]), OUT(real[6][6])),
    EACH(leg_jacobian, ONCE(real[6][3]), IN(real[6][3]), IN(real[3]), IN(real[9]),
         OUT(real[6][3]), OUT(real[6][6])),
    EACH(smallest_singular_value, ONCE(real), IN(real[6][6]), OUT(real)),
    EACH(forward_by_lengths, ONCE(real[6][3]), ONCE(struct newton_rules), IN(real[6][3]),
         IN(real[6]), IN(real[3]), IN(real[9]), OUT(real[3]), OUT(real[9]),
         OUT(struct newton_report)),
    EACH(platform_forward, ONCE(struct platform), ONCE(struct newton_rules), IN(real[6]),
         IN(real[3]), IN(real[9]), OUT(real[3]), OUT(real[9]), OUT(struct newton_report)),
    EACH(limited_values, ONCE(struct platform), IN(real[3]), IN(real[9]), IN(real[6]),
         OUT(real[VALUES])),
    ALL(stack_sections, ONCE(struct stack), ONCE(real), IN(real[3]), IN(real[9]),
        OUT(real[MOST_SECTIONS][6]), OUT(real[MOST_SECTIONS][3]), OUT(real[MOST_SECTIONS][9]),
        OUT(real)),
    EACH(limit_ranges, ONCE(struct platform), IN(real[VALUES]), IN(real[VALUES]),
         OUT(struct limit_ranges)),
    EACH(keeps_limits, ONCE(struct platform), ONCE(struct limit_ranges), IN(real[3]), IN(real[9]),
         IN(real[6]), OUT(real)),
    EACH(rotation_exp, IN(real[3]), OUT(real[9])),
    EACH(rotation_log, IN(real[9]), OUT(real[3])),
    EACH(quaternion_of, IN(real[9]), OUT(real[4])),
    EACH(rotation_of, ONCE(real), IN(real[4]), OUT(real[9])),
    EACH(moved, IN(real[3]), IN(real[9]), IN(real[6]), OUT(real[3]), OUT(real[9])),
    EACH(twist_between, IN(real[3]), IN(real[9]), IN(real[3]), IN(real[9]), OUT(real[6])),
    ALL(least_distance, ONCE(real[6]), IN(real[6]), IN(real), OUT(real)),
    EACH(descended, ONCE(struct platform), ONCE(real[VALUES]), ONCE(real[VALUES]), ONCE(real[3]),
         ONCE(real[2]), IN(real[3]), IN(real[9]), IN(real[3]), IN(real[9]), OUT(real[3]),
         OUT(real[9])),
    ALL(first_free_path, ONCE(struct platform), ONCE(struct limit_ranges), ONCE(struct jog_frame),
        ONCE(struct jog_bounds), ONCE(real[3]), ONCE(real[9]), ONCE(real[6]), ONCE(real[6]),
        IN(real[6]), OUT(struct braking_path)),
    EACH(segment_distance, IN(real[6]), IN(real[6]), OUT(real)),
    EACH(box_clearance, IN(real[6]), IN(struct box), OUT(real)),
    {.each = 0},
};
