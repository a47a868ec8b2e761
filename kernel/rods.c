#include "rods.h"

#include "trigonometry.h"

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

void base_points(const struct crank_legs *legs, const real joints[LEGS], real base[3][LEGS])
{
    real sine[LEGS], cosine[LEGS];
    turned(joints, sine, cosine);
    for (int i = 0; i < LEGS; i++)
        for (int k = 0; k < 3; k++)
            base[k][i] = legs->centre[k][i] + legs->crank[i] * (cosine[i] * legs->tangent[k][i] +
                                                                sine[i] * legs->up[k][i]);
}

struct rods rods_of(real base[3][LEGS], const real end[3][LEGS], const real position[3],
                    const real rotation[9])
{
    struct rods rods;
    for (int i = 0; i < LEGS; i++)
        for (int k = 0; k < 3; k++)
            rods.arm[k][i] = rotation[3 * k] * end[0][i] + rotation[3 * k + 1] * end[1][i] +
                             rotation[3 * k + 2] * end[2][i];
    for (int i = 0; i < LEGS; i++) {
        real x = rods.arm[0][i] + (position[0] - base[0][i]);
        real y = rods.arm[1][i] + (position[1] - base[1][i]);
        real z = rods.arm[2][i] + (position[2] - base[2][i]);
        rods.length[i] = real_sqrt(x * x + y * y + z * z);
        real inverse = 1 / rods.length[i];
        rods.unit[0][i] = x * inverse;
        rods.unit[1][i] = y * inverse;
        rods.unit[2][i] = z * inverse;
    }
    return rods;
}

void leg_columns(const struct rods *rods, real length, real columns[6][LEGS])
{
    real scale = 1 / length;
    for (int k = 0; k < 3; k++) {
        const real *arm1 = rods->arm[(k + 1) % 3], *arm2 = rods->arm[(k + 2) % 3];
        const real *unit1 = rods->unit[(k + 1) % 3], *unit2 = rods->unit[(k + 2) % 3];
        for (int i = 0; i < LEGS; i++) {
            columns[k][i] = rods->unit[k][i];
            columns[3 + k][i] = scale * (arm1[i] * unit2[i] - arm2[i] * unit1[i]);
        }
    }
}

void crank_gains(const struct crank_legs *legs, const real joints[LEGS], real unit[3][LEGS],
                 real gains[LEGS])
{
    real sine[LEGS], cosine[LEGS];
    turned(joints, sine, cosine);
    for (int i = 0; i < LEGS; i++) {
        real along = 0;
        for (int k = 0; k < 3; k++)
            along += unit[k][i] * (cosine[i] * legs->up[k][i] - sine[i] * legs->tangent[k][i]);
        gains[i] = legs->crank[i] * along;
    }
}
