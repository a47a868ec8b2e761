#include "board.h"

#include <stdbool.h>
#include <string.h>

#include "clock.h"
#include "command.h"
#include "cycle.h"
#include "hardware.h"
#include "link.h"
#include "motion.h"
#include "safety.h"
#include "start.h"
#include "supply.h"
#include "target.h"

#define HELLO_PERIOD_MS 250
#define HOST_SILENCE_MS 500

static STATE uint8_t cause;
static STATE uint32_t periods_passed;
static STATE bool has_received;
static STATE bool is_host_silent = true;
static STATE uint32_t received_ms;
static STATE uint32_t hello_ms;

static STATE bool has_accepted;
static STATE uint16_t echo; /* sequence of the last frame that was accepted */
static STATE uint32_t accepted_us;
static STATE bool is_echo_old; /* so old that its age no longer fits a STATE */

static STATE uint16_t refused;
static STATE Fault fault_to_report;

static STATE struct {
    uint8_t type; /* 0: none yet */
    uint16_t sequence;
    uint8_t result;
} last_command;

void board_begin(uint8_t reset_cause)
{
    cause = reset_cause;
    cycle_begin();
}

/* Counts; only the newest reason is reported, so that bad frames never fill the line. */
static void refuse(uint8_t code, uint16_t value)
{
    count_one(&refused);
    fault_to_report = (Fault){code, NO_JOINT, value};
}

/* The half-window rule: newer by 1 to 32767, modulo 65536. */
static bool is_new(uint16_t sequence)
{
    return !has_accepted || (int16_t)(uint16_t)(sequence - echo) > 0;
}

static void accept(uint16_t sequence)
{
    echo = sequence;
    accepted_us = hardware_us();
    has_accepted = true;
    is_echo_old = false;
}

static void take_setpoint(const Frame *frame)
{
    uint16_t counts[MAX_JOINTS] = {0};
    uint8_t joints = 0;
    if (frame->length > 2)
        joints = command_counts(frame->payload + 2, (uint8_t)(frame->length - 2), counts);
    if (!joints) {
        refuse(FAULT_MALFORMED, frame->type);
        return;
    }
    has_received = true;
    if (!is_new(frame->sequence)) {
        refuse(FAULT_STALE, frame->sequence);
        return;
    }
    Fault fault = safety_follow(get16(frame->payload), counts, joints);
    if (fault.code != FAULT_NONE) {
        count_one(&refused);
        fault_to_report = fault;
        return;
    }
    accept(frame->sequence);
    last_command.type = 0; /* its number may come round again: no host repeats it after this */
}

/* The result of a command: of one that is repeated, what it was the first time. */
static uint8_t result_of(const Frame *frame)
{
    if (last_command.type == frame->type && last_command.sequence == frame->sequence)
        return last_command.result;
    if (is_new(frame->sequence)) {
        uint8_t result = command_obey(frame);
        accept(frame->sequence);
        last_command.type = frame->type;
        last_command.sequence = frame->sequence;
        last_command.result = result;
        return result;
    }
    if (frame->type == TYPE_STOP)
        return safety_stop(); /* a late STOP can only err on the safe side */
    return RESULT_STALE;
}

static void take_command(const Frame *frame)
{
    if (!command_is_well_formed(frame)) {
        refuse(FAULT_MALFORMED, frame->type);
        return;
    }
    has_received = true;
    uint8_t result = result_of(frame);
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
        refuse(FAULT_UNKNOWN_TYPE, frame->type);
}

static void send_hello(void)
{
    uint8_t payload[7] = {MACHINE.protocol_version, cause, MACHINE.joint_count};
    put32(payload + 3, clock_period_ms());
    link_send_delimiter(); /* ends what the boot loader may have sent */
    link_send(TYPE_HELLO, payload, sizeof payload);
}

static void send_fault(void)
{
    uint8_t payload[4] = {fault_to_report.code, fault_to_report.joint};
    put16(payload + 2, fault_to_report.value);
    link_send(TYPE_FAULT, payload, sizeof payload);
    fault_to_report.code = FAULT_NONE;
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

/* Two bits a joint: two bytes for up to eight. */
static uint8_t known_bytes(void)
{
    return (uint8_t)(MACHINE.joint_count > 8 ? (MACHINE.joint_count + 3) / 4 : 2);
}

/* What is known of each joint, two bits each, and its count: measured, else as commanded. */
static uint8_t *put_joints(uint8_t *at)
{
    uint16_t measured[MAX_JOINTS] = {0};
    bool is_measured = hardware_read_positions(measured);
    uint8_t *known = at;
    at += known_bytes();
    memset(known, 0, known_bytes());
    for (uint8_t i = 0; i < MACHINE.joint_count; i++)
        if (is_measured || motion_is_on(i))
            known[i / 4] = (uint8_t)(known[i / 4] | (is_measured ? KNOWN_MEASURED : KNOWN_COMMANDED)
                                                        << 2 * (i % 4));
    for (uint8_t i = 0; i < MACHINE.joint_count; i++) {
        uint16_t commanded = motion_is_on(i) ? motion_count(i) : 0;
        at = put16(at, is_measured ? measured[i] : commanded);
    }
    return at;
}

static void send_state(void)
{
    uint8_t payload[15 + (MAX_JOINTS + 3) / 4 + 2 * MAX_JOINTS];
    _Static_assert(sizeof payload <= MAX_PAYLOAD, "a STATE fits into a frame");
    uint8_t *at = put16(payload, echo);
    at = put16(at, echo_age_us());
    *at++ = safety_mode();
    *at++ = safety_flags();
    *at++ = safety_fault();
    at = put16(at, supply_mv());
    at = put16(at, link_bad_frames());
    at = put16(at, link_overruns());
    at = put16(at, refused);
    at = put_joints(at);
    link_send(TYPE_STATE, payload, (uint8_t)(at - payload));
}

/* Both times are kept near the present one: a difference of weeks would have lost its sign. */
static bool is_hello_due(uint32_t now_ms)
{
    is_host_silent = is_host_silent || now_ms - received_ms >= HOST_SILENCE_MS;
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
        fault_to_report = begun;
    cycle_keep();
    if (is_hello_due(clock_period_ms()))
        send_hello();
    if (fault_to_report.code != FAULT_NONE)
        send_fault();
    send_state();
}

void board_step(void)
{
    Frame frame;
    if (link_receive(&frame))
        take(&frame);
    if (has_received) {
        received_ms = clock_period_ms();
        has_received = is_host_silent = false;
    }
    safety_watch();
    start_watch();
    if (periods_passed != hardware_periods()) {
        periods_passed = hardware_periods();
        hardware_feed_watchdog(); /* only while both the loop and the pulses' clock are alive */
        pass_period();
    }
}
