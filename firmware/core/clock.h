/* The period of 20 ms, and the time at which the present one began. */
#pragma once
#include <stdint.h>

#include "hardware.h"

enum { PERIOD_MS = 20 };
#define PERIOD_US 20000UL

/* -1 before the first latch: what follows counts modulo 2^32, as after every later wrap. */
static inline uint32_t clock_periods_before(void)
{
    return hardware_periods() - 1;
}

/* Microseconds since the first period began, as hardware_us, when the present one did. */
static inline uint32_t clock_period_us(void)
{
    return (uint32_t)(clock_periods_before() * PERIOD_US);
}

/* The same in milliseconds; wraps after 49 days. */
static inline uint32_t clock_period_ms(void)
{
    return clock_periods_before() * PERIOD_MS;
}
