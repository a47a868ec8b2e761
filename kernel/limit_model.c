#include "limit_model.h"

#include <stddef.h>

#include "vector.h"

#define DIFFERENCE REAL(1e-6) /* as part of the length */

struct frame displaced(const struct descent *d, struct frame from, const real step[6])
{
    real twist[6];
    for (int k = 0; k < 6; k++)
        twist[k] = k < 3 ? step[k] : step[k] / d->platform->length;
    se3_move(twist, &from);
    return from;
}

void put_offset(const struct descent *d, const struct frame *from, const struct frame *to,
                real offset[6])
{
    se3_twist(from, to, offset);
    for (int k = 3; k < 6; k++)
        offset[k] *= d->platform->length;
}

void put_margins(const struct descent *d, const struct frame *place, real margins[BOUNDS])
{
    real arm[3], origin[3], joints[LEGS], values[VALUES];
    rotate3(place->rotation, d->pivot, arm);
    minus3(place->position, arm, origin);
    leg_inverse(&d->platform->legs, origin, place->rotation, NULL, joints);
    limited_values(d->platform, origin, place->rotation, joints, values);
    for (int i = 0; i < VALUES; i++) {
        margins[i] = values[i] - d->low[i];
        margins[VALUES + i] = d->high[i] - values[i];
    }
}

/* The slope of one margin in one direction, and how steep its steeper side is; of one side, where
   the other has no value. */
static real slope(real behind, real here, real ahead, real *steeper)
{
    real up = ahead - here, down = here - behind;
    up = isfinite(up) ? up : down;
    down = isfinite(down) ? down : up;
    *steeper = fmax(real_fabs(up), real_fabs(down));
    return isfinite(up) ? (up + down) / 2 : 0;
}

void put_model(const struct descent *d, const struct frame *place, struct model *model)
{
    real here[BOUNDS], sides[6][2][BOUNDS], size = DIFFERENCE * d->platform->length;
    put_margins(d, place, here);
    for (int k = 0; k < 6; k++)
        for (int side = 0; side < 2; side++) {
            real step[6] = {0};
            step[k] = side ? size : -size;
            struct frame beside = displaced(d, *place, step);
            put_margins(d, &beside, sides[k][side]);
        }
    model->count = 0;
    for (int i = 0; i < BOUNDS; i++) {
        real normal[6], steepness = 0, steeper;
        for (int k = 0; k < 6; k++) {
            normal[k] = slope(sides[k][0][i], here[i], sides[k][1][i], &steeper) / size;
            steepness += isfinite(steeper) ? steeper * steeper / (size * size) : 0;
        }
        steepness = real_sqrt(steepness);
        if (!isfinite(here[i]) || !(steepness > 0))
            continue;
        for (int k = 0; k < 6; k++)
            model->normal[model->count][k] = normal[k] / steepness;
        model->slack[model->count] = here[i] / steepness - d->clearance;
        model->steepness[model->count] = steepness;
        model->row[model->count++] = i;
    }
    put_offset(d, place, &d->target, model->goal);
}
