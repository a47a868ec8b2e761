/* What limits a platform: docs/kinematics.md, 2.2, 5.1 and 6; docs/motion.md, 1.1. */
#pragma once
#include "platform.h"

/* The limited values of a configuration, in m and rad, one after the other. */
enum limited {
    SHORTFALL = 0,      /* the shortest rod that would do less the rod, (2.3) */
    SURPLUS = LEGS,     /* the rod less the longest that would */
    JOINT = 2 * LEGS,   /* the joints themselves */
    TILT = 3 * LEGS,    /* of crank joints */
    SWING = 4 * LEGS,   /* of platform joints */
    LEANING = 5 * LEGS, /* of base joints */
    POSITION = 6 * LEGS, /* x, y, z of the platform */
    HEIGHT = POSITION + 2,
    INCLINATION, /* of its z axis, from where it points at home */
    ROTATION,    /* about its z axis, from home: within half a turn */
    SIGMA,       /* (5.1) */
    VALUES
};

void limited_values(const struct platform *platform, const real position[3],
                    const real rotation[9], const real joints[LEGS], real values[VALUES]);

/* Ranges of the values in the form in which they are compared: angles by sine and cosine. */
struct limit_ranges {
    real joint[2][LEGS]; /* least, most */
    real position[2][3];
    real inclination_cosine; /* the least */
    real rotation[2];
    real tilt_sine[2][LEGS];
    real swing_cosine[LEGS]; /* the least */
    real leaning_cosine[LEGS];
    real sigma; /* the least */
};

struct limit_ranges limit_ranges(const struct platform *platform, const real low[VALUES],
                                 const real high[VALUES]);

/* Whether the joints exist (are finite) and all values are in their ranges; for docs/workspace.md,
   3, a million times a second. */
int keeps_limits(const struct platform *platform, const struct limit_ranges *ranges,
                 const real position[3], const real rotation[9], const real joints[LEGS]);
