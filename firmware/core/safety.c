#include "safety.h"

#include "arming.h"
#include "buttons.h"
#include "counts.h"
#include "deadline.h"
#include "motion.h"
#include "play.h"
#include "supply.h"
#include "target.h"

static const Fault NO_FAULT = {FAULT_NONE, NO_JOINT, 0};

static STATE uint8_t mode = MODE_DISARMED;
static STATE uint8_t fault;
static STATE bool is_deadline_passed;
static STATE bool is_hosts;   /* a host was the last to command it, and its deadline has not passed */
static STATE bool is_cleared; /* by CLEAR, and no host has armed or driven it since */
static STATE uint8_t program_after_arming; /* 0: none; the start button asked for it */

static void expect_setpoint_within(uint16_t ms)
{
    deadline_set(ms);
    is_deadline_passed = false;
}

/* Armed, with no setpoint yet: good for as long as the longest deadline. */
static void wait_armed(void)
{
    mode = MODE_ARMED;
    expect_setpoint_within(MAX_DEADLINE_MS);
}

static void hold(uint8_t new_mode)
{
    motion_halt();
    deadline_forget();
    is_deadline_passed = is_cleared = false;
    program_after_arming = 0;
    if (new_mode == MODE_DISARMED || new_mode == MODE_HOLDING)
        is_hosts = false;
    mode = new_mode;
    if (new_mode == MODE_ARMED)
        wait_armed();
}

static bool is_latched(void)
{
    return mode == MODE_STOPPED || mode == MODE_FAULT;
}

static bool is_following(void)
{
    return mode == MODE_ARMED || mode == MODE_HOLDING;
}

bool safety_is_playing(void)
{
    return mode == MODE_CHECKING || mode == MODE_PLAYING;
}

static uint8_t latched_result(void)
{
    return mode == MODE_STOPPED ? RESULT_STOPPED : RESULT_FAULT;
}

Fault safety_follow(uint16_t deadline_ms, const uint16_t *counts, uint8_t joints)
{
    if (!is_following())
        return (Fault){FAULT_NOT_ARMED, NO_JOINT, mode};
    if (joints != MACHINE.joint_count)
        return (Fault){FAULT_WRONG_JOINTS, NO_JOINT, joints};
    if (deadline_ms < MIN_DEADLINE_MS || deadline_ms > MAX_DEADLINE_MS)
        return (Fault){FAULT_BAD_DEADLINE, NO_JOINT, deadline_ms};
    uint8_t joint = counts_out_of_range(counts);
    if (joint != NO_JOINT)
        return (Fault){FAULT_OUT_OF_RANGE, joint, counts[joint]};
    motion_aim(counts);
    expect_setpoint_within(deadline_ms);
    is_hosts = true;
    is_cleared = false;
    mode = MODE_ARMED;
    return NO_FAULT;
}

uint8_t safety_arm(const uint16_t *park, uint8_t joints)
{
    if (is_latched())
        return latched_result();
    if (supply_is_low())
        return RESULT_UNDERVOLTAGE;
    if (joints != MACHINE.joint_count)
        return RESULT_WRONG_JOINTS;
    if (counts_out_of_range(park) != NO_JOINT)
        return RESULT_OUT_OF_RANGE;
    if (is_following() || safety_is_playing()) {
        hold(MODE_ARMED);
    } else if (mode == MODE_DISARMED) {
        arming_begin(park);
        hold(MODE_ARMING);
    }
    return RESULT_OK;
}

uint8_t safety_arm_to_play(const uint16_t *start, uint8_t program)
{
    uint8_t result = safety_arm(start, MACHINE.joint_count);
    if (result == RESULT_OK)
        program_after_arming = program;
    return result;
}

uint8_t safety_disarm(void)
{
    motion_release();
    if (!is_latched())
        hold(MODE_DISARMED);
    return RESULT_OK;
}

uint8_t safety_stop(void)
{
    hold(MODE_STOPPED);
    return RESULT_OK;
}

uint8_t safety_clear(void)
{
    if (!is_latched())
        return RESULT_OK;
    if (buttons_is_stop())
        return RESULT_STOPPED;
    if (supply_is_low())
        return RESULT_UNDERVOLTAGE;
    fault = FAULT_NONE;
    if (!motion_is_all_on())
        motion_release();
    hold(motion_is_all_on() ? MODE_ARMED : MODE_DISARMED);
    is_cleared = true;
    return RESULT_OK;
}

uint8_t safety_play(uint8_t program, bool is_loop)
{
    if (is_latched())
        return latched_result();
    if (!is_following())
        return RESULT_NOT_ARMED;
    uint8_t result = play_begin(program, is_loop);
    if (result == RESULT_OK)
        hold(MODE_CHECKING);
    return result;
}

void safety_note_host(bool is_claim)
{
    program_after_arming = 0;
    if (is_claim)
        is_hosts = mode != MODE_DISARMED && mode != MODE_HOLDING;
}

/* A machine that stood still under a STOP does not fall because somebody has cleared it. */
static void watch_deadline(void)
{
    if (!deadline_has_passed())
        return;
    bool is_released = MACHINE.releases_on_link_loss && !is_cleared;
    if (is_released)
        motion_release();
    hold(is_released ? MODE_DISARMED : MODE_HOLDING);
    is_deadline_passed = true;
}

void safety_watch(void)
{
    buttons_read();
    if (buttons_is_stop() && mode != MODE_STOPPED)
        safety_stop();
    watch_deadline();
}

/* What is low refuses to arm at once, but only what stays low stops what moves. */
static Fault watch_supply(void)
{
    supply_watch();
    if (!supply_is_exhausted() || is_latched() || mode == MODE_DISARMED)
        return NO_FAULT;
    hold(MODE_FAULT);
    fault = FAULT_UNDERVOLTAGE;
    return (Fault){FAULT_UNDERVOLTAGE, NO_JOINT, supply_mv()};
}

static void arm_on(void)
{
    if (!arming_step())
        return;
    uint8_t program = program_after_arming;
    hold(MODE_ARMED);
    if (program)
        safety_play(program, true);
}

/* One period of a program; what cannot be reached ends it where the joints are. */
static Fault play(void)
{
    uint8_t step = play_step();
    if (step == PLAY_MOVING)
        mode = MODE_PLAYING;
    if (step == PLAY_DONE)
        wait_armed(); /* what was aimed at last still goes out */
    if (step != PLAY_UNREACHABLE && step != PLAY_TOO_FAST)
        return NO_FAULT;
    hold(MODE_ARMED);
    uint8_t code = step == PLAY_TOO_FAST ? FAULT_TOO_FAST : FAULT_OUT_OF_REACH;
    return (Fault){code, NO_JOINT, play_trouble_ms()};
}

Fault safety_pass_period(void)
{
    Fault begun = watch_supply();
    if (mode == MODE_ARMING)
        arm_on();
    if (begun.code == FAULT_NONE && safety_is_playing())
        begun = play();
    return begun;
}

bool safety_is_hosts(void)
{
    return is_hosts;
}

uint8_t safety_mode(void)
{
    return mode;
}

uint8_t safety_flags(void)
{
    return (uint8_t)((is_deadline_passed ? FLAG_DEADLINE_PASSED : 0) |
                     (supply_is_low() ? FLAG_UNDERVOLTAGE : 0) |
                     (motion_is_slewing() ? FLAG_SLEWING : 0));
}

uint8_t safety_fault(void)
{
    return fault;
}
