/* The inverse of Fadeev and Loginov's arm by its other two ways: from the forward equations, and from
 * triangles. One branch: elbow bent forwards (q3 > 0), wrist q5 > 0.
 *
 * No board of ours moves an arm by it; it is here to be measured. No hardware.
 */
#pragma once
#include <stdbool.h>

#include "resolved_rate.h"

/* centre: of the wrist, in metres from the shoulder; rotation: of the tool, row by row. Writes joints
 * (rad); false, and nothing is written, where the centre is out of reach. */
bool arm_inverse_algebraic(const PaperArm *arm, const float centre[3], const float rotation[9],
                           float joints[6]);
bool arm_inverse_geometric(const PaperArm *arm, const float centre[3], const float rotation[9],
                           float joints[6]);
