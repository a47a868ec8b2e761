#include "board.h"

#include <avr/wdt.h>
#include <stdbool.h>

#include "clock.h"
#include "command.h"
#include "cycle.h"
#include "link.h"
#include "machine.h"
#include "motion.h"
#include "safety.h"
#include "supply.h"

#define HELLO_PERIOD_MS 250
#define HOST_SILENCE_MS 500

static uint8_t cause;
static uint8_t periods;
static bool has_heard;
static bool is_host_silent = true;
static uint32_t heard_ms;
static uint32_t hello_ms;

static bool has_accepted;
static uint16_t echo; /* sequence of the last frame that was accepted */
static uint32_t accepted_us;
static bool is_echo_old; /* so old that its age no longer fits a STATE */

static uint16_t refused;
static Fault fault_to_say;

static struct {
    uint8_t type; /* 0: none yet */
    uint16_t sequence;
    uint8_t result;
} last_command;

void board_begin(uint8_t reset_cause)
{
    cause = reset_cause;
}

/* Counts; only the newest reason is said, so that bad frames never fill the line. */
static void refuse(Fault fault)
{
    count_one(&refused);
    fault_to_say = fault;
}

/* The half-window rule: newer by 1 to 32767, modulo 65536. */
static bool is_new(uint16_t sequence)
{
    return !has_accepted || (int16_t)(sequence - echo) > 0;
}

static void accept(uint16_t sequence)
{
    echo = sequence;
    accepted_us = clock_us();
    has_accepted = true;
    is_echo_old = false;
}

static void take_setpoint(const Frame *frame)
{
    uint16_t counts[MAX_JOINTS];
    uint8_t joints = 0;
    if (frame->length > 2)
        joints = command_counts(frame->payload + 2, frame->length - 2, counts);
    if (!joints) {
        refuse((Fault){FAULT_MALFORMED, NO_JOINT, frame->type});
        return;
    }
    has_heard = true;
    if (!is_new(frame->sequence)) {
        refuse((Fault){FAULT_STALE, NO_JOINT, frame->sequence});
        return;
    }
    Fault fault = safety_follow(get16(frame->payload), counts, joints);
    if (fault.code != FAULT_NONE) {
        refuse(fault);
        return;
    }
    accept(frame->sequence);
    last_command.type = 0; /* its number may come round again: no host repeats it after this */
}

static void take_command(const Frame *frame)
{
    if (!command_is_well_formed(frame)) {
        refuse((Fault){FAULT_MALFORMED, NO_JOINT, frame->type});
        return;
    }
    has_heard = true;
    uint8_t result;
    if (last_command.type == frame->type && last_command.sequence == frame->sequence) {
        result = last_command.result;
    } else if (is_new(frame->sequence)) {
        result = command_obey(frame);
        accept(frame->sequence);
        last_command.type = frame->type;
        last_command.sequence = frame->sequence;
        last_command.result = result;
    } else if (frame->type == TYPE_STOP) {
        result = safety_stop(); /* a late STOP can only err on the safe side */
    } else {
        result = RESULT_STALE;
    }
    if (result != RESULT_OK)
        count_one(&refused);
    uint8_t payload[3];
    *put16(payload, frame->sequence) = result;
    link_send(TYPE_ACK, payload, sizeof payload);
}

static void take(const Frame *frame)
{
    if (frame->type == TYPE_SETPOINT)
        take_setpoint(frame);
    else if (frame->type >= TYPE_ARM && frame->type <= TYPE_FINISH)
        take_command(frame);
    else
        refuse((Fault){FAULT_UNKNOWN_TYPE, NO_JOINT, frame->type});
}

static void say_hello(void)
{
    uint8_t payload[7] = {PROTOCOL_VERSION, cause, JOINT_COUNT};
    put32(payload + 3, clock_period_ms());
    link_send_delimiter(); /* ends what the boot loader may have said */
    link_send(TYPE_HELLO, payload, sizeof payload);
}

static void say_fault(void)
{
    uint8_t payload[4] = {fault_to_say.code, fault_to_say.joint};
    put16(payload + 2, fault_to_say.value);
    link_send(TYPE_FAULT, payload, sizeof payload);
    fault_to_say.code = FAULT_NONE;
}

static uint16_t echo_age_us(void)
{
    int32_t age = (int32_t)(clock_period_us() - accepted_us);
    if (age > UINT16_MAX)
        is_echo_old = true;
    if (!has_accepted || is_echo_old)
        return UINT16_MAX;
    return age < 0 ? 0 : (uint16_t)age;
}

static void say_state(void)
{
    uint8_t payload[17 + 2 * JOINT_COUNT];
    uint16_t known = 0;
    uint8_t *at = put16(payload, echo);
    at = put16(at, echo_age_us());
    *at++ = safety_mode();
    *at++ = safety_flags();
    *at++ = safety_fault();
    at = put16(at, supply_mv());
    at = put16(at, link_bad_frames());
    at = put16(at, link_overruns());
    at = put16(at, refused);
    for (uint8_t i = 0; i < JOINT_COUNT; i++)
        if (motion_on() >> i & 1)
            known |= (uint16_t)(KNOWN_COMMANDED << 2 * i);
    at = put16(at, known);
    for (uint8_t i = 0; i < JOINT_COUNT; i++)
        at = put16(at, motion_on() >> i & 1 ? motion_count(i) : 0);
    link_send(TYPE_STATE, payload, sizeof payload);
}

/* Both times are kept near the present one: a difference of weeks would have lost its sign. */
static bool is_hello_due(uint32_t now_ms)
{
    is_host_silent = is_host_silent || now_ms - heard_ms >= HOST_SILENCE_MS;
    if (!is_host_silent) {
        hello_ms = now_ms;
        return false;
    }
    bool is_due = (int32_t)(now_ms - hello_ms) >= 0;
    if (is_due)
        hello_ms = now_ms + HELLO_PERIOD_MS;
    return is_due;
}

static void pass_period(void)
{
    motion_advance();
    Fault begun = safety_pass_period();
    if (begun.code != FAULT_NONE)
        fault_to_say = begun;
    cycle_keep();
    if (is_hello_due(clock_period_ms()))
        say_hello();
    if (fault_to_say.code != FAULT_NONE)
        say_fault();
    say_state();
}

void board_step(void)
{
    Frame frame;
    if (link_receive(&frame))
        take(&frame);
    if (has_heard) {
        heard_ms = clock_period_ms();
        has_heard = is_host_silent = false;
    }
    safety_watch();
    if (periods != clock_periods()) {
        periods = clock_periods();
        wdt_reset(); /* only while both the loop and the pulses' clock are alive */
        pass_period();
    }
}
