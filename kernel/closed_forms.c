#include "closed_forms.h"

#include "subproblems.h"

/* Joint 1, both turns of the arm's plane with `tip` in it towards the target: section 4, 1. */
static int joint_1(const struct chain *chain, const real tip[3], const real target[3],
                   struct turn free, struct turn q1[2])
{
    real arm[3], towards[3];
    minus3(tip, chain->point[0], arm);
    minus3(target, chain->point[0], towards);
    return projections(chain->axis[0], chain->axis[1], towards, dot3(chain->axis[1], arm), free,
                       q1);
}

/* The target as joint 1's link sees it, from the shoulder. */
static void from_shoulder(const struct chain *chain, struct turn q1, const real target[3],
                          real local[3])
{
    real arm[3], turned[3];
    minus3(target, chain->point[0], arm);
    rotate_about(chain->axis[0], turn_back(q1), arm, turned);
    for (int i = 0; i < 3; i++)
        local[i] = turned[i] + chain->point[0][i] - chain->point[1][i];
}

/* Joints 2 and 3, both elbows, that bring `tip` to the target: section 4, 2. */
static int shoulder_and_elbow(const struct chain *chain, const real tip[3], const real target[3],
                              const struct turn free[JOINTS], struct turn q2[2],
                              struct turn q3[2])
{
    real upper[3], fore[3];
    minus3(chain->point[1], chain->point[2], upper);
    minus3(tip, chain->point[2], fore);
    if (!distances(chain->axis[2], fore, upper, dot3(target, target), free[2], q3))
        return 0;
    for (int elbow = 0; elbow < 2; elbow++) {
        real turned[3], reached[3];
        rotate_about(chain->axis[2], q3[elbow], fore, turned);
        minus3(turned, upper, reached);
        q2[elbow] = facing(chain->axis[1], reached, target, free[1]);
    }
    return 1;
}

/* What joints 1 to 3 have turned, turned back. */
static void undo_three(const struct chain *chain, const struct turn q[3], const real vector[3],
                       real undone[3])
{
    real once[3], twice[3];
    rotate_about(chain->axis[0], turn_back(q[0]), vector, once);
    rotate_about(chain->axis[1], turn_back(q[1]), once, twice);
    rotate_about(chain->axis[2], turn_back(q[2]), twice, undone);
}

/* Joints 4 to 6, both ways, that take w6 to `tool` and `across` to `side`: section 4, 3. */
static void spherical_wrist(const struct chain *chain, const real tool[3], const real across[3],
                            const real side[3], const struct turn free[JOINTS],
                            const real inner[3], real branches[2][JOINTS])
{
    const real *w4 = chain->axis[3], *w5 = chain->axis[4], *w6 = chain->axis[5];
    struct turn rough[2];
    if (!projections(w5, w6, w4, dot3(tool, w4), free[4], rough))
        return;
    for (int way = 0; way < 2; way++) {
        real leaning[3], ahead[3], aside[3], turned[3];
        rotate_about(w5, rough[way], w6, leaning);
        struct turn q4 = facing(w4, leaning, tool, free[3]);
        rotate_about(w4, turn_back(q4), tool, ahead);
        struct turn q5 = facing(w5, w6, ahead, rough[way]);
        rotate_about(w4, turn_back(q4), side, aside);
        rotate_about(w5, turn_back(q5), aside, turned);
        for (int i = 0; i < 3; i++)
            branches[way][i] = inner[i];
        branches[way][3] = turn_angle(q4);
        branches[way][4] = turn_angle(q5);
        branches[way][5] = turn_angle(facing(w6, across, turned, free[5]));
    }
}

/* Joint 1, times the elbow, times the wrist. */
static void with_spherical_wrist(const struct closed_form *form, const struct frame *moved,
                                 const struct turn free[JOINTS],
                                 real branches[CLOSED_BRANCHES][JOINTS])
{
    const struct chain *chain = &form->chain;
    real centre[3], across[3], far_tool[3], far_side[3];
    struct turn q1[2], q2[2], q3[2];
    moved_point(moved, form->centre, centre);
    perpendicular(chain->axis[5], across);
    rotate3(moved->rotation, chain->axis[5], far_tool);
    rotate3(moved->rotation, across, far_side);
    if (!joint_1(chain, form->centre, centre, free[0], q1))
        return;
    for (int front = 0; front < 2; front++) {
        real target[3], tool[3], side[3];
        from_shoulder(chain, q1[front], centre, target);
        if (!shoulder_and_elbow(chain, form->centre, target, free, q2, q3))
            continue;
        for (int elbow = 0; elbow < 2; elbow++) {
            struct turn q[3] = {q1[front], q2[elbow], q3[elbow]};
            real inner[3] = {turn_angle(q[0]), turn_angle(q[1]), turn_angle(q[2])};
            undo_three(chain, q, far_tool, tool);
            undo_three(chain, q, far_side, side);
            spherical_wrist(chain, tool, across, side, free, inner,
                            branches + 4 * front + 2 * elbow);
        }
    }
}

/* Joints 5 and 6, both ways, for joint 1: they bring the normal of the plane of joints 2 to 4,
   which those cannot turn, to its place: section 5, 2. */
static int outer_wrist(const struct chain *chain, const struct frame *moved, struct turn q1,
                       const struct turn free[JOINTS], struct turn q5[2], struct turn q6[2])
{
    const real *w2 = chain->axis[1], *w5 = chain->axis[4], *w6 = chain->axis[5];
    real turned[3], normal[3] = {0, 0, 0}, leaning[3], there[3];
    struct turn rough[2];
    rotate_about(chain->axis[0], q1, w2, turned);
    for (int row = 0; row < 3; row++)
        for (int i = 0; i < 3; i++)
            normal[i] += moved->rotation[3 * row + i] * turned[row];
    if (!projections(w5, w6, w2, dot3(normal, w6), free[4], rough))
        return 0;
    for (int way = 0; way < 2; way++) {
        rotate_about(w5, turn_back(rough[way]), w2, leaning);
        q6[way] = facing(w6, normal, leaning, free[5]);
        rotate_about(w6, q6[way], normal, there);
        q5[way] = facing(w5, there, w2, rough[way]);
    }
    return 1;
}

/* The displacement without joints 1, 5 and 6: where joints 2 to 4 must bring joint 4's point,
   from the shoulder, and how far they must turn in all: section 5, 3. */
static struct turn inner_target(const struct closed_form *form, const struct frame *moved,
                                struct turn q1, struct turn q5, struct turn q6, struct turn free,
                                real target[3])
{
    const struct chain *chain = &form->chain;
    const real *w2 = chain->axis[1], *w5 = chain->axis[4], *w6 = chain->axis[5];
    real arm[3], side[3], a[3], b[3], there[3];
    minus3(chain->point[3], form->centre, arm);
    rotate_about(w5, turn_back(q5), arm, a);
    rotate_about(w6, turn_back(q6), a, b);
    for (int i = 0; i < 3; i++)
        b[i] += form->centre[i];
    moved_point(moved, b, there);
    from_shoulder(chain, q1, there, target);
    perpendicular(w2, side);
    rotate_about(w5, turn_back(q5), side, a);
    rotate_about(w6, turn_back(q6), a, b);
    rotate3(moved->rotation, b, a);
    rotate_about(chain->axis[0], turn_back(q1), a, there);
    return facing(w2, side, there, free);
}

static void elbow_branches(const struct closed_form *form, const struct frame *moved,
                           const struct turn outer[3], const struct turn free[JOINTS],
                           real branches[2][JOINTS])
{
    const struct chain *chain = &form->chain;
    real target[3];
    struct turn q2[2], q3[2];
    struct turn all = inner_target(form, moved, outer[0], outer[1], outer[2], free[3], target);
    if (!shoulder_and_elbow(chain, chain->point[3], target, free, q2, q3))
        return;
    real sense_3 = dot3(chain->axis[1], chain->axis[2]) > 0 ? 1 : -1;
    real sense_4 = dot3(chain->axis[1], chain->axis[3]) > 0 ? 1 : -1;
    real angle = turn_angle(all), q1 = turn_angle(outer[0]);
    real q5 = turn_angle(outer[1]), q6 = turn_angle(outer[2]);
    for (int elbow = 0; elbow < 2; elbow++) {
        real *q = branches[elbow];
        q[0] = q1;
        q[1] = turn_angle(q2[elbow]);
        q[2] = turn_angle(q3[elbow]);
        q[3] = sense_4 * (angle - q[1] - sense_3 * q[2]);
        q[4] = q5;
        q[5] = q6;
    }
}

/* Joint 1, times the wrist, times the elbow. */
static void with_parallel_axes(const struct closed_form *form, const struct frame *moved,
                               const struct turn free[JOINTS],
                               real branches[CLOSED_BRANCHES][JOINTS])
{
    real centre[3];
    struct turn q1[2], q5[2], q6[2];
    moved_point(moved, form->centre, centre);
    if (!joint_1(&form->chain, form->centre, centre, free[0], q1))
        return;
    for (int front = 0; front < 2; front++)
        if (outer_wrist(&form->chain, moved, q1[front], free, q5, q6))
            for (int way = 0; way < 2; way++) {
                struct turn outer[3] = {q1[front], q5[way], q6[way]};
                elbow_branches(form, moved, outer, free, branches + 4 * front + 2 * way);
            }
}

void closed_branches(const struct closed_form *form, const struct frame *pose,
                     const real near[JOINTS], real branches[CLOSED_BRANCHES][JOINTS])
{
    struct frame moved;
    struct turn free[JOINTS];
    displacement(&form->chain, pose, &moved);
    for (int i = 0; i < JOINTS; i++) {
        free[i] = turn_by(near[i]);
        for (int k = 0; k < CLOSED_BRANCHES; k++)
            branches[k][i] = (real)NAN;
    }
    if (form->has_parallel_axes > 0)
        with_parallel_axes(form, &moved, free, branches);
    else
        with_spherical_wrist(form, &moved, free, branches);
}

/* How near to joint 1's axis what has to be reached is, and may be. */
static void gap_of_joint_1(const struct closed_form *form, const real centre[3], struct gap *gap)
{
    const struct chain *chain = &form->chain;
    real away[3], arm[3], across[3];
    minus3(centre, chain->point[0], away);
    minus3(form->centre, chain->point[0], arm);
    cross3(chain->axis[0], away, across);
    *gap = (struct gap){0, real_sqrt(dot3(across, across)),
                        real_fabs(dot3(chain->axis[1], arm)), (real)INFINITY};
}

/* A vector's length in the plane of joints 2 and 3. */
static real in_plane(const struct chain *chain, const real vector[3])
{
    real across[3];
    cross3(chain->axis[1], vector, across);
    return real_sqrt(dot3(across, across));
}

/* The gap of the one target, of those seen so far, that comes nearest to being reached. */
static void gap_of_elbow(const struct chain *chain, const real tip[3], const real target[3],
                         struct gap *gap)
{
    real upper[3], fore[3];
    minus3(chain->point[2], chain->point[1], upper);
    minus3(tip, chain->point[2], fore);
    real a = in_plane(chain, upper), b = in_plane(chain, fore), d = in_plane(chain, target);
    real least = real_fabs(a - b), most = a + b;
    real beyond = d - most > least - d ? d - most : least - d;
    real known = gap->distance - most > least - gap->distance ? gap->distance - most
                                                              : least - gap->distance;
    if (!(gap->is_at_shoulder > 0) || beyond < known)
        *gap = (struct gap){1, d, least, most};
}

void closed_gap(const struct closed_form *form, const struct frame *pose, struct gap *gap)
{
    static const real ZEROS[JOINTS] = {0};
    struct turn free[JOINTS], q1[2], q5[2], q6[2];
    struct frame moved;
    real centre[3], target[3];
    for (int i = 0; i < JOINTS; i++)
        free[i] = turn_by(ZEROS[i]);
    displacement(&form->chain, pose, &moved);
    moved_point(&moved, form->centre, centre);
    gap_of_joint_1(form, centre, gap);
    if (!joint_1(&form->chain, form->centre, centre, free[0], q1))
        return;
    for (int front = 0; front < 2; front++) {
        if (!(form->has_parallel_axes > 0)) {
            from_shoulder(&form->chain, q1[front], centre, target);
            gap_of_elbow(&form->chain, form->centre, target, gap);
        } else if (outer_wrist(&form->chain, &moved, q1[front], free, q5, q6))
            for (int way = 0; way < 2; way++) {
                inner_target(form, &moved, q1[front], q5[way], q6[way], free[3], target);
                gap_of_elbow(&form->chain, form->chain.point[3], target, gap);
            }
    }
}
