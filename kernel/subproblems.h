/* The trigonometric problems that closed-form inverses are made of: docs/arm-kinematics.md, 3.

   Axes k are unit vectors. `free` is the angle taken where every angle solves the equation. */
#pragma once
#include "vector.h"

/* An angle by its cosine and sine: whole turns do not matter until it is a joint's. */
struct turn {
    real cosine, sine;
};

static inline struct turn turn_by(real angle)
{
    return (struct turn){real_cos(angle), real_sin(angle)};
}

static inline real turn_angle(struct turn turn)
{
    return real_atan2(turn.sine, turn.cosine);
}

static inline struct turn turn_back(struct turn turn)
{
    return (struct turn){turn.cosine, -turn.sine};
}

static inline struct turn turn_on(struct turn a, struct turn b)
{
    return (struct turn){a.cosine * b.cosine - a.sine * b.sine,
                         a.sine * b.cosine + a.cosine * b.sine};
}

/* `vector` turned about k. */
static inline void rotate_about(const real k[3], struct turn turn, const real vector[3],
                                real turned[3])
{
    real across[3], along = (1 - turn.cosine) * dot3(k, vector);
    cross3(k, vector, across);
    for (int i = 0; i < 3; i++)
        turned[i] = along * k[i] + turn.cosine * vector[i] + turn.sine * across[i];
}

/* Turns `vector` about k into the half-plane of `target` (Paden and Kahan's first). */
struct turn facing(const real k[3], const real vector[3], const real target[3], struct turn free);

/* Both turns of `vector` about k with onto . R(k) vector = value; 0 where there are none. */
int projections(const real k[3], const real vector[3], const real onto[3], real value,
                struct turn free, struct turn both[2]);

/* Both turns of `vector` about k to a distance, given by its square, from `point` (Paden and
   Kahan's third); 0 where there are none. */
int distances(const real k[3], const real vector[3], const real point[3], real square,
              struct turn free, struct turn both[2]);

/* Some unit vector at a right angle to k. */
void perpendicular(const real k[3], real across[3]);
