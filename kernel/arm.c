#include "arm.h"

#include "general.h"
#include "numerical.h"
#include "se3.h"
#include "vector.h"

/* Of descent: from anywhere, and from the branches of the ideal arm. */
enum { STARTS = 32, STEPS = 60, FEW_STEPS = 20 };
/* Poses along one row at which all branches are searched for because Newton's method gave up. */
enum { MOST_SEARCHES = 50 };
/* What is left of the error of a solution, metres divided by the length. */
#define TOLERANCE REAL(1e-10)
/* Radians between two solutions of one branch that were found from different starts. */
#define SAME REAL(1e-6)

/* Whether the links, all in one line, come to a place: 6.2. */
static int is_within_reach(const struct chain *chain, const real place[3])
{
    real reach = 0, away[3];
    for (int i = 0; i < JOINTS; i++) {
        const real *next = i + 1 < JOINTS ? chain->point[i + 1] : chain->tool.position;
        for (int k = 0; k < 3; k++)
            away[k] = next[k] - chain->point[i][k];
        reach += real_sqrt(dot3(away, away));
    }
    for (int k = 0; k < 3; k++)
        away[k] = place[k] - chain->point[0][k];
    return real_sqrt(dot3(away, away)) <= reach * (1 + REAL(1e-9));
}

/* Whether joints are those of a branch, whole turns aside. */
static int is_known(real (*branches)[JOINTS], int count, const real joints[JOINTS])
{
    for (int k = 0; k < count; k++) {
        real most = 0;
        for (int i = 0; i < JOINTS; i++) {
            real apart = real_fabs(nearest_turn(joints[i], branches[k][i]) - branches[k][i]);
            most = apart > most ? apart : most;
        }
        if (most < SAME)
            return 1;
    }
    return 0;
}

/* Descends from a start, and keeps what is found there, unless it is known; the number known. */
static int found_from(const struct arm *arm, const struct frame *pose, const real start[JOINTS],
                      int steps, real branches[MOST_BRANCHES][JOINTS], int count)
{
    real joints[JOINTS];
    for (int i = 0; i < JOINTS; i++)
        joints[i] = start[i];
    if (count == MOST_BRANCHES || is_known(branches, count, start)
        || !(descend_joints(&arm->chain, pose, arm->length, steps, joints) < TOLERANCE)
        || is_known(branches, count, joints))
        return count;
    for (int i = 0; i < JOINTS; i++)
        branches[count][i] = joints[i];
    return count + 1;
}

/* Whether branches are missing for certain: they come in pairs, mirrored ones in fours: 6.1. */
static int is_incomplete(const struct arm *arm, int count)
{
    return count % (arm->mirror.joint < 0 ? 2 : 4) != 0;
}

/* Of every branch its mirror image, too: 6.1. */
static int with_images(const struct arm *arm, const struct frame *pose,
                       real branches[MOST_BRANCHES][JOINTS], int count)
{
    for (int k = 0, first = (int)arm->mirror.joint; first >= 0 && k < count; k++) {
        real image[JOINTS];
        for (int i = 0; i < JOINTS; i++)
            image[i] = branches[k][i] + (i == first || i == first + 3 ? REAL_PI : 0);
        for (int i = 0; i < 2; i++)
            image[first + 1 + i] = arm->mirror.sum[i] - branches[k][first + 1 + i];
        count = found_from(arm, pose, image, FEW_STEPS, branches, count);
    }
    return count;
}

/* Of every branch, those added here included, its partner beyond the fold, too: 6.1. */
static int with_folds(const struct arm *arm, const struct frame *pose,
                      real branches[MOST_BRANCHES][JOINTS], int count)
{
    for (int k = 0; k < count; k++) {
        real beyond[JOINTS];
        beyond_fold(&arm->chain, arm->length, branches[k], beyond);
        count = found_from(arm, pose, beyond, FEW_STEPS, branches, count);
    }
    return with_images(arm, pose, branches, count);
}

/* Start k of those that are spread over the ranges evenly: powers of the root of x^7 = x + 1. Of
   more than two turns, or no end, it is one: any other turn is the same place. */
static void cold_start(const struct ranges *ranges, int k, real start[JOINTS])
{
    static const real STEP[JOINTS] = {REAL(0.8986537126286992), REAL(0.8075784952213447),
                                      REAL(0.7257334129697597), REAL(0.6521830259439715),
                                      REAL(0.5860866975779693), REAL(0.5266889867007357)};
    for (int i = 0; i < JOINTS; i++) {
        real part = REAL(0.5) + STEP[i] * (real)k;
        part -= real_floor(part);
        real width = ranges->high[i] - ranges->low[i];
        if (width <= 2 * REAL_TURN * (1 + REAL(1e-9)))
            start[i] = ranges->low[i] + part * width;
        else
            start[i] = (part - REAL(0.5)) * REAL_TURN;
    }
}

/* By damped steps from all over the ranges: 6.2. */
static int from_spread_starts(const struct arm *arm, const struct frame *pose,
                              real branches[MOST_BRANCHES][JOINTS], int count)
{
    for (int k = 0; k < STARTS; k++) {
        real start[JOINTS];
        cold_start(&arm->ranges, k, start);
        count = found_from(arm, pose, start, STEPS, branches, count);
    }
    return count;
}

/* By damped steps from the branches of the arm that this one almost is: 6.4. */
static int from_ideal(const struct arm *arm, const struct frame *pose, const real near[JOINTS],
                      real branches[MOST_BRANCHES][JOINTS], int count)
{
    real starts[CLOSED_BRANCHES][JOINTS];
    closed_branches(&arm->form, pose, near, starts);
    for (int k = 0; k < CLOSED_BRANCHES; k++)
        if (!isnan(starts[k][0]))
            count = found_from(arm, pose, starts[k], FEW_STEPS, branches, count);
    return count;
}

/* From one loop after another, until one is certain, or adds nothing to what was found otherwise:
   6.1. If none is, two branches that almost meet may have been taken for none. */
static int from_elimination(const struct arm *arm, const struct frame *pose,
                            real branches[MOST_BRANCHES][JOINTS], int count)
{
    real candidates[MOST_CANDIDATES][JOINTS];
    int are_certain = 0, has_others = (int)arm->closes == ALMOST_CLOSED, is_done = 0;
    for (int n = 0; n < MOST_LOOPS && arm->loops[n] >= 0 && !is_done; n++) {
        int before = count;
        int known = general_candidates(&arm->solved, arm->length, (int)arm->loops[n], pose,
                                       candidates, &are_certain);
        for (int k = 0; k < known; k++)
            count = found_from(arm, pose, candidates[k], FEW_STEPS, branches, count);
        count = with_images(arm, pose, branches, count);
        is_done = (are_certain || ((n > 0 || has_others) && count == before))
                  && !is_incomplete(arm, count);
    }
    int is_sure = is_done && (are_certain || has_others);
    return is_sure ? count : with_folds(arm, pose, branches, count);
}

/* All branches of an arm without a closed form: 6.1, 6.2 and 6.4. */
static int from_anywhere(const struct arm *arm, const struct frame *pose, const real near[JOINTS],
                         real branches[MOST_BRANCHES][JOINTS])
{
    if (!is_within_reach(&arm->chain, pose->position))
        return 0;
    int count = found_from(arm, pose, near, STEPS, branches, 0);
    if ((int)arm->closes == ALMOST_CLOSED)
        count = from_ideal(arm, pose, near, branches, count);
    count = from_elimination(arm, pose, branches, count);
    return arm->loops[0] < 0 || is_incomplete(arm, count)
               ? from_spread_starts(arm, pose, branches, count)
               : count;
}

int arm_branches(const struct arm *arm, const struct frame *pose, const real near[JOINTS],
                 real branches[MOST_BRANCHES][JOINTS])
{
    if ((int)arm->closes != CLOSED)
        return from_anywhere(arm, pose, near, branches);
    closed_branches(&arm->form, pose, near, branches);
    return CLOSED_BRANCHES;
}

int arm_inverse(const struct arm *arm, const struct frame *pose, const real near[JOINTS],
                real joints[JOINTS])
{
    real branches[MOST_BRANCHES][JOINTS];
    if ((int)arm->closes != CLOSED && continue_nearby(&arm->chain, arm->length, pose, near, joints)
        && are_within(&arm->ranges, joints))
        return 1;
    int count = arm_branches(arm, pose, near, branches);
    for (int k = 0; k < count; k++)
        unwrap(&arm->ranges, near, branches[k]);
    int best = nearest_branch(&arm->ranges, near, branches, count);
    for (int i = 0; i < JOINTS; i++)
        joints[i] = best < 0 ? (real)NAN : branches[best][i];
    return best >= 0;
}

void arm_miss(const struct arm *arm, const struct frame *pose, real miss[6])
{
    real least = (real)INFINITY, joints[JOINTS];
    for (int k = 0; k <= STARTS; k++) {
        cold_start(&arm->ranges, k, joints);
        real left = descend_joints(&arm->chain, pose, arm->length, STEPS, joints);
        if (left < least) {
            posture there;
            least = left;
            chain_posture(&arm->chain, joints, &there);
            se3_twist(&there.tool, pose, miss);
        }
    }
}

void arm_along(const struct arm *arm, const real (*positions)[3], const real (*rotations)[9],
               long count, const real near[JOINTS], real (*joints)[JOINTS])
{
    real last[JOINTS], ahead[JOINTS], branches[MOST_BRANCHES][JOINTS];
    int searches = 0, has_speed = 0;
    for (int i = 0; i < JOINTS; i++)
        last[i] = ahead[i] = near[i];
    for (long n = 0; n < count; n++) {
        struct frame pose;
        for (int i = 0; i < 9; i++)
            pose.rotation[i] = rotations[n][i];
        for (int i = 0; i < 3; i++)
            pose.position[i] = positions[n][i];
        int is_found = (int)arm->closes != CLOSED && searches <= MOST_SEARCHES
                     && continue_nearby(&arm->chain, arm->length, &pose, ahead, joints[n]);
        if (!is_found && ((int)arm->closes == CLOSED || searches++ < MOST_SEARCHES)) {
            int known = arm_branches(arm, &pose, last, branches);
            is_found = continued(branches, known, ahead, joints[n]);
        }
        /* Where joints go on to at their speed: beside postures where two branches meet only the
           motion tells them apart. What precedes the row, or a gap in it, may be far: no speed. */
        for (int i = 0; i < JOINTS; i++) {
            if (!is_found)
                joints[n][i] = (real)NAN;
            real step = is_found && has_speed ? joints[n][i] - last[i] : 0;
            last[i] = is_found ? joints[n][i] : last[i];
            ahead[i] = last[i] + step;
        }
        has_speed = is_found;
    }
}
