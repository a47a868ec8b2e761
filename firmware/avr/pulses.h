/* Up to eight pulses a period, made by the timers themselves in steps of half a microsecond.
 *
 * Safe state: no pulses, pins low. It is the state after a reset, and of every channel whose bit
 * is not set. What is staged goes out at the next LATCH, all channels at once.
 */
#pragma once

/* All pins low, no pulses; after chip_clock_begin. */
void pulses_begin(void);
