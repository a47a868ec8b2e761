#include "motion.h"

#include <math.h>
#include <string.h>

#include "clock.h"
#include "servo.h"

enum { ALL_ON = (1 << JOINT_COUNT) - 1 };

/* What each servo moves in one period at its rated speed, in counts. */
static const float STEP[JOINT_COUNT] = STEP_COUNTS;

static float now[JOINT_COUNT];  /* what the last latch put out */
static float next[JOINT_COUNT]; /* what the next one will */
static float target[JOINT_COUNT];
static uint8_t is_on;
static uint8_t latches; /* how many `now` knows of */

static void account_for_latch(void)
{
    uint8_t count = clock_periods();
    if (count != latches) {
        latches = count;
        memcpy(now, next, sizeof now);
    }
}

static uint16_t rounded(float count)
{
    return (uint16_t)(count + 0.5f);
}

/* One period's way from `now` towards `target`, shortened for all channels by one factor. */
static void look_ahead(float ahead[JOINT_COUNT])
{
    float needed = 1.0f;
    for (uint8_t i = 0; i < JOINT_COUNT; i++)
        needed = fmaxf(needed, fabsf(target[i] - now[i]) / STEP[i]);
    for (uint8_t i = 0; i < JOINT_COUNT; i++)
        ahead[i] = needed > 1.0f ? now[i] + (target[i] - now[i]) / needed : target[i];
}

/* False when a latch came in between: then `now` is old, and what follows from it too. */
static bool try_to_stage(void)
{
    float ahead[JOINT_COUNT];
    uint16_t counts[JOINT_COUNT];
    look_ahead(ahead);
    for (uint8_t i = 0; i < JOINT_COUNT; i++)
        counts[i] = rounded(ahead[i]);
    bool is_staged = servo_stage(counts, is_on, latches);
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

void motion_aim(const uint16_t counts[JOINT_COUNT])
{
    for (uint8_t i = 0; i < JOINT_COUNT; i++)
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
    is_on |= (uint8_t)(1 << channel);
    do {
        account_for_latch();
        now[channel] = target[channel] = count;
    } while (!try_to_stage());
}

void motion_release(void)
{
    is_on = 0;
    motion_halt();
}

uint8_t motion_on(void)
{
    return is_on;
}

bool motion_is_all_on(void)
{
    return is_on == ALL_ON;
}

bool motion_is_slewing(void)
{
    return memcmp(now, target, sizeof now) != 0;
}

uint16_t motion_count(uint8_t channel)
{
    return rounded(now[channel]);
}
