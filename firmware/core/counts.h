/* Pulse counts: rounding, and the range of each servo. */
#pragma once
#include <stdint.h>

/* The nearest count, 0 or 65535 beyond them; 0 for what is no number. */
static inline uint16_t counts_nearest(float exact)
{
    if (!(exact > 0))
        return 0;
    if (exact >= UINT16_MAX)
        return UINT16_MAX;
    return (uint16_t)(exact + 0.5f);
}

/* The nearest counts of all joints of the machine. */
void counts_round(const float *exact, uint16_t *counts);

/* The first joint whose count is out of its servo's range; NO_JOINT where none is. */
uint8_t counts_out_of_range(const uint16_t *counts);

/* Each count within its servo's range, whatever it was. */
void counts_clamp(uint16_t *counts);
