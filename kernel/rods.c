#include "rods.h"

struct rods rods_of(const real base[3][LEGS], const real end[3][LEGS], const real position[3],
                    const real rotation[9])
{
    struct rods rods;
    for (int i = 0; i < LEGS; i++)
        for (int k = 0; k < 3; k++)
            rods.arm[k][i] = leg_turned(rotation, end, k, i);
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
