#include "counts.h"

#include "target.h"

void counts_round(const float *exact, uint16_t *counts)
{
    for (uint8_t i = 0; i < MACHINE.joint_count; i++)
        counts[i] = counts_nearest(exact[i]);
}

uint8_t counts_out_of_range(const uint16_t *counts)
{
    for (uint8_t i = 0; i < MACHINE.joint_count; i++)
        if (counts[i] < MACHINE.lowest_counts[i] || counts[i] > MACHINE.highest_counts[i])
            return i;
    return NO_JOINT;
}

void counts_clamp(uint16_t *counts)
{
    for (uint8_t i = 0; i < MACHINE.joint_count; i++) {
        if (counts[i] < MACHINE.lowest_counts[i])
            counts[i] = MACHINE.lowest_counts[i];
        if (counts[i] > MACHINE.highest_counts[i])
            counts[i] = MACHINE.highest_counts[i];
    }
}
