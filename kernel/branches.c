#include "branches.h"

#include "trigonometry.h"

/* What a radian outside the range costs against a squared radian of distance: (11.1). */
#define OUTSIDE_COST REAL(1e6)
/* So much beyond its range, in rad, an angle counts as at its end. */
#define ROUNDING REAL(1e-12)

real nearest_turn(real angle, real near)
{
    return angle - REAL_TURN * nearest_integer((angle - near) * (1 / REAL_TURN));
}

static real outside(real angle, real low, real high)
{
    return angle < low ? low - angle : angle > high ? angle - high : 0;
}

void unwrap(const struct ranges *ranges, const real near[JOINTS], real joints[JOINTS])
{
    for (int i = 0; i < JOINTS; i++) {
        real low = ranges->low[i], high = ranges->high[i];
        real nearest = nearest_turn(joints[i], near[i]), moved = nearest;
        if (nearest < low - ROUNDING)
            moved = nearest_turn(nearest, low - ROUNDING + REAL_PI);
        else if (nearest > high + ROUNDING)
            moved = nearest_turn(nearest, high + ROUNDING - REAL_PI);
        joints[i] = outside(moved, low, high) < outside(nearest, low, high) ? moved : nearest;
    }
}

int are_within(const struct ranges *ranges, const real joints[JOINTS])
{
    for (int i = 0; i < JOINTS; i++)
        if (!(ranges->low[i] <= joints[i] && joints[i] <= ranges->high[i]))
            return 0;
    return 1;
}

int nearest_branch(const struct ranges *ranges, const real near[JOINTS],
                   real (*branches)[JOINTS], int count)
{
    int best = -1;
    real least = (real)INFINITY, low[JOINTS], high[JOINTS];
    for (int i = 0; i < JOINTS; i++) {
        low[i] = near[i] < ranges->low[i] ? near[i] : ranges->low[i];
        high[i] = near[i] > ranges->high[i] ? near[i] : ranges->high[i];
    }
    for (int k = 0; k < count; k++) {
        real cost = 0;
        for (int i = 0; i < JOINTS; i++) {
            real away = branches[k][i] - near[i];
            cost += away * away + OUTSIDE_COST * outside(branches[k][i], low[i], high[i]);
        }
        if (cost < least) { /* NaN never is */
            least = cost;
            best = k;
        }
    }
    return best;
}

int continued(real (*branches)[JOINTS], int count, const real ahead[JOINTS], real joints[JOINTS])
{
    real least = (real)INFINITY;
    for (int k = 0; k < count; k++) {
        real most = 0, moved[JOINTS];
        for (int i = 0; i < JOINTS; i++) {
            moved[i] = nearest_turn(branches[k][i], ahead[i]);
            real away = real_fabs(moved[i] - ahead[i]);
            most = away <= most ? most : away; /* NaN stays */
        }
        if (most < least) {
            least = most;
            for (int i = 0; i < JOINTS; i++)
                joints[i] = moved[i];
        }
    }
    return least < (real)INFINITY;
}
