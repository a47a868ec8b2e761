#include "motion.h"

#include <math.h>
#include <string.h>

#include "counts.h"
#include "hardware.h"
#include "target.h"

static STATE float now[MAX_JOINTS];  /* what the last latch put out */
static STATE float next[MAX_JOINTS]; /* what the next one will */
static STATE float target[MAX_JOINTS];
static STATE uint32_t on; /* bit i: channel i */
static STATE uint32_t latches; /* how many `now` accounts for */

static void account_for_latch(void)
{
    uint32_t count = hardware_periods();
    if (count != latches) {
        latches = count;
        memcpy(now, next, sizeof now);
    }
}

/* One period's step from `now` towards `target`, shortened for all channels by one factor. */
static void look_ahead(float *ahead)
{
    float needed = 1.0f;
    for (uint8_t i = 0; i < MACHINE.joint_count; i++)
        needed = fmaxf(needed, fabsf(target[i] - now[i]) / MACHINE.step_counts[i]);
    for (uint8_t i = 0; i < MACHINE.joint_count; i++)
        ahead[i] = needed > 1.0f ? now[i] + (target[i] - now[i]) / needed : target[i];
}

/* False when a latch came in between: then `now` is old, and what follows from it too. */
static bool try_to_stage(void)
{
    float ahead[MAX_JOINTS] = {0};
    uint16_t counts[MAX_JOINTS] = {0};
    look_ahead(ahead);
    counts_round(ahead, counts);
    counts_clamp(counts);
    bool is_staged = hardware_stage_pulses(counts, on, latches);
    if (is_staged)
        memcpy(next, ahead, sizeof next);
    return is_staged;
}

void motion_advance(void)
{
    do
        account_for_latch();
    while (!try_to_stage());
}

void motion_aim(const uint16_t *counts)
{
    for (uint8_t i = 0; i < MACHINE.joint_count; i++)
        target[i] = counts[i];
    motion_advance();
}

void motion_halt(void)
{
    do {
        account_for_latch();
        memcpy(target, now, sizeof target);
    } while (!try_to_stage());
}

void motion_energise(uint8_t channel, uint16_t count)
{
    on |= (uint32_t)1 << channel;
    do {
        account_for_latch();
        now[channel] = target[channel] = count;
    } while (!try_to_stage());
}

void motion_release(void)
{
    on = 0;
    motion_halt();
}

bool motion_is_on(uint8_t channel)
{
    return on >> channel & 1;
}

bool motion_is_all_on(void)
{
    return on == ((uint32_t)1 << MACHINE.joint_count) - 1;
}

bool motion_is_slewing(void)
{
    return memcmp(now, target, sizeof now) != 0;
}

uint16_t motion_count(uint8_t channel)
{
    return counts_nearest(now[channel]);
}
