/* What Python calls of the arms' mathematics. */
#include "arm.h"
#include "general.h"
#include "line_keeping.h"
#include "matrix6.h"
#include "rate_scaling.h"
#include "python.h"

#include <string.h>

static Py_ssize_t call_chain_forward(real *const *a, Py_ssize_t items)
{
    Py_ssize_t lost = 0;
    for (Py_ssize_t i = 0; i < items; i++) {
        posture turned;
        chain_posture((const struct chain *)a[0], a[1] + JOINTS * i, &turned);
        memcpy(a[2] + 3 * i, turned.tool.position, sizeof turned.tool.position);
        memcpy(a[3] + 9 * i, turned.tool.rotation, sizeof turned.tool.rotation);
        const real *place = turned.tool.position;
        lost += !isfinite(place[0] + place[1] + place[2]);
    }
    return lost;
}
FUNCTION(chain_forward, {WHOLE, NUMBERS(struct chain)}, {ITEMS, JOINTS}, {WRITTEN, 3},
         {WRITTEN, 9})

/* As square matrices, four rows of four. */
static Py_ssize_t call_chain_displacements(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++) {
        struct frame moved[JOINTS + 1];
        chain_displacements((const struct chain *)a[0], a[1] + JOINTS * i, moved);
        for (int k = 0; k <= JOINTS; k++) {
            real *matrix = a[2] + 16 * ((JOINTS + 1) * i + k);
            for (int row = 0; row < 3; row++) {
                memcpy(matrix + 4 * row, moved[k].rotation + 3 * row, 3 * sizeof(real));
                matrix[4 * row + 3] = moved[k].position[row];
                matrix[12 + row] = 0;
            }
            matrix[15] = 1;
        }
    }
    return 0;
}
FUNCTION(chain_displacements, {WHOLE, NUMBERS(struct chain)}, {ITEMS, JOINTS},
         {WRITTEN, 16 * (JOINTS + 1)})

static Py_ssize_t call_chain_jacobian(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++) {
        posture turned;
        chain_posture((const struct chain *)a[0], a[1] + JOINTS * i, &turned);
        chain_jacobian(&turned, (real(*)[JOINTS])a[2] + 6 * i);
    }
    return 0;
}
FUNCTION(chain_jacobian, {WHOLE, NUMBERS(struct chain)}, {ITEMS, JOINTS}, {WRITTEN, 6 * JOINTS})

/* The smallest singular value of each Jacobian, its metres divided by a length. */
static Py_ssize_t call_chain_sigma_min(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++) {
        real jacobian[6][JOINTS];
        posture turned;
        chain_posture((const struct chain *)a[0], a[2] + JOINTS * i, &turned);
        chain_jacobian(&turned, jacobian);
        scale_jacobian(*a[1], jacobian);
        a[3][i] = smallest_singular_value(jacobian);
    }
    return 0;
}
FUNCTION(chain_sigma_min, {WHOLE, NUMBERS(struct chain)}, {WHOLE, 1}, {ITEMS, JOINTS},
         {WRITTEN, 1})

static struct frame pose_of(const real *positions, const real *rotations, Py_ssize_t i)
{
    struct frame pose;
    memcpy(pose.position, positions + 3 * i, sizeof pose.position);
    memcpy(pose.rotation, rotations + 9 * i, sizeof pose.rotation);
    return pose;
}

static Py_ssize_t call_closed_branches(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++) {
        struct frame pose = pose_of(a[1], a[2], i);
        closed_branches((const struct closed_form *)a[0], &pose, a[3] + JOINTS * i,
                        (real(*)[JOINTS])a[4] + CLOSED_BRANCHES * i);
    }
    return 0;
}
FUNCTION(closed_branches, {WHOLE, NUMBERS(struct closed_form)}, {ITEMS, 3}, {ITEMS, 9},
         {ITEMS, JOINTS}, {WRITTEN, CLOSED_BRANCHES * JOINTS})

static Py_ssize_t call_closed_gap(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++) {
        struct frame pose = pose_of(a[1], a[2], i);
        closed_gap((const struct closed_form *)a[0], &pose, (struct gap *)a[3] + i);
    }
    return 0;
}
FUNCTION(closed_gap, {WHOLE, NUMBERS(struct closed_form)}, {ITEMS, 3}, {ITEMS, 9},
         {WRITTEN, NUMBERS(struct gap)})

/* All branches, unwrapped, and NaN; how many of the joints to be near to are not finite. */
static Py_ssize_t call_arm_branches(real *const *a, Py_ssize_t items)
{
    const struct arm *arm = (const struct arm *)a[0];
    Py_ssize_t unknown = 0;
    for (Py_ssize_t i = 0; i < items; i++) {
        struct frame pose = pose_of(a[1], a[2], i);
        real(*rows)[JOINTS] = (real(*)[JOINTS])a[4] + MOST_BRANCHES * i;
        const real *near = a[3] + JOINTS * i;
        int count = arm_branches(arm, &pose, near, rows);
        for (int k = 0; k < count; k++)
            unwrap(&arm->ranges, near, rows[k]);
        for (real *rest = rows[count]; rest < rows[MOST_BRANCHES]; rest++)
            *rest = (real)NAN;
        for (int k = 0, is_known = 1; k < JOINTS; k++) {
            unknown += is_known && !isfinite(near[k]);
            is_known &= isfinite(near[k]) != 0;
        }
    }
    return unknown;
}
FUNCTION(arm_branches, {WHOLE, NUMBERS(struct arm)}, {ITEMS, 3}, {ITEMS, 9}, {ITEMS, JOINTS},
         {WRITTEN, MOST_BRANCHES * JOINTS})

static Py_ssize_t call_arm_inverse(real *const *a, Py_ssize_t items)
{
    Py_ssize_t lost = 0;
    for (Py_ssize_t i = 0; i < items; i++) {
        struct frame pose = pose_of(a[1], a[2], i);
        lost += !arm_inverse((const struct arm *)a[0], &pose, a[3] + JOINTS * i,
                             a[4] + JOINTS * i);
    }
    return lost;
}
FUNCTION(arm_inverse, {WHOLE, NUMBERS(struct arm)}, {ITEMS, 3}, {ITEMS, 9}, {ITEMS, JOINTS},
         {WRITTEN, JOINTS})

/* Each row's candidates, and NaN; a[1] is the length and where the loop begins. */
static Py_ssize_t call_general_candidates(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++) {
        struct frame pose = pose_of(a[2], a[3], i);
        real(*rows)[JOINTS] = (real(*)[JOINTS])a[4] + MOST_CANDIDATES * i;
        int count = general_candidates((const struct chain *)a[0], a[1][0], (int)a[1][1], &pose, rows);
        for (real *rest = rows[count]; rest < rows[MOST_CANDIDATES]; rest++)
            *rest = (real)NAN;
    }
    return 0;
}
FUNCTION(general_candidates, {WHOLE, NUMBERS(struct chain)}, {WHOLE, 2}, {ITEMS, 3}, {ITEMS, 9},
         {WRITTEN, MOST_CANDIDATES * JOINTS})

static Py_ssize_t call_arm_miss(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++) {
        struct frame pose = pose_of(a[1], a[2], i);
        arm_miss((const struct arm *)a[0], &pose, a[3] + 6 * i);
    }
    return 0;
}
FUNCTION(arm_miss, {WHOLE, NUMBERS(struct arm)}, {ITEMS, 3}, {ITEMS, 9}, {WRITTEN, 6})

static Py_ssize_t call_arm_along(real *const *a, Py_ssize_t items)
{
    arm_along((const struct arm *)a[0], (const real(*)[3])a[2], (const real(*)[9])a[3],
              (long)items, a[1], (real(*)[JOINTS])a[4]);
    return 0;
}
FUNCTION(arm_along, {WHOLE, NUMBERS(struct arm)}, {WHOLE, JOINTS}, {ITEMS, 3}, {ITEMS, 9},
         {WRITTEN, JOINTS})

static Py_ssize_t call_decompose(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++)
        decompose((const struct chain *)a[0], *a[1], a[2] + JOINTS * i,
                  (struct decomposed *)a[3] + i);
    return 0;
}
FUNCTION(decompose, {WHOLE, NUMBERS(struct chain)}, {WHOLE, 1}, {ITEMS, JOINTS},
         {WRITTEN, NUMBERS(struct decomposed)})

static Py_ssize_t call_turning(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++)
        turning((const struct decomposed *)a[0], a[1] + JOINTS * i, a[2] + 6 * i);
    return 0;
}
FUNCTION(turning, {WHOLE, NUMBERS(struct decomposed)}, {ITEMS, JOINTS}, {WRITTEN, 6})

static Py_ssize_t call_line_rates(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++)
        line_rates((const struct decomposed *)a[0], *a[1], a[2] + 6 * i, a[3] ? a[3] + 6 * i : NULL,
                   (struct line *)a[4] + i);
    return 0;
}
FUNCTION(line_rates, {WHOLE, NUMBERS(struct decomposed)}, {WHOLE, 1}, {ITEMS, 6}, {OPTIONAL, 6},
         {WRITTEN, NUMBERS(struct line)})

static Py_ssize_t call_damped_rates(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++)
        damped_rates((const struct decomposed *)a[0], *a[1], a[2] + 6 * i, a[3] + JOINTS * i);
    return 0;
}
FUNCTION(damped_rates, {WHOLE, NUMBERS(struct decomposed)}, {WHOLE, 1}, {ITEMS, 6},
         {WRITTEN, JOINTS})

/* Adds what is missed in a tick of a[1][1] seconds to the way back, in metres again. */
static Py_ssize_t call_part_driven(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++) {
        real missed[6];
        a[5][i] = part_driven((const struct decomposed *)a[0], a[2] + 6 * i, a[3] + JOINTS * i,
                              missed);
        for (int k = 0; k < 6; k++)
            a[4][6 * i + k] += a[1][1] * missed[k] * (k < 3 ? a[1][0] : 1);
    }
    return 0;
}
FUNCTION(part_driven, {WHOLE, NUMBERS(struct decomposed)}, {WHOLE, 2}, {ITEMS, 6}, {ITEMS, JOINTS},
         {WRITTEN, 6}, {WRITTEN, 1})

static Py_ssize_t call_room_of(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++)
        room_of((const struct joint_limits *)a[0], a[1] + JOINTS * i, a[2] + 2 * JOINTS * i);
    return 0;
}
FUNCTION(room_of, {WHOLE, NUMBERS(struct joint_limits)}, {ITEMS, JOINTS}, {WRITTEN, 2 * JOINTS})

static Py_ssize_t call_scale_rates(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++)
        ((struct rate_scale *)a[5])[i] =
            scale_rates((const struct joint_limits *)a[0], a[1] + 2 * JOINTS * i,
                        a[2] + JOINTS * i, a[3] + JOINTS * i, a[4][0], a[4][1]);
    return 0;
}
FUNCTION(scale_rates, {WHOLE, NUMBERS(struct joint_limits)}, {ITEMS, 2 * JOINTS}, {ITEMS, JOINTS},
         {ITEMS, JOINTS}, {WHOLE, 2}, {WRITTEN, NUMBERS(struct rate_scale)})

static Py_ssize_t call_follow_rates(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++)
        follow_rates((const struct joint_limits *)a[0], a[1] + 2 * JOINTS * i, a[3][0],
                     a[2] + JOINTS * i, a[3][1], a[4] + JOINTS * i, a[5] + JOINTS * i);
    return 0;
}
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
