/* Time since the start, and the pulse period of 20 ms. Owns timer 1, and timer 0 for waking up.
 *
 * Every period has one moment, LATCH, at which no pulse is under way on any channel: then, and
 * only then, servo.c changes the outputs. The board's period begins there.
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

enum {
    PERIOD_COUNTS = 40000, /* of half a microsecond: 50 Hz */
    LATCH = 38000,         /* 1 ms before the next pulses begin */
    PERIOD_MS = 20,
};
#define PERIOD_US 20000UL

void clock_begin(void);

/* How many periods have begun, modulo 256. */
uint8_t clock_periods(void);

/* Microseconds since the first period began; wraps after 71 minutes. */
uint32_t clock_us(void);

/* The same for the moment when the present period began. */
uint32_t clock_period_us(void);

/* Milliseconds since the first period began, at that moment; wraps after 49 days. */
uint32_t clock_period_ms(void);
