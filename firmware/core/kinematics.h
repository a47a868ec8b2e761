/* The inverse kinematics of a crank hexapod.
 *
 * Metres and radians, base frame; crank angles count from each leg's tangent towards up.
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

#include "machine.h"

/* Rz(yaw)·Ry(pitch)·Rx(roll), row by row. */
void kinematics_rotation(const float rpy[3], float rotation[9]);

/* The same, times an orientation. */
void kinematics_turned(const float rpy[3], const float start[9], float rotation[9]);

/* Crank angles of a pose, elbow out; false where a leg does not close. */
bool kinematics_cranks(const CrankHexapod *hexapod, const float position[3],
                       const float rotation[9], float cranks[LEGS]);

/* Above the body's lid, and every crank within its range. */
bool kinematics_is_within_limits(const CrankHexapod *hexapod, const float position[3],
                                 const float cranks[LEGS]);

/* Pulse counts by channel; may be out of the servos' range. */
void kinematics_counts(const CrankHexapod *hexapod, const float cranks[LEGS], float *counts);
