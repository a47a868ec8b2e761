#include "legs.h"

#include "trigonometry.h"

/* So much nearer, in rad or by rod, the other way must be for a leg to be taken for bent that way:
   at the edge of the reach both ways meet, and a machine that comes back bends its legs as at
   home. */
#define WAYS_MEET REAL(0.1)

/* The parts of a gap along a rail and, squared, across it. */
static void put_along(const struct crank_legs *rails, real gap[3][LEGS], real along[LEGS],
                      real across[LEGS])
{
    for (int i = 0; i < LEGS; i++) {
        along[i] = leg_dot(rails->tangent, gap, i);
        across[i] = 0;
        for (int k = 0; k < 3; k++) {
            real rest = gap[k][i] - along[i] * rails->tangent[k][i];
            across[i] += rest * rest;
        }
    }
}

static int rail_branches(const struct crank_legs *rails, real gap[3][LEGS], real behind[LEGS],
                         real *ahead)
{
    real along[LEGS], across[LEGS];
    int open = 0;
    put_along(rails, gap, along, across);
    for (int i = 0; i < LEGS; i++) {
        real reach = real_sqrt(rails->rod[i] * rails->rod[i] - across[i]);
        open += !(reach >= 0); /* counts what is not a number, too */
        behind[i] = (along[i] - reach) / rails->crank[i];
        if (ahead)
            ahead[i] = (along[i] + reach) / rails->crank[i];
    }
    return open;
}

static int linear_branches(const struct legs *legs, const real position[3],
                           const real rotation[9], real lengths[LEGS], real *same)
{
    real extra[LEGS] = {0};
    int open = 0;
    struct rods rods = rods_of(legs->shape.centre, legs->shape.end, position, rotation);
    if (legs->screws.lead != 0)
        screw_lengths(&legs->screws, &rods, rotation, extra);
    for (int i = 0; i < LEGS; i++) {
        lengths[i] = rods.length[i] + extra[i];
        open += !(lengths[i] < INFINITY);
        if (same)
            same[i] = lengths[i];
    }
    return open;
}

int leg_branches(const struct legs *legs, const real position[3], const real rotation[9],
                 real out[LEGS], real *in)
{
    real gap[3][LEGS];
    if (legs->kind == CRANK)
        return crank_elbows(&legs->shape, position, rotation, out, in);
    if (legs->kind == LINEAR)
        return linear_branches(legs, position, rotation, out, in);
    leg_gaps(&legs->shape, position, rotation, gap);
    return rail_branches(&legs->shape, gap, out, in);
}

int leg_inverse(const struct legs *legs, const real position[3], const real rotation[9],
                const real *near, real joints[LEGS])
{
    real in[LEGS];
    if (!near || legs->kind == LINEAR)
        return leg_branches(legs, position, rotation, joints, 0);
    int open = leg_branches(legs, position, rotation, joints, in), is_crank = legs->kind == CRANK;
    for (int i = 0; i < LEGS; i++) {
        real far_out = is_crank ? within_half_a_turn(joints[i], near[i]) : joints[i];
        real far_in = is_crank ? within_half_a_turn(in[i], near[i]) : in[i];
        real difference = real_fabs(far_out - near[i]) - real_fabs(far_in - near[i]);
        real size = is_crank ? 1 : legs->shape.rod[i];
        joints[i] = difference <= WAYS_MEET * size ? far_out : far_in;
    }
    for (int i = 0; i < LEGS; i++)
        open += !(real_fabs(near[i]) < INFINITY);
    return open;
}

static void turned(const real joints[LEGS], real sine[LEGS], real cosine[LEGS])
{
    int is_far = 0;
    for (int i = 0; i < LEGS; i++)
        sine_and_cosine(joints[i], &sine[i], &cosine[i]);
    for (int i = 0; i < LEGS; i++)
        is_far |= real_fabs(joints[i]) > MOST_ANGLE;
    for (int i = 0; is_far && i < LEGS; i++) {
        sine[i] = real_sin(joints[i]);
        cosine[i] = real_cos(joints[i]);
    }
}

/* p - c is r times `along` t + `upward` e. */
static void put_parts(const struct legs *legs, const real joints[LEGS], real along[LEGS],
                      real upward[LEGS])
{
    if (legs->kind == CRANK) {
        turned(joints, upward, along);
        return;
    }
    for (int i = 0; i < LEGS; i++) {
        along[i] = joints[i];
        upward[i] = 0;
    }
}

void leg_points(const struct legs *legs, const real joints[LEGS], real points[3][LEGS])
{
    const struct crank_legs *shape = &legs->shape;
    real along[LEGS], upward[LEGS];
    put_parts(legs, joints, along, upward);
    for (int i = 0; i < LEGS; i++)
        for (int k = 0; k < 3; k++)
            points[k][i] =
                shape->centre[k][i] + shape->crank[i] * (along[i] * shape->tangent[k][i] +
                                                         upward[i] * shape->up[k][i]);
}

void leg_lengths(const struct legs *legs, const real joints[LEGS], real lengths[LEGS])
{
    for (int i = 0; i < LEGS; i++)
        lengths[i] = legs->kind == LINEAR ? joints[i] : legs->shape.rod[i];
}

void leg_rows(const struct legs *legs, const struct rods *rods, const real rotation[9], real length,
              real columns[6][LEGS])
{
    leg_columns(rods, length, columns);
    if (legs->kind == LINEAR && legs->screws.lead != 0)
        add_screw_columns(&legs->screws, rods, rotation, length, columns);
}

void leg_gains(const struct legs *legs, const real joints[LEGS], real unit[3][LEGS],
               real gains[LEGS])
{
    const struct crank_legs *shape = &legs->shape;
    real along[LEGS], upward[LEGS];
    put_parts(legs, joints, along, upward);
    for (int i = 0; i < LEGS; i++) {
        real t = legs->kind == CRANK ? -upward[i] : 1, e = legs->kind == CRANK ? along[i] : 0;
        real sum = e * leg_dot(unit, shape->up, i) + t * leg_dot(unit, shape->tangent, i);
        gains[i] = legs->kind == LINEAR ? 1 : shape->crank[i] * sum;
    }
}

static void crank_misfits(const struct crank_legs *legs, real gap[3][LEGS], real shortfall[LEGS],
                          real surplus[LEGS])
{
    for (int i = 0; i < LEGS; i++) {
        real across = leg_dot(legs->normal, gap, i), r = legs->crank[i];
        real along = leg_dot(legs->tangent, gap, i), up = leg_dot(legs->up, gap, i);
        real in_plane = real_sqrt(along * along + up * up);
        shortfall[i] =
            real_sqrt(across * across + (in_plane - r) * (in_plane - r)) - legs->rod[i];
        surplus[i] = legs->rod[i] - real_sqrt(across * across + (in_plane + r) * (in_plane + r));
    }
}

void leg_misfits(const struct legs *legs, const real position[3], const real rotation[9],
                 real shortfall[LEGS], real surplus[LEGS])
{
    real gap[3][LEGS], along[LEGS], across[LEGS];
    leg_gaps(&legs->shape, position, rotation, gap);
    if (legs->kind == CRANK) {
        crank_misfits(&legs->shape, gap, shortfall, surplus);
        return;
    }
    put_along(&legs->shape, gap, along, across);
    for (int i = 0; i < LEGS; i++) {
        shortfall[i] =
            legs->kind == RAIL ? real_sqrt(across[i]) - legs->shape.rod[i] : -NEVER;
        surplus[i] = -NEVER;
    }
}
