/* Time since the start. Owns timer 1, and timer 0 for waking up.
 *
 * Every period has one moment, LATCH, at which no pulse is in progress on any channel: then, and
 * only then, pulses.c changes the outputs. The board's period begins there.
 */
#pragma once

/* Counts of half a microsecond. */
#define PERIOD_COUNTS 40000U /* 50 Hz */
#define LATCH 38000U         /* 1 ms before the next pulses begin */

void chip_clock_begin(void);

/* For the interrupt at LATCH, once the pulses have been changed. */
void chip_clock_begin_period(void);
