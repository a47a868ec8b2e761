/* From the lengths of six rods to the platform's pose: docs/kinematics.md, 3. */
#pragma once
#include "screws.h"
#include "vector.h"

/* Rods between base points (base frame) and platform joints (platform frame). */
struct newton_problem {
    real base[3][LEGS];
    real end[3][LEGS];
    real length[LEGS];
    const struct screws *screws; /* of joints given for lengths; null: none */
};

/* What is trusted of what is found: 3.3. */
struct newton_rules {
    real length; /* L of (5.1), in metres: makes rotations lengths in sigma */
    real side;   /* the sign that det J must have; NaN: the one that it has at the start */
    real margin; /* the least sigma */
};

/* How it ended; BENT is for platform.h to say. */
enum newton_end { FOUND, SINGULAR, NOT_FOUND, BELOW_MARGIN, BEYOND, BENT };

struct newton_report {
    real end;
    real iterations;
    real miss;     /* the rods' errors in m, as one vector */
    real residual; /* the largest of them */
    real sigma;    /* the smallest singular value, (5.1) */
};

/* Newton's method on SE(3), (3.2), from the pose that it is given, which becomes the last one. */
struct newton_report newton(const struct newton_problem *problem, const struct newton_rules *rules,
                            struct frame *pose);
