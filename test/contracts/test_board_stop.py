"""What ends the motion of every board: STOP, DISARM, an empty battery; and what CLEAR leaves."""

import numpy as np
import pytest

from bridge.protocol import (
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
    Stop,
)

PARK = (3000, 2900, 3100, 3000, 2900, 3100)
FAR = (4800, 1200, 4000, 3000, 2900, 3100)
STEP_MV = 10  # of the chip's converter, behind the divider


def test_stop_halts_at_once_and_latches(armed):
    armed.send(Setpoint(1000, FAR))
    armed.run(0.06)
    moving = np.array(armed.board.pulses)
    assert armed.ask(Stop()) is Result.OK
    stopped = armed.board.pulses
    # A pulse that was under way goes out, and no more.
    assert np.all(np.abs(stopped - moving) <= 252)
    armed.run(0.5)
    assert armed.board.pulses == stopped
    armed.send(Setpoint(1000, FAR))
    assert [fault.code for fault in armed.faults()] == [FaultCode.NOT_ARMED]
    assert armed.ask(Arm(PARK)) is Result.STOPPED
    armed.run(0.1)
    assert armed.board.pulses == stopped


def test_clear_moves_nothing_and_lets_a_new_setpoint_through(armed):
    armed.send(Setpoint(1000, FAR))
    armed.run(0.06)
    armed.ask(Stop())
    before = armed.board.pulses
    assert armed.ask(Clear()) is Result.OK
    armed.run(1.5)
    assert armed.board.pulses == before
    assert armed.state().mode is Mode.ARMED
    armed.send(Setpoint(1000, PARK))
    armed.run(0.5)
    assert armed.counts() == PARK


def test_stop_while_arming_leaves_the_rest_off_and_clear_releases(driver):
    driver.run(0.4)
    driver.send(Arm(PARK))
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
