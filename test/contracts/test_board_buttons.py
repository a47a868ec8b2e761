"""The contacts of stop and start: a stop contact that opens, so that a broken wire stops too."""

import pytest

from bridge.protocol import Arm, Clear, Mode, Result, Setpoint

PARK = (3000, 2900, 3100, 3000, 2900, 3100)
FAR = (4800, 1200, 4800, 1200, 4800, 1200)


def test_the_stop_button_holds_the_pulses_and_latches(armed):
    armed.send(Setpoint(1000, FAR))
    armed.run(0.05)
    armed.board.is_stop_open = True
    armed.run(0.03)
    there = armed.state()
    assert there.mode is Mode.STOPPED
    armed.run(0.5)
    assert armed.state().joints == there.joints
    assert armed.ask(Clear()) is Result.STOPPED
    armed.board.is_stop_open = False
    armed.run(0.1)
    assert armed.state().mode is Mode.STOPPED
    assert armed.ask(Arm(PARK)) is Result.STOPPED
    assert armed.ask(Clear()) is Result.OK
    assert armed.state().joints == there.joints


def test_with_the_stop_contact_open_nothing_arms(driver):
    driver.board.is_stop_open = True
    driver.run(0.4)
    assert driver.ask(Arm(PARK)) is Result.STOPPED
    driver.run(1.0)
    assert driver.board.pulses == (None,) * 6


def test_a_spark_on_the_stop_wire_stops_nothing(armed):
    armed.board.is_stop_open = True
    armed.board.step(0.001)
    armed.board.is_stop_open = False
    armed.run(0.1)
    assert armed.state().mode in (Mode.ARMED, Mode.HOLDING)


def test_sparks_do_not_add_up(armed):
    for _ in range(20):
        armed.board.is_stop_open = True
        armed.board.step(0.001)
        armed.board.is_stop_open = False
        armed.board.step(0.002)
    assert armed.state().mode in (Mode.ARMED, Mode.HOLDING)


def test_a_contact_that_has_just_closed_may_open_again(armed):
    """A stop that was cleared while the contact bounces would be none."""
    armed.board.is_stop_open = True
    armed.run(0.1)
    armed.board.is_stop_open = False
    armed.run(0.01)
    armed.send(Clear())
    armed.run(0.01)
    assert armed.state().mode is Mode.STOPPED


@pytest.mark.parametrize(('seconds', 'is_pressed'), [(0.01, False), (0.06, True)])
def test_the_start_button_acts_once_it_has_been_closed_for_a_moment(armed, seconds, is_pressed):
    armed.board.is_stop_open = True
    armed.run(0.05)
    armed.board.is_stop_open = False
    armed.run(0.1)
    armed.board.is_start_closed = True
    armed.run(seconds)
    armed.board.is_start_closed = False
    armed.run(0.1)
    assert (armed.state().mode is not Mode.STOPPED) is is_pressed


def test_a_start_contact_that_is_closed_at_power_up_does_nothing_until_it_was_open(driver):
    driver.board.is_start_closed = True
    driver.board.is_stop_open = True
    driver.run(0.5)
    driver.board.is_stop_open = False
    driver.run(0.2)
    assert driver.state().mode is Mode.STOPPED
    driver.board.is_start_closed = False
    driver.run(0.1)
    driver.press_start()
    assert driver.state().mode is Mode.DISARMED
