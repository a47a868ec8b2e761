/* One resolved-rate step of a serial arm as Fadeev and Loginov compute it on a C167: joint rates
 * from the wanted velocity of the wrist centre, the tool's orientation held by three projections.
 *
 * No board of ours moves an arm by it; it is here to be measured.
 */
#pragma once
#include <stdbool.h>

typedef struct {
    float upper; /* shoulder to elbow, L2, in metres */
    float fore;  /* elbow to wrist centre, L3 */
} PaperArm;

/* Moves `joints` (rad) by `dt` seconds towards `velocity` (m/s, base frame); false, and nothing
 * has changed, where one of the two systems of equations is singular. */
bool resolved_rate_step(const PaperArm *arm, float joints[6], const float velocity[3], float dt);
