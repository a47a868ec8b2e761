#include "limits.h"

#include "matrix6.h"
#include "rods.h"
#include "trigonometry.h"
#include "vector.h"

#define BEYOND_ANY_SINE 2
/* Below, pivots no longer tell singular values apart. */
#define LEAST_PIVOT_MARGIN REAL(1e-3)

static struct rods rods_at(const struct platform *platform, const real position[3],
                           const real rotation[9], const real joints[LEGS])
{
    real base[3][LEGS];
    leg_points(&platform->legs, joints, base);
    return rods_of(base, platform->legs.shape.end, position, rotation);
}

/* Products with the unit rods, one a leg: the sines of their angles to the cranks' planes, and the
   cosines of their angles to their directions at home, as the platform and as the base see it. */
struct products {
    real tilt_sine[LEGS], swing_cosine[LEGS], leaning_cosine[LEGS];
};

static struct products products_of(const struct platform *platform, const struct rods *rods,
                                   const real rotation[9])
{
    struct products p;
    real r[9]; /* from home's orientation */
    product9_back(rotation, platform->home_rotation, r);
    for (int i = 0; i < LEGS; i++) {
        p.tilt_sine[i] = leg_dot(rods->unit, platform->legs.shape.normal, i);
        p.leaning_cosine[i] = leg_dot(rods->unit, platform->home_rod, i);
        p.swing_cosine[i] = 0;
        for (int k = 0; k < 3; k++)
            p.swing_cosine[i] += rods->unit[k][i] * leg_turned(r, platform->home_rod, k, i);
    }
    return p;
}

static real clipped(real cosine)
{
    return cosine > 1 ? 1 : cosine < -1 ? -1 : cosine;
}

/* At home, a leg's angle to its crank's plane. */
static real home_tilt(const struct platform *platform, int leg)
{
    return real_asin(clipped(leg_dot(platform->home_rod, platform->legs.shape.normal, leg)));
}

/* The cosine of the platform's inclination: docs/motion.md, (1.3). */
static real inclination_cosine(const struct platform *platform, const real rotation[9])
{
    const real *h = platform->home_rotation;
    return h[2] * rotation[2] + h[5] * rotation[5] + h[8] * rotation[8];
}

static real rotation_from_home(const struct platform *platform, const real rotation[9])
{
    const real *h = platform->home_rotation, *r = rotation;
    real sine = 0, cosine = 0;
    for (int k = 0; k < 3; k++) {
        sine += h[3 * k + 1] * r[3 * k] - h[3 * k] * r[3 * k + 1];
        cosine += h[3 * k] * r[3 * k] + h[3 * k + 1] * r[3 * k + 1];
    }
    return angle_of(sine, cosine);
}

void limited_values(const struct platform *platform, const real position[3],
                    const real rotation[9], const real joints[LEGS], real values[VALUES])
{
    struct rods rods = rods_at(platform, position, rotation, joints);
    struct products p = products_of(platform, &rods, rotation);
    real columns[6][6];
    leg_misfits(&platform->legs, position, rotation, values + SHORTFALL, values + SURPLUS);
    for (int i = 0; i < LEGS; i++) {
        values[JOINT + i] = joints[i];
        values[TILT + i] = real_asin(clipped(p.tilt_sine[i])) - home_tilt(platform, i);
        values[SWING + i] = real_acos(clipped(p.swing_cosine[i]));
        values[LEANING + i] = real_acos(clipped(p.leaning_cosine[i]));
    }
    leg_rows(&platform->legs, &rods, rotation, platform->length, columns);
    for (int k = 0; k < 3; k++)
        values[POSITION + k] = position[k];
    values[INCLINATION] = real_acos(clipped(inclination_cosine(platform, rotation)));
    values[ROTATION] = rotation_from_home(platform, rotation);
    values[SIGMA] = smallest_singular_value(columns);
}

static real least_cosine(real most)
{
    return most >= REAL_PI ? -BEYOND_ANY_SINE : real_cos(most);
}

struct limit_ranges limit_ranges(const struct platform *platform, const real low[VALUES],
                                 const real high[VALUES])
{
    struct limit_ranges r = {.rotation = {low[ROTATION], high[ROTATION]}, .sigma = low[SIGMA]};
    for (int k = 0; k < 3; k++) {
        r.position[0][k] = low[POSITION + k];
        r.position[1][k] = high[POSITION + k];
    }
    r.inclination_cosine = least_cosine(high[INCLINATION]);
    for (int i = 0; i < LEGS; i++) {
        real home = home_tilt(platform, i);
        real least = home + low[TILT + i], most = home + high[TILT + i];
        r.joint[0][i] = low[JOINT + i];
        r.joint[1][i] = high[JOINT + i];
        r.tilt_sine[0][i] = least <= -REAL_PI / 2 ? -BEYOND_ANY_SINE : real_sin(least);
        r.tilt_sine[1][i] = most >= REAL_PI / 2 ? BEYOND_ANY_SINE : real_sin(most);
        r.swing_cosine[i] = least_cosine(high[SWING + i]);
        r.leaning_cosine[i] = least_cosine(high[LEANING + i]);
    }
    return r;
}

static int keeps_ranges(const struct limit_ranges *r, const real position[3],
                        const real joints[LEGS])
{
    int kept = 1;
    for (int k = 0; k < 3; k++)
        kept &= position[k] >= r->position[0][k] && position[k] <= r->position[1][k];
    for (int i = 0; i < LEGS; i++)
        kept &= joints[i] >= r->joint[0][i] && joints[i] <= r->joint[1][i];
    return kept;
}

static int keeps_orientation(const struct platform *platform, const struct limit_ranges *r,
                             const real rotation[9])
{
    if (inclination_cosine(platform, rotation) < r->inclination_cosine)
        return 0;
    if (r->rotation[0] == -INFINITY && r->rotation[1] == INFINITY)
        return 1;
    real angle = rotation_from_home(platform, rotation);
    return angle >= r->rotation[0] && angle <= r->rotation[1];
}

static int keeps_margin(const struct platform *platform, const struct rods *rods,
                        const real rotation[9], real least)
{
    real columns[6][6];
    leg_rows(&platform->legs, rods, rotation, platform->length, columns);
    return least < LEAST_PIVOT_MARGIN ? smallest_singular_value(columns) >= least
                                      : keeps_singular_value(columns, least);
}

int keeps_limits(const struct platform *platform, const struct limit_ranges *ranges,
                 const real position[3], const real rotation[9], const real joints[LEGS])
{
    if (!keeps_ranges(ranges, position, joints) || !keeps_orientation(platform, ranges, rotation))
        return 0;
    struct rods rods = rods_at(platform, position, rotation, joints);
    struct products p = products_of(platform, &rods, rotation);
    int kept = 1;
    for (int i = 0; i < LEGS; i++)
        kept &= (p.tilt_sine[i] >= ranges->tilt_sine[0][i]) &
                (p.tilt_sine[i] <= ranges->tilt_sine[1][i]) &
                (p.swing_cosine[i] >= ranges->swing_cosine[i]) &
                (p.leaning_cosine[i] >= ranges->leaning_cosine[i]);
    return kept && (ranges->sigma == -INFINITY ||
                    keeps_margin(platform, &rods, rotation, ranges->sigma));
}
