"""What every board does when nobody drives it: waits, holds, releases."""

import pytest

from bridge.protocol import Arm, Clear, Flag, Known, Mode, Setpoint, Stop

PARK = (3000, 2900, 3100, 3000, 2900, 3100)
MOVED = tuple(count + 200 for count in PARK)
FAR = (4800, 1200, 4000, 3000, 2900, 3100)
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
    armed.send(Setpoint(100, MOVED))
    armed.run(0.14)
    assert (armed.state().mode, armed.counts()) == (Mode.HOLDING, MOVED)
    armed.ask(Arm(PARK))
    armed.send(Setpoint(2000, PARK))
    armed.run(1.9)
    assert armed.state().mode is Mode.ARMED


@pytest.mark.parametrize('on_link_loss', ['hold', 'release'])
def test_a_machine_that_was_cleared_holds_until_a_host_drives_or_arms_it(
    make_driver, on_link_loss
):
    driver = make_driver(on_link_loss=on_link_loss)
    driver.arm()
    driver.send(Setpoint(2000, MOVED))
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
    driver.send(last)
    driver.run(2.1)
    assert (driver.state().mode, driver.state().flags) == (Mode.DISARMED, Flag.DEADLINE_PASSED)


def test_stopped_it_holds_for_as_long_as_it_is_left_alone(make_driver):
    driver = make_driver(on_link_loss='release')
    driver.arm()
    driver.send(Setpoint(100, MOVED))
    driver.run(0.06)
    driver.ask(Stop())
    driver.run(4.0)
    assert (driver.state().mode, driver.counts()) == (Mode.STOPPED, MOVED)


def test_when_the_deadline_passes_it_holds_where_it_is(armed):
    armed.send(Setpoint(60, FAR))
    armed.run(0.1)
    there = armed.counts()
    assert there != FAR
    armed.run(1.0)
    assert armed.counts() == there
    state = armed.state()
    assert (state.mode, state.flags) == (Mode.HOLDING, Flag.DEADLINE_PASSED)


def test_a_new_setpoint_ends_holding(armed):
    armed.send(Setpoint(20, MOVED))
    armed.run(0.2)
    armed.send(Setpoint(200, PARK))
    armed.run(0.1)
    assert armed.state().mode is Mode.ARMED
    assert armed.counts() == PARK


def test_released_on_link_loss_where_the_machine_says_so(make_driver):
    driver = make_driver(on_link_loss='release')
    driver.arm()
    driver.send(Setpoint(100, MOVED))
    driver.run(0.09)
    assert None not in driver.board.pulses
    driver.run(0.05)
    assert driver.board.pulses == (None,) * 6
    state = driver.state()
    assert (state.mode, state.flags) == (Mode.DISARMED, Flag.DEADLINE_PASSED)
    assert {joint.known for joint in state.joints} == {Known.UNKNOWN}


def test_a_refused_setpoint_does_not_prolong_the_deadline(armed):
    armed.send(Setpoint(100, MOVED))
    for _ in range(6):
        armed.run(0.02)
        armed.send(Setpoint(100, (0,) * 6))
    assert armed.state().mode is Mode.HOLDING
