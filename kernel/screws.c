#include "screws.h"

#include "vector.h"

/* An axis beside a rod: its parts along the rod, and across it, how long that is; and the
   direction in which the latter turns about the rod. */
struct beside {
    real axis[3], along, across[3], size, turning[3];
};

static struct beside beside(const real axis[3], const real unit[3])
{
    struct beside b = {.along = dot3(axis, unit)};
    for (int k = 0; k < 3; k++) {
        b.axis[k] = axis[k];
        b.across[k] = axis[k] - b.along * unit[k];
    }
    b.size = real_sqrt(dot3(b.across, b.across));
    cross3(unit, b.across, b.turning);
    for (int k = 0; k < 3; k++)
        b.turning[k] /= b.size;
    return b;
}

static void put_both(const struct screws *screws, const struct rods *rods, const real rotation[9],
                     int i, struct beside *base, struct beside *platform)
{
    real unit[3], below[3], carried[3], above[3];
    for (int k = 0; k < 3; k++) {
        unit[k] = rods->unit[k][i];
        below[k] = screws->base_axis[k][i];
        carried[k] = screws->platform_axis[k][i];
    }
    rotate3(rotation, carried, above);
    *base = beside(below, unit);
    *platform = beside(above, unit);
}

void screw_lengths(const struct screws *screws, const struct rods *rods, const real rotation[9],
                   real extra[LEGS])
{
    for (int i = 0; i < LEGS; i++) {
        struct beside base, platform;
        put_both(screws, rods, rotation, i, &base, &platform);
        real sine = dot3(base.turning, platform.across) * base.size;
        real turn = real_atan2(sine, dot3(base.across, platform.across));
        extra[i] = screws->lead / REAL_TURN * turn;
    }
}

void add_screw_columns(const struct screws *screws, const struct rods *rods,
                       const real rotation[9], real length, real columns[6][LEGS])
{
    real pitch = screws->lead / REAL_TURN;
    for (int i = 0; i < LEGS; i++) {
        struct beside base, platform;
        real by_end[3], arm[3], turned[3], carried[3];
        put_both(screws, rods, rotation, i, &base, &platform);
        for (int k = 0; k < 3; k++) {
            real swing = base.along / base.size * base.turning[k] -
                         platform.along / platform.size * platform.turning[k];
            by_end[k] = pitch * swing / rods->length[i];
            arm[k] = rods->arm[k][i];
        }
        cross3(arm, by_end, turned);
        cross3(platform.axis, platform.turning, carried);
        for (int k = 0; k < 3; k++) {
            columns[k][i] += by_end[k];
            columns[3 + k][i] += (turned[k] + pitch / platform.size * carried[k]) / length;
        }
    }
}
