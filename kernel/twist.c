#include "twist.h"

#include "vector.h"

/* The axis of a turn by almost half a turn: of R + R' = 2 cos I + 2 (1 - cos) w w' the longest
   column. It points as `sines`, 2 sin w, where that has a direction left. */
static void axis_of_half_turn(const real r[9], real cosine, const real sines[3], real axis[3])
{
    int longest = r[4] > r[0];
    if (r[8] > r[4 * longest])
        longest = 2;
    for (int i = 0; i < 3; i++)
        axis[i] = (r[3 * i + longest] + r[3 * longest + i]) / 2 - (i == longest) * cosine;
    real size = real_sqrt(dot3(axis, axis));
    if (dot3(axis, sines) < 0)
        size = -size;
    for (int i = 0; i < 3; i++)
        axis[i] /= size;
}

/* The rotation vector of a rotation matrix. */
static void rotation_vector(const real r[9], real vector[3])
{
    real sines[3] = {r[7] - r[5], r[2] - r[6], r[3] - r[1]};
    real sine = real_sqrt(dot3(sines, sines)) / 2, cosine = (r[0] + r[4] + r[8] - 1) / 2;
    real angle = real_atan2(sine, cosine);
    if (cosine < REAL(-0.9))
        axis_of_half_turn(r, cosine, sines, vector);
    for (int i = 0; i < 3; i++)
        if (cosine < REAL(-0.9))
            vector[i] *= angle;
        else
            vector[i] = sines[i] * (sine < REAL(1e-6) ? REAL(0.5) : angle / sine / 2);
}

void twist_between(const struct frame *here, const struct frame *target, real twist[6])
{
    real turn[9];
    for (int i = 0; i < 3; i++) {
        twist[i] = target->position[i] - here->position[i];
        for (int k = 0; k < 3; k++)
            turn[3 * i + k] = dot3(target->rotation + 3 * i, here->rotation + 3 * k);
    }
    rotation_vector(turn, twist + 3);
}
