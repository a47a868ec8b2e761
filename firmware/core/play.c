#include "play.h"

#include <math.h>
#include <string.h>

#include "counts.h"
#include "cycle.h"
#include "motion.h"
#include "protocol.h"
#include "table.h"
#include "target.h"

#define PERIOD_S 0.02f
#define RAMP_S 1.0f     /* from standing to full speed, and back */
#define APPROACH_S 0.5f /* from where the joints are to the program's first counts */
#define ROUNDING 1      /* counts by which a step that is just slow enough may seem too fast */
#define NEAR_COUNTS 120 /* about 6 degrees: how far the joints may be from the start */

static STATE uint8_t program;
static STATE bool is_loop;
static STATE bool is_finishing;
static STATE bool is_checked;
static STATE float duration;
static STATE float time;     /* in the program, s */
static STATE float ramp;     /* 0 standing, 1 at full speed */
static STATE float approach; /* 0 where the joints were, 1 at the program's first counts */
static STATE float from[MAX_JOINTS];
static STATE float before[MAX_JOINTS]; /* the sample before, while it is checked or played */

static bool is_cycle(void)
{
    return program == PROGRAM_CYCLE;
}

/* 3u^2 - 2u^3: from 0 to 1 without a jerk in speed at either end. */
static float smooth(float u)
{
    return u * u * (3 - 2 * u);
}

uint8_t play_has(uint8_t requested)
{
    bool is_there = false;
    if (requested == PROGRAM_CYCLE)
        is_there = cycle_is_there();
    else if (requested == PROGRAM_TABLE || requested == PROGRAM_FLASH_TABLE)
        is_there = table_is_there(requested);
    return is_there ? RESULT_OK : RESULT_NO_PROGRAM;
}

static bool first_counts(uint8_t requested, float *counts)
{
    if (requested == PROGRAM_CYCLE)
        return cycle_at(0, 0, counts); /* home: the amplitudes grow with the ramp */
    table_at(requested, 0, counts);
    return true;
}

bool play_start_counts(uint8_t requested, uint16_t *counts)
{
    float exact[MAX_JOINTS] = {0};
    if (!first_counts(requested, exact))
        return false;
    counts_round(exact, counts);
    return counts_out_of_range(counts) == NO_JOINT;
}

uint8_t play_begin(uint8_t requested, bool in_loop)
{
    uint16_t start[MAX_JOINTS] = {0};
    if (play_has(requested) != RESULT_OK)
        return RESULT_NO_PROGRAM;
    if (!play_start_counts(requested, start))
        return RESULT_OUT_OF_RANGE;
    for (uint8_t i = 0; i < MACHINE.joint_count; i++) {
        from[i] = motion_count(i);
        if (fabsf(from[i] - start[i]) > NEAR_COUNTS)
            return RESULT_NOT_AT_START;
    }
    if (requested != PROGRAM_CYCLE && !table_is_slow_enough(requested, in_loop))
        return RESULT_TOO_FAST;
    duration = requested == PROGRAM_CYCLE ? cycle_duration() : table_duration(requested, in_loop);
    if (duration <= 0)
        return RESULT_OUT_OF_RANGE;
    program = requested;
    is_loop = in_loop;
    is_finishing = false;
    is_checked = requested != PROGRAM_CYCLE; /* a table's rows were checked as they came */
    time = ramp = approach = 0;
    return RESULT_OK;
}

void play_finish(void)
{
    is_finishing = true;
}

/* A servo could not follow from the sample before within a period. */
static bool is_too_fast(const float *exact, float tolerance)
{
    for (uint8_t i = 0; i < MACHINE.joint_count; i++)
        if (fabsf(exact[i] - before[i]) > MACHINE.step_counts[i] + tolerance)
            return true;
    return false;
}

/* One sample of the cycle a period: reach, pulse range, and speed from the sample before. */
static uint8_t check_step(void)
{
    float exact[MAX_JOINTS] = {0};
    uint16_t counts[MAX_JOINTS] = {0};
    if (!cycle_at(time, 1, exact))
        return PLAY_UNREACHABLE;
    counts_round(exact, counts);
    if (counts_out_of_range(counts) != NO_JOINT)
        return PLAY_UNREACHABLE;
    if (time > 0 && is_too_fast(exact, 0))
        return PLAY_TOO_FAST;
    memcpy(before, exact, sizeof before);
    time += PERIOD_S;
    if (time > duration + PERIOD_S) {
        is_checked = true;
        time = 0;
    }
    return PLAY_CHECKING;
}

/* Looked at again: a fast sine passes through other samples each time than those it was checked
 * by. `step` is what comes of it where it can be followed. */
static uint8_t aim(const float *exact, uint8_t step)
{
    uint16_t counts[MAX_JOINTS] = {0};
    counts_round(exact, counts);
    if (counts_out_of_range(counts) != NO_JOINT)
        return PLAY_UNREACHABLE;
    if (is_too_fast(exact, ROUNDING))
        return PLAY_TOO_FAST;
    memcpy(before, exact, sizeof before);
    motion_aim(counts);
    return step;
}

static uint8_t approach_step(void)
{
    float start[MAX_JOINTS] = {0};
    if (is_finishing)
        return PLAY_DONE;
    approach = fminf(approach + PERIOD_S / APPROACH_S, 1);
    if (!first_counts(program, start))
        return PLAY_UNREACHABLE;
    for (uint8_t i = 0; i < MACHINE.joint_count; i++)
        start[i] = from[i] + smooth(approach) * (start[i] - from[i]);
    return aim(start, PLAY_MOVING);
}

static void change_ramp(void)
{
    ramp += (is_finishing ? -1 : 1) * PERIOD_S / RAMP_S;
    ramp = fmaxf(fminf(ramp, 1), 0);
}

/* A cycle grows out of home and shrinks back into it, at its own rate. */
static uint8_t cycle_step(void)
{
    float exact[MAX_JOINTS] = {0};
    time += PERIOD_S;
    if (time >= duration) {
        time -= duration;
        is_finishing = is_finishing || !is_loop;
    }
    change_ramp();
    if (!cycle_at(time, smooth(ramp), exact))
        return PLAY_UNREACHABLE;
    return aim(exact, is_finishing && ramp <= 0 ? PLAY_DONE : PLAY_MOVING);
}

/* A table keeps its path: its rate grows from nothing, and shrinks to nothing. */
static uint8_t table_step(void)
{
    float exact[MAX_JOINTS] = {0};
    change_ramp();
    float rate = smooth(ramp);
    if (!is_loop) /* slow enough to stand at the last row */
        rate = fminf(rate, sqrtf(2 * fmaxf(duration - time, 0) / RAMP_S));
    time += rate * PERIOD_S;
    bool is_over = is_finishing && ramp <= 0;
    if (is_loop && time >= duration)
        time -= duration;
    if (!is_loop && duration - time < 0.5f * PERIOD_S * PERIOD_S / RAMP_S) {
        time = duration;
        is_over = true;
    }
    table_at(program, time, exact);
    return aim(exact, is_over ? PLAY_DONE : PLAY_MOVING);
}

uint8_t play_step(void)
{
    if (!is_checked)
        return is_finishing ? PLAY_DONE : check_step();
    if (approach == 0)
        memcpy(before, from, sizeof before);
    if (approach < 1)
        return approach_step();
    return is_cycle() ? cycle_step() : table_step();
}

uint16_t play_trouble_ms(void)
{
    if (time >= UINT16_MAX / 1000.0f)
        return UINT16_MAX;
    return (uint16_t)(1000 * time);
}
