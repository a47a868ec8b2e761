#include "descent.h"

#include <string.h>

#include "cholesky.h"
#include "least_distance.h"
#include "limit_model.h"
#include "matrix6.h"

#define SETTLED REAL(1e-7) /* a step that changes nothing, as part of the length */
#define LEAST_CURVATURE REAL(0.2)
enum { SHARES = 10, RESTORATIONS = 2 };

/* The best step within the limits, by a quadratic model, and the limits' multipliers: (2.1). */
static int put_step(const struct model *model, real curvature[6][6], real step[6],
                    real multipliers[BOUNDS])
{
    real factor[6][6], normals[BOUNDS][6];
    memcpy(factor, curvature, sizeof factor);
    if (!factorise(6, 6, factor[0], 0))
        return 0;
    memcpy(step, model->goal, sizeof model->goal);
    memcpy(normals, model->normal, sizeof normals);
    divide_by_factor(6, 6, factor[0], step);
    for (int i = 0; i < model->count; i++)
        divide_by_factor(6, 6, factor[0], normals[i]);
    if (!least_distance(step, (const real(*)[6])normals, model->slack, model->count, multipliers))
        return 0;
    for (int i = 0; i < model->count; i++)
        for (int k = 0; k < 6; k++)
            step[k] += multipliers[i] * normals[i][k];
    divide_by_transposed(6, 6, factor[0], step);
    return 1;
}

/* Puts a trial back inside the limits that the step touches, by Newton's method; returns whether
   it keeps all then. */
static int is_put_right(const struct descent *d, const struct model *model,
                        const real multipliers[BOUNDS], struct frame *trial)
{
    real margins[BOUNDS], normals[BOUNDS][6], slack[BOUNDS], weights[BOUNDS], step[6];
    const real nothing[6] = {0};
    for (int round = 0; round < RESTORATIONS; round++) {
        int count = 0;
        put_margins(d, trial, margins);
        for (int i = 0; i < model->count; i++) {
            real room = margins[model->row[i]] / model->steepness[i] - d->clearance;
            if (!(multipliers[i] > 0) || !isfinite(room))
                continue;
            memcpy(normals[count], model->normal[i], sizeof normals[0]);
            slack[count++] = room;
        }
        if (!least_distance(nothing, (const real(*)[6])normals, slack, count, weights))
            break;
        memset(step, 0, sizeof step);
        for (int i = 0; i < count; i++)
            for (int k = 0; k < 6; k++)
                step[k] += weights[i] * normals[i][k];
        *trial = displaced(d, *trial, step);
    }
    put_margins(d, trial, margins);
    int is_inside = 1;
    for (int i = 0; i < BOUNDS; i++)
        is_inside &= margins[i] >= 0;
    return is_inside;
}

/* The nearest to the target of parts of a step, from all of it down; 0 where none is nearer. */
static int searched(const struct descent *d, const struct model *model, const real step[6],
                    const real multipliers[BOUNDS], struct frame *place)
{
    const struct frame from = *place;
    real best = size6(model->goal) * (1 - REAL(1e-12)), share = 1;
    int is_found = 0;
    for (int i = 0; i < SHARES; i++, share /= 2) {
        real part[6], offset[6];
        for (int k = 0; k < 6; k++)
            part[k] = share * step[k];
        struct frame trial = displaced(d, from, part);
        int is_inside = is_put_right(d, model, multipliers, &trial);
        put_offset(d, &trial, &d->target, offset);
        if (is_inside && size6(offset) < best) {
            best = size6(offset);
            *place = trial;
            is_found = 1;
        } else if (is_found) {
            break;
        }
    }
    return is_found;
}

/* The gradient of half the squared distance less the weighted limits of another place's model. */
static void put_slope(const struct model *model, const real weight_of[BOUNDS], real gradient[6])
{
    for (int k = 0; k < 6; k++) {
        gradient[k] = -model->goal[k];
        for (int i = 0; i < model->count; i++)
            gradient[k] -= weight_of[model->row[i]] * model->normal[i][k];
    }
}

/* Powell's damped update, which stays positive: Nocedal & Wright, (18.14) to (18.16). */
static void update(real curvature[6][6], const real step[6], real change[6])
{
    real along[6];
    for (int i = 0; i < 6; i++)
        along[i] = dot6(curvature[i], step);
    real before = dot6(step, along), now = dot6(step, change);
    if (now < LEAST_CURVATURE * before) {
        real share = (1 - LEAST_CURVATURE) * before / (before - now);
        for (int i = 0; i < 6; i++)
            change[i] = share * change[i] + (1 - share) * along[i];
        now = LEAST_CURVATURE * before;
    }
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 6; k++)
            curvature[i][k] += change[i] * change[k] / now - along[i] * along[k] / before;
}

static void reset(real curvature[6][6])
{
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 6; k++)
            curvature[i][k] = i == k;
}

/* Learns the curvature from a step: what the Lagrangian's gradient changed by. */
static void learn(real curvature[6][6], const struct model *here, const struct model *there,
                  const real multipliers[BOUNDS], const real taken[6])
{
    real weight_of[BOUNDS] = {0}, before[6], after[6];
    for (int i = 0; i < here->count; i++)
        weight_of[here->row[i]] = multipliers[i];
    put_slope(here, weight_of, before);
    put_slope(there, weight_of, after);
    for (int k = 0; k < 6; k++)
        after[k] -= before[k];
    update(curvature, taken, after);
}

void descend(const struct descent *descent, int most_steps, struct frame *place)
{
    struct model models[2], *here = &models[0], *there = &models[1];
    real curvature[6][6], step[6], multipliers[BOUNDS], taken[6];
    int is_fresh = 1;
    reset(curvature);
    put_model(descent, place, here);
    for (int count = 0; count < most_steps; count++) {
        const struct frame from = *place;
        if (!put_step(here, curvature, step, multipliers) ||
            !searched(descent, here, step, multipliers, place)) {
            if (is_fresh)
                break;
            reset(curvature);
            is_fresh = 1;
            continue;
        }
        put_model(descent, place, there);
        put_offset(descent, &from, place, taken);
        learn(curvature, here, there, multipliers, taken);
        struct model *last = here;
        here = there;
        there = last;
        if (is_fresh && size6(taken) < SETTLED * descent->platform->length)
            break;
        is_fresh = 0;
    }
}
