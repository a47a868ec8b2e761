/* Whether a platform that is jogged can still brake: docs/teleop.md, Limits, 3. */
#pragma once
#include "limits.h"

/* The machine as it is jogged: poses are of its pivot in the work frame, SI units. */
struct jogged {
    const struct platform *platform;
    const struct limit_ranges *ranges;
    const struct jog_frame {
        struct frame work; /* in the base frame */
        real pivot[3];     /* platform frame */
    } *frame;
    const struct jog_bounds {
        real tick; /* s */
        real acceleration, angular_acceleration;
        real joint_speed[LEGS], joint_acceleration[LEGS];
    } *bounds;
};

struct jog_state {
    struct frame pose;
    const real *joints, *rates;
};

/* What limits a braking path: the first of these. */
enum obstacle { NOTHING, A_LIMIT, A_SPEED, AN_ACCELERATION };

/* One tick at a twist (6), then braking straight ahead to rest. Of the first tick, or of the first
   that breaks a limit, are pose and joints; `joint` is the one that would be too fast. */
struct braking_path {
    real obstacle, joint;
    struct frame pose;
    real joints[LEGS];
};

struct braking_path braking_path(const struct jogged *machine, const struct jog_state *from,
                                 const real twist[6]);
