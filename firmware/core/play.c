#include "play.h"

#include <math.h>
#include <string.h>

#include "cycle.h"
#include "motion.h"
#include "protocol.h"
#include "servo.h"
#include "table.h"

#define PERIOD_S 0.02f
#define RAMP_S 1.0f     /* from standing to full speed, and back */
#define APPROACH_S 0.5f /* from where the joints are to the program's first counts */
#define ROUNDING 1      /* counts by which a way that is just slow enough may seem too fast */
#define NEAR_COUNTS 120 /* about 6 degrees: how far that way may be */

static const float STEP[JOINT_COUNT] = STEP_COUNTS;

static uint8_t program;
static bool is_loop;
static bool is_finishing;
static bool is_checked;
static float duration;
static float time;     /* in the program, s */
static float ramp;     /* 0 standing, 1 at full speed */
static float approach; /* 0 where the joints were, 1 at the program's first counts */
static float from[JOINT_COUNT];
static float before[JOINT_COUNT]; /* the sample before, while it is checked and while it plays */

static bool is_cycle(void)
{
    return program == PROGRAM_CYCLE;
}

/* 3u^2 - 2u^3: from 0 to 1 without a jerk in speed at either end. */
static float smooth(float u)
{
    return u * u * (3 - 2 * u);
}

static void rounded(const float exact[JOINT_COUNT], uint16_t counts[JOINT_COUNT])
{
    for (uint8_t i = 0; i < JOINT_COUNT; i++)
        counts[i] = exact[i] > 0 ? (uint16_t)(exact[i] + 0.5f) : 0;
}

uint8_t play_has(uint8_t wanted)
{
    bool is_there = false;
    if (wanted == PROGRAM_CYCLE)
        is_there = cycle_is_there();
    else if (wanted == PROGRAM_TABLE || wanted == PROGRAM_FLASH_TABLE)
        is_there = table_is_there(wanted);
    return is_there ? RESULT_OK : RESULT_NO_PROGRAM;
}

static bool first_counts(uint8_t wanted, float counts[JOINT_COUNT])
{
    if (wanted == PROGRAM_CYCLE)
        return cycle_at(0, 0, counts); /* home: the way from it grows with the ramp */
    table_at(wanted, 0, counts);
    return true;
}

bool play_start_counts(uint8_t wanted, uint16_t counts[JOINT_COUNT])
{
    float exact[JOINT_COUNT];
    if (!first_counts(wanted, exact))
        return false;
    rounded(exact, counts);
    return servo_out_of_range(counts) == NO_JOINT;
}

uint8_t play_begin(uint8_t wanted, bool wants_loop)
{
    uint16_t start[JOINT_COUNT];
    if (play_has(wanted) != RESULT_OK)
        return RESULT_NO_PROGRAM;
    if (!play_start_counts(wanted, start))
        return RESULT_OUT_OF_RANGE;
    for (uint8_t i = 0; i < JOINT_COUNT; i++) {
        from[i] = motion_count(i);
        if (fabsf(from[i] - start[i]) > NEAR_COUNTS)
            return RESULT_NOT_AT_START;
    }
    if (wanted != PROGRAM_CYCLE && !table_is_slow_enough(wanted, wants_loop))
        return RESULT_TOO_FAST;
    duration = wanted == PROGRAM_CYCLE ? cycle_duration() : table_duration(wanted, wants_loop);
    if (duration <= 0)
        return RESULT_OUT_OF_RANGE;
    program = wanted;
    is_loop = wants_loop;
    is_finishing = false;
    is_checked = wanted != PROGRAM_CYCLE; /* a table's rows were checked as they came */
    time = ramp = approach = 0;
    return RESULT_OK;
}

void play_finish(void)
{
    is_finishing = true;
}

/* A servo could not do the way from the sample before within a period. */
static bool is_too_fast(const float exact[JOINT_COUNT], float tolerance)
{
    for (uint8_t i = 0; i < JOINT_COUNT; i++)
        if (fabsf(exact[i] - before[i]) > STEP[i] + tolerance)
            return true;
    return false;
}

/* One sample of the cycle a period: reach, pulse range, and speed from the sample before. */
static uint8_t check_step(void)
{
    float exact[JOINT_COUNT];
    uint16_t counts[JOINT_COUNT];
    if (!cycle_at(time, 1, exact))
        return PLAY_UNREACHABLE;
    rounded(exact, counts);
    if (servo_out_of_range(counts) != NO_JOINT)
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
static uint8_t aim(const float exact[JOINT_COUNT], uint8_t step)
{
    uint16_t counts[JOINT_COUNT];
    rounded(exact, counts);
    if (servo_out_of_range(counts) != NO_JOINT)
        return PLAY_UNREACHABLE;
    if (is_too_fast(exact, ROUNDING))
        return PLAY_TOO_FAST;
    memcpy(before, exact, sizeof before);
    motion_aim(counts);
    return step;
}

static uint8_t approach_step(void)
{
    float start[JOINT_COUNT];
    if (is_finishing)
        return PLAY_DONE;
    approach = fminf(approach + PERIOD_S / APPROACH_S, 1);
    if (!first_counts(program, start))
        return PLAY_UNREACHABLE;
    for (uint8_t i = 0; i < JOINT_COUNT; i++)
        start[i] = from[i] + smooth(approach) * (start[i] - from[i]);
    return aim(start, PLAY_MOVING);
}

static void change_ramp(void)
{
    ramp += (is_finishing ? -1 : 1) * PERIOD_S / RAMP_S;
    ramp = fmaxf(fminf(ramp, 1), 0);
}

/* A cycle grows out of home and shrinks back into it, at its own pace. */
static uint8_t cycle_step(void)
{
    float exact[JOINT_COUNT];
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

/* A table keeps its way: its pace grows from nothing, and shrinks to nothing. */
static uint8_t table_step(void)
{
    float exact[JOINT_COUNT];
    change_ramp();
    float pace = smooth(ramp);
    if (!is_loop) /* slow enough to stand at the last row */
        pace = fminf(pace, sqrtf(2 * fmaxf(duration - time, 0) / RAMP_S));
    time += pace * PERIOD_S;
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
    return (uint16_t)(1000 * time);
}
