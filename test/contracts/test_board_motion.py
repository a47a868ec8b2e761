"""What every board does with its servos: arms, follows, refuses."""

import numpy as np
import pytest

from bridge.protocol import Arm, Disarm, Fault, FaultCode, Flag, Mode, Result, Setpoint, State

PARK = (3000, 2900, 3100, 3000, 2900, 3100)
MOVED = tuple(count + 200 for count in PARK)
FAR = (4800, 1200, 4000, 3000, 2900, 3100)


def test_arming_energises_servo_by_servo_at_park(driver):
    driver.run(0.4)
    driver.send(Arm(PARK))
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


def test_an_interval_of_whole_periods_is_kept_to_the_period(make_driver):
    driver = make_driver(arm_interval_us=40_000)
    driver.run(0.4)
    driver.send(Arm(PARK))
    lit = []
    for _ in range(20):
        driver.run(0.02)
        lit.append(sum(pulse is not None for pulse in driver.board.pulses))
    starts = [lit.index(number) for number in range(1, 7)]
    assert np.diff(starts).tolist() == [2] * 5


def test_setpoints_are_refused_while_it_arms_and_before(driver):
    driver.run(0.4)
    for mode in (Mode.DISARMED, Mode.ARMING):
        driver.send(Setpoint(200, MOVED))
        (fault,) = driver.faults()
        assert (fault.code, fault.value) == (FaultCode.NOT_ARMED, mode)
        driver.send(Arm(PARK))
    driver.run(1.0)
    assert driver.counts() == PARK


def test_arming_again_moves_nothing(armed):
    armed.send(Setpoint(200, MOVED))
    armed.run(0.1)
    assert armed.ask(Arm(PARK)) is Result.OK
    armed.run(1.0)
    assert armed.counts() == MOVED
    assert armed.state().mode is Mode.ARMED


def test_all_servos_slew_by_one_factor(armed):
    armed.send(Setpoint(1000, FAR))
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
    armed.send(Setpoint(1000, FAR))
    last = np.array(PARK, float)
    for _ in range(20):
        armed.run(0.02)
        now = np.array(armed.board.pulses)
        assert np.all(np.abs(now - last) <= 12_600 * 0.02 + 1e-6)
        last = now


@pytest.mark.parametrize('count', [0, 1099, 4901, 65535])
def test_one_count_out_of_range_refuses_the_whole_frame(armed, count):
    armed.send(Setpoint(200, (*MOVED[:2], count, *MOVED[3:])))
    (fault,) = armed.faults()
    assert fault == Fault(FaultCode.OUT_OF_RANGE, 2, count)
    assert armed.counts() == PARK
    assert armed.state().refused == 1


def test_both_ends_of_the_range_may_be_gone_to(armed):
    ends = (1100, 4900, 1100, 4900, 1100, 4900)
    armed.send(Setpoint(1000, ends))
    assert armed.faults() == []
    armed.run(0.5)
    assert armed.counts() == ends


@pytest.mark.parametrize('joints', [1, 5, 7, 8])
def test_another_number_of_joints_is_refused(armed, joints):
    armed.send(Setpoint(200, (3000,) * joints))
    (fault,) = armed.faults()
    assert (fault.code, fault.value) == (FaultCode.WRONG_JOINTS, joints)
    armed.ask(Disarm())
    assert armed.ask(Arm((3000,) * joints)) is Result.WRONG_JOINTS


@pytest.mark.parametrize('deadline_ms', [0, 2001, 65535])
def test_a_deadline_beyond_reason_is_refused(armed, deadline_ms):
    armed.send(Setpoint(deadline_ms, MOVED))
    assert [fault.code for fault in armed.faults()] == [FaultCode.BAD_DEADLINE]
    assert armed.counts() == PARK


def test_park_out_of_range_arms_nothing(driver):
    driver.run(0.4)
    assert driver.ask(Arm((3000,) * 5 + (4901,))) is Result.OUT_OF_RANGE
    driver.run(1.0)
    assert driver.board.pulses == (None,) * 6
