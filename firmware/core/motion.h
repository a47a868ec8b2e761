/* From where the joints are to where they shall be: one straight line, no servo above its speed.
 *
 * Safe state: halted, so that the same pulses go out again and again. Counts are half
 * microseconds of pulse, by channel.
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

/* Aims at `counts`, one for each joint; they must be in range. */
void motion_aim(const uint16_t *counts);

/* Stays at what goes out now. */
void motion_halt(void);

/* The first pulse of a channel; where the servo is before it, nobody knows. */
void motion_energise(uint8_t channel, uint16_t count);

/* No more pulses on any channel. */
void motion_release(void);

/* Looks one period further; call once after each period has begun. */
void motion_advance(void);

/* The channel puts out pulses; all channels do. */
bool motion_is_on(uint8_t channel);
bool motion_is_all_on(void);

/* Not yet where it was aimed. */
bool motion_is_slewing(void);

/* What goes out now on a channel that is on. */
uint16_t motion_count(uint8_t channel);
