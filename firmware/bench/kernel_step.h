/* The damped step of any arm with six joints, by the kernel's own source in float: docs/arm-kinematics.md,
 * 1 and 6.2. No board of ours moves an arm by it; it is here to be measured.
 */
#pragma once
#define KERNEL_FLOAT
#include "../../kernel/chain.h"

/* Moves `joints` (rad) by `dt` seconds towards `twist` of the tool (m/s, rad/s, base axes), metres
 * divided by `length` beside radians. */
void kernel_step(const struct chain *chain, float length, float joints[JOINTS],
                 const float twist[6], float dt);
