/* The battery's voltage, through a divider of two equal resistors on A0. Owns the ADC. */
#pragma once
#include <stdint.h>

void battery_begin(void);

/* Millivolts, as measured last; starts the next conversion. Call once a period. */
uint16_t battery_mv(void);
