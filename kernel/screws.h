/* Legs that change their length by screws, between cardan joints: docs/kinematics.md, 8.4. */
#pragma once
#include "rods.h"

/* The fixed axes of the cardan joints, unit vectors; legs side by side. */
struct screws {
    real lead; /* m a turn, above 0 for a right-hand thread; 0: nothing turns */
    real base_axis[3][LEGS];     /* base frame */
    real platform_axis[3][LEGS]; /* platform frame */
};

/* How much longer joints are than their rods, (8.2). */
void screw_lengths(const struct screws *screws, const struct rods *rods, const real rotation[9],
                   real extra[LEGS]);

/* Adds how fast that grows with a twist, rotations divided by `length`: to leg_columns. */
void add_screw_columns(const struct screws *screws, const struct rods *rods,
                       const real rotation[9], real length, real columns[6][LEGS]);
