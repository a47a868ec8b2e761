"""What every board does with its servos: arms, follows, holds, stops, refuses."""

import numpy as np
import pytest

from bridge.messages import (
    NO_JOINT,
    Arm,
    Clear,
    Disarm,
    Fault,
    FaultCode,
    Flag,
    Known,
    Mode,
    Result,
    Setpoint,
    State,
    Stop,
)

PARK = (3000, 2900, 3100, 3000, 2900, 3100)
MOVED = tuple(count + 200 for count in PARK)
FAR = (4800, 1200, 4000, 3000, 2900, 3100)
STEP_MV = 10  # of the chip's converter, behind the divider


def test_arming_energises_servo_by_servo_at_park(driver):
    driver.run(0.4)
    driver.say(Arm(PARK))
    lit = []
    for _ in range(200):
        driver.run(0.005)
        pulses = driver.board.pulses
        lit.append(sum(pulse is not None for pulse in pulses))
        assert all(p in (None, park) for p, park in zip(pulses, PARK, strict=True))
    starts = [lit.index(number) * 0.005 for number in range(1, 7)]
    assert np.diff(starts) == pytest.approx([0.15] * 5, abs=0.021)
    assert driver.state().mode is Mode.ARMED
    assert driver.counts() == PARK


def test_setpoints_are_refused_while_it_arms_and_before(driver):
    driver.run(0.4)
    for mode in (Mode.DISARMED, Mode.ARMING):
        driver.say(Setpoint(200, MOVED))
        (fault,) = driver.faults()
        assert (fault.code, fault.value) == (FaultCode.NOT_ARMED, mode)
        driver.say(Arm(PARK))
    driver.run(1.0)
    assert driver.counts() == PARK


ARMED_BY = {
    'arming': lambda driver: None,
    'arming again': lambda driver: driver.ask(Arm(PARK)),
}
"""Ways to be armed without a setpoint; `arm` has waited a little already."""


@pytest.mark.parametrize('way', ARMED_BY)
@pytest.mark.parametrize('on_link_loss', ['hold', 'release'])
def test_the_first_setpoint_has_a_deadline_of_two_seconds(make_driver, on_link_loss, way):
    driver = make_driver(on_link_loss=on_link_loss)
    driver.arm()
    ARMED_BY[way](driver)
    driver.run(1.5)
    assert (driver.state().mode, driver.state().flags) == (Mode.ARMED, Flag(0))
    assert driver.counts() == PARK
    driver.run(0.5)
    mode = Mode.HOLDING if on_link_loss == 'hold' else Mode.DISARMED
    assert (driver.state().mode, driver.state().flags) == (mode, Flag.DEADLINE_PASSED)
    assert (driver.board.pulses == PARK) == (on_link_loss == 'hold')


def test_the_first_setpoint_brings_its_own_deadline(armed):
    armed.say(Setpoint(100, MOVED))
    armed.run(0.14)
    assert (armed.state().mode, armed.counts()) == (Mode.HOLDING, MOVED)
    armed.ask(Arm(PARK))
    armed.say(Setpoint(2000, PARK))
    armed.run(1.9)
    assert armed.state().mode is Mode.ARMED


@pytest.mark.parametrize('on_link_loss', ['hold', 'release'])
def test_a_machine_that_was_cleared_holds_until_a_host_drives_or_arms_it(
    make_driver, on_link_loss
):
    driver = make_driver(on_link_loss=on_link_loss)
    driver.arm()
    driver.say(Setpoint(2000, MOVED))
    driver.run(0.1)
    driver.ask(Stop())
    driver.run(3.0)
    driver.ask(Clear())
    driver.run(1.5)
    assert (driver.state().mode, driver.state().flags) == (Mode.ARMED, Flag(0))
    driver.run(0.5)
    assert (driver.state().mode, driver.state().flags) == (Mode.HOLDING, Flag.DEADLINE_PASSED)
    driver.run(3.0)
    assert (driver.state().mode, driver.counts()) == (Mode.HOLDING, MOVED)


@pytest.mark.parametrize('last', [Setpoint(100, PARK), Arm(PARK)])
def test_a_host_that_was_heard_since_the_clear_may_be_lost_again(make_driver, last):
    driver = make_driver(on_link_loss='release')
    driver.arm()
    driver.ask(Stop())
    driver.ask(Clear())
    driver.say(last)
    driver.run(2.1)
    assert (driver.state().mode, driver.state().flags) == (Mode.DISARMED, Flag.DEADLINE_PASSED)


def test_stopped_it_holds_for_as_long_as_it_is_left_alone(make_driver):
    driver = make_driver(on_link_loss='release')
    driver.arm()
    driver.say(Setpoint(100, MOVED))
    driver.run(0.06)
    driver.ask(Stop())
    driver.run(4.0)
    assert (driver.state().mode, driver.counts()) == (Mode.STOPPED, MOVED)


def test_arming_again_moves_nothing(armed):
    armed.say(Setpoint(200, MOVED))
    armed.run(0.1)
    assert armed.ask(Arm(PARK)) is Result.OK
    armed.run(1.0)
    assert armed.counts() == MOVED
    assert armed.state().mode is Mode.ARMED


def test_when_the_deadline_passes_it_holds_where_it_is(armed):
    armed.say(Setpoint(60, FAR))
    armed.run(0.1)
    there = armed.counts()
    assert there != FAR
    armed.run(1.0)
    assert armed.counts() == there
    state = armed.state()
    assert (state.mode, state.flags) == (Mode.HOLDING, Flag.DEADLINE_PASSED)


def test_a_new_setpoint_ends_holding(armed):
    armed.say(Setpoint(20, MOVED))
    armed.run(0.2)
    armed.say(Setpoint(200, PARK))
    armed.run(0.1)
    assert armed.state().mode is Mode.ARMED
    assert armed.counts() == PARK


def test_released_on_link_loss_where_the_machine_says_so(make_driver):
    driver = make_driver(on_link_loss='release')
    driver.arm()
    driver.say(Setpoint(100, MOVED))
    driver.run(0.09)
    assert None not in driver.board.pulses
    driver.run(0.05)
    assert driver.board.pulses == (None,) * 6
    state = driver.state()
    assert (state.mode, state.flags) == (Mode.DISARMED, Flag.DEADLINE_PASSED)
    assert {joint.known for joint in state.joints} == {Known.UNKNOWN}


def test_all_servos_slew_by_one_factor(armed):
    armed.say(Setpoint(1000, FAR))
    armed.run(0.02)
    way = np.array(FAR) - np.array(PARK)
    for state in (m for m in armed.run(0.1) if isinstance(m, State)):
        done = np.array([joint.count for joint in state.joints]) - np.array(PARK)
        factor = done[0] / way[0]
        assert 0 < factor < 1
        assert np.all(np.abs(done - factor * way) <= 1)
        assert Flag.SLEWING in state.flags
    armed.run(0.3)
    assert armed.counts() == FAR


def test_no_servo_is_told_to_move_faster_than_it_can(armed):
    armed.say(Setpoint(1000, FAR))
    last = np.array(PARK, float)
    for _ in range(20):
        armed.run(0.02)
        now = np.array(armed.board.pulses)
        assert np.all(np.abs(now - last) <= 12_600 * 0.02 + 1e-6)
        last = now


@pytest.mark.parametrize('count', [0, 1099, 4901, 65535])
def test_one_count_out_of_range_refuses_the_whole_frame(armed, count):
    armed.say(Setpoint(200, (*MOVED[:2], count, *MOVED[3:])))
    (fault,) = armed.faults()
    assert fault == Fault(FaultCode.OUT_OF_RANGE, 2, count)
    assert armed.counts() == PARK
    assert armed.state().refused == 1


@pytest.mark.parametrize('joints', [1, 5, 7, 8])
def test_another_number_of_joints_is_refused(armed, joints):
    armed.say(Setpoint(200, (3000,) * joints))
    (fault,) = armed.faults()
    assert (fault.code, fault.value) == (FaultCode.WRONG_JOINTS, joints)
    armed.ask(Disarm())
    assert armed.ask(Arm((3000,) * joints)) is Result.WRONG_JOINTS


@pytest.mark.parametrize('deadline_ms', [0, 2001, 65535])
def test_a_deadline_beyond_reason_is_refused(armed, deadline_ms):
    armed.say(Setpoint(deadline_ms, MOVED))
    assert [fault.code for fault in armed.faults()] == [FaultCode.BAD_DEADLINE]
    assert armed.counts() == PARK


def test_a_refused_setpoint_does_not_prolong_the_deadline(armed):
    armed.say(Setpoint(100, MOVED))
    for _ in range(6):
        armed.run(0.02)
        armed.say(Setpoint(100, (0,) * 6))
    assert armed.state().mode is Mode.HOLDING


def test_park_out_of_range_arms_nothing(driver):
    driver.run(0.4)
    assert driver.ask(Arm((3000,) * 5 + (4901,))) is Result.OUT_OF_RANGE
    driver.run(1.0)
    assert driver.board.pulses == (None,) * 6


def test_stop_halts_at_once_and_latches(armed):
    armed.say(Setpoint(1000, FAR))
    armed.run(0.06)
    moving = np.array(armed.board.pulses)
    assert armed.ask(Stop()) is Result.OK
    stopped = armed.board.pulses
    # A pulse that was under way goes out, and no more.
    assert np.all(np.abs(stopped - moving) <= 252)
    armed.run(0.5)
    assert armed.board.pulses == stopped
    armed.say(Setpoint(1000, FAR))
    assert [fault.code for fault in armed.faults()] == [FaultCode.NOT_ARMED]
    assert armed.ask(Arm(PARK)) is Result.STOPPED
    armed.run(0.1)
    assert armed.board.pulses == stopped


def test_clear_moves_nothing_and_lets_a_new_setpoint_through(armed):
    armed.say(Setpoint(1000, FAR))
    armed.run(0.06)
    armed.ask(Stop())
    before = armed.board.pulses
    assert armed.ask(Clear()) is Result.OK
    armed.run(1.5)
    assert armed.board.pulses == before
    assert armed.state().mode is Mode.ARMED
    armed.say(Setpoint(1000, PARK))
    armed.run(0.5)
    assert armed.counts() == PARK


def test_stop_while_arming_leaves_the_rest_off_and_clear_releases(driver):
    driver.run(0.4)
    driver.say(Arm(PARK))
    driver.run(0.2)
    driver.ask(Stop())
    driver.run(1.0)
    assert driver.board.pulses == (3000, 2900, None, None, None, None)
    driver.ask(Clear())
    assert driver.board.pulses == (None,) * 6
    assert driver.state().mode is Mode.DISARMED


def test_stop_latches_while_disarmed_too(driver):
    driver.run(0.4)
    driver.ask(Stop())
    assert driver.ask(Arm(PARK)) is Result.STOPPED
    driver.ask(Clear())
    assert driver.ask(Arm(PARK)) is Result.OK


def test_disarm_ends_all_pulses_and_forgets_where_the_joints_are(armed):
    assert armed.ask(Disarm()) is Result.OK
    assert armed.board.pulses == (None,) * 6
    assert {joint.known for joint in armed.state().joints} == {Known.UNKNOWN}


def test_disarm_while_stopped_releases_but_stays_stopped(armed):
    armed.ask(Stop())
    armed.ask(Disarm())
    assert armed.board.pulses == (None,) * 6
    assert armed.state().mode is Mode.STOPPED


def test_a_low_battery_refuses_to_arm(driver):
    driver.run(0.4)
    driver.board.battery_mv = 6380
    driver.run(0.04)
    assert driver.ask(Arm(PARK)) is Result.UNDERVOLTAGE
    driver.board.battery_mv = 6420
    driver.run(0.04)
    assert driver.ask(Arm(PARK)) is Result.OK


def test_a_dip_is_flagged_but_only_a_lasting_undervoltage_is_a_fault(armed):
    armed.board.battery_mv = 5900
    state = armed.state()
    assert state.mode is Mode.ARMED
    assert state.battery_mv == pytest.approx(5900, abs=STEP_MV)
    assert Flag.UNDERVOLTAGE in state.flags
    messages = armed.run(0.6)
    (fault,) = [m for m in messages if isinstance(m, Fault)]
    assert (fault.code, fault.joint) == (FaultCode.UNDERVOLTAGE, NO_JOINT)
    assert fault.value == pytest.approx(5900, abs=STEP_MV)
    assert armed.state().mode is Mode.FAULT
    assert armed.counts() == PARK
    assert armed.ask(Clear()) is Result.UNDERVOLTAGE
    armed.board.battery_mv = 7600
    armed.run(0.04)
    assert armed.ask(Arm(PARK)) is Result.FAULT
    assert armed.ask(Clear()) is Result.OK
    assert armed.state().mode is Mode.ARMED
