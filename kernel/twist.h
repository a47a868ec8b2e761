/* From one pose to another: docs/arm-kinematics.md, 6. */
#ifndef KERNEL_TWIST_H
#define KERNEL_TWIST_H

#include "chain.h"

/* The twist (v, w), in base axes, that takes `here` to `target` in a unit of time: the way of the
   origin, and the rotation vector of R_target R_here', at most half a turn. */
void twist_between(const struct frame *here, const struct frame *target, real twist[6]);

#endif
