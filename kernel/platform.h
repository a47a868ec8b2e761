/* A platform on six legs, and its pose for given joints: docs/kinematics.md, 3. */
#pragma once
#include "legs.h"
#include "newton.h"

struct platform {
    struct legs legs;
    real length;            /* L of (5.1), m */
    real home_rod[3][LEGS]; /* unit vectors along the rods at home, base axes */
    real home_gain[LEGS];   /* of the joints at home, (4.1) */
    real home_rotation[9];
};

/* The pose for joints (6), from a start, which becomes the pose. Cold (the rules name a side), a
   leg that is bent the other way than at home is refused, too: 3.3, case 5. */
struct newton_report platform_forward(const struct platform *platform,
                                      const struct newton_rules *rules, const real joints[LEGS],
                                      struct frame *pose);
