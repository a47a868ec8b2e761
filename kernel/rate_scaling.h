/* How much of requested joint rates the joints can drive: docs/arm-kinematics.md, 8. */
#pragma once
#include "branches.h"

/* In rad, rad/s and rad/s^2; a jog ends at its ranges' stops. */
struct joint_limits {
    struct ranges ranges;
    real speed[JOINTS], acceleration[JOINTS];
};

enum { HELD_BY_NONE, HELD_BY_SPEED, HELD_BY_ACCELERATION, HELD_BY_STOP };

struct rate_scale {
    real part;
    real limit; /* what set it */
    real joint; /* from 1 */
};

/* The part of `rates` that every joint can drive, and brake from before its stop: 8.1 and 8.4.
   `bend` is how they change while the tool goes straight on with all of them, `slowing` the part of
   itself (1/s) by which they may fall before a stop. */
struct rate_scale scale_rates(const struct joint_limits *limits, const real joints[JOINTS],
                              const real rates[JOINTS], const real bend[JOINTS], real dt,
                              real slowing);

/* Rates that the accelerations allow after `before`, on the way to part x rates, and joints a tick
   later. Stops outrank accelerations: a step that would pass one is shortened as a whole. 8.4. */
void follow_rates(const struct joint_limits *limits, real part, const real rates[JOINTS], real dt,
                  real before[JOINTS], real joints[JOINTS]);
