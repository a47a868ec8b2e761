/* Periodic motion about home: one sine on each axis, as in the experiment of Prokopovich 2019.
 *
 * The board solves the inverse kinematics itself. The cycle outlives a power-down: the memory keeps
 * it twice, and a new one takes the place of the older copy, so that a reset meanwhile leaves the one
 * before. Safe state: no cycle (all amplitudes 0), also where both copies are damaged.
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

/* Remembers the cycle that was set before the power went. */
void cycle_begin(void);

/* Keeps one byte of a cycle that has changed; call once a period. */
void cycle_keep(void);

/* Axis 0 to 5 (x, y, z, roll, pitch, yaw): amplitude in m or rad, frequency in thousandths of a
 * hertz, phase in rad. An enum Result. */
uint8_t cycle_set(uint8_t axis, float amplitude, uint16_t frequency_mhz, float phase);

/* At least one axis moves. */
bool cycle_is_there(void);

/* Seconds until all axes begin again; 0 where that takes more than a minute. */
float cycle_duration(void);

/* The counts at `time`, the amplitudes multiplied by `part`; false where it is out of reach. */
bool cycle_at(float time, float part, float *counts);
