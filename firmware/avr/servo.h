/* Up to eight pulses a period, made by the timers themselves in steps of half a microsecond.
 *
 * Safe state: no pulses, pins low. It is the state after a reset, and of every channel whose bit
 * is not set. What is staged goes out at the next LATCH, all channels at once.
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

#include "machine.h"

/* All pins low, no pulses. */
void servo_begin(void);

/* What the next latch puts out, unless `periods` is no longer the number of latches: then false,
 * and nothing has changed. Counts are kept within the machine's pulse range whatever they are. */
bool servo_stage(const uint16_t counts[JOINT_COUNT], uint8_t is_on, uint8_t periods);

/* The first joint whose count is out of its servo's range; NO_JOINT where none is. */
uint8_t servo_out_of_range(const uint16_t counts[JOINT_COUNT]);

/* The clock's interrupt calls it, once a period. */
void servo_latch(void);
