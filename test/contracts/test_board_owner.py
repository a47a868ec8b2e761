"""Whose the machine is: the start button never acts against a host, on any board."""

import pytest

from bridge.protocol import (
    Arm,
    Clear,
    CycleAxis,
    Disarm,
    Finish,
    Mode,
    Play,
    Program,
    Result,
    Setpoint,
    State,
    Stop,
)

PARK = (3000, 2900, 3100, 3000, 2900, 3100)
START = tuple(count + 50 for count in PARK)
WAVE = [START, tuple(count + 100 for count in START), START]
BY_ITSELF = {Mode.CHECKING, Mode.PLAYING}


def modes(driver, seconds):
    """In the order in which the board was in them."""
    seen = [m.mode for m in driver.run(seconds) if isinstance(m, State)]
    return list(dict.fromkeys(seen))


@pytest.fixture
def loaded(driver):
    """Disarmed, with WAVE uploaded."""
    driver.run(0.4)
    assert driver.upload(WAVE, 200) is Result.OK
    return driver


@pytest.fixture
def starting(loaded):
    """The start button was pressed: it arms, to play WAVE then; three servos are on."""
    loaded.press_start()
    loaded.run(0.15)
    assert loaded.state().mode is Mode.ARMING
    assert loaded.board.pulses == (*START[:3], None, None, None)
    return loaded


def test_the_start_button_arms_where_the_program_begins_plays_it_and_ends_it(starting):
    seen = modes(starting, 3.0)
    assert seen[-1] is Mode.PLAYING
    starting.press_start()
    assert modes(starting, 1.5)[-1] is Mode.ARMED
    starting.press_start()
    assert starting.state().mode in BY_ITSELF


@pytest.mark.parametrize('command', [Arm(PARK), Finish(), Clear()])
def test_a_host_that_speaks_while_the_button_arms_is_the_master(starting, command):
    assert starting.ask(command) is Result.OK
    assert starting.state().mode is Mode.ARMING
    assert modes(starting, 4.0) == [Mode.ARMING, Mode.ARMED, Mode.HOLDING]
    assert starting.counts() == START


def test_what_is_uploaded_while_the_button_arms_is_not_played_in_its_place(starting):
    assert starting.upload([START, tuple(count + 200 for count in PARK), START], 200) is Result.OK
    assert modes(starting, 4.0) == [Mode.ARMING, Mode.ARMED, Mode.HOLDING]
    assert starting.counts() == START


@pytest.mark.parametrize(('command', 'mode'), [(Disarm(), Mode.DISARMED), (Stop(), Mode.STOPPED)])
def test_a_host_that_ends_the_arming_ends_what_was_to_be_played(starting, command, mode):
    assert starting.ask(command) is Result.OK
    assert modes(starting, 2.0) == [mode]
    starting.ask(Clear())
    starting.ask(Arm(START))
    assert modes(starting, 2.0) == [Mode.ARMING, Mode.ARMED]


@pytest.mark.parametrize('command', [Arm((0,) * 6), Arm(PARK[:5]), Play(Program.TABLE, False)])
def test_what_is_refused_while_the_button_arms_changes_nothing(starting, command):
    assert starting.ask(command) is not Result.OK
    assert modes(starting, 2.0)[-1] is Mode.PLAYING


def test_a_machine_that_a_host_has_armed_is_the_hosts_until_its_deadline_passes(loaded):
    loaded.arm(START)
    loaded.press_start()
    assert loaded.state().mode is Mode.ARMED
    loaded.send(Setpoint(300, START))
    loaded.press_start()
    assert loaded.state().mode is Mode.ARMED
    loaded.run(0.3)
    assert loaded.state().mode is Mode.HOLDING
    loaded.press_start()
    assert modes(loaded, 1.0)[-1] is Mode.PLAYING


def test_a_setpoint_makes_the_machine_the_hosts(starting):
    starting.run(2.0)
    starting.press_start()
    starting.run(1.5)
    assert starting.state().mode is Mode.ARMED
    starting.send(Setpoint(2000, starting.counts()))
    starting.press_start()
    assert starting.state().mode is Mode.ARMED


def test_after_a_hosts_program_the_machine_is_still_the_hosts(loaded):
    loaded.arm(START)
    assert loaded.ask(Play(Program.TABLE, True)) is Result.OK
    loaded.run(2.0)
    loaded.press_start()
    assert modes(loaded, 1.5)[-1] is Mode.ARMED
    loaded.press_start()
    assert loaded.state().mode is Mode.ARMED


def test_the_start_button_clears_a_stop_and_the_machine_stays_whose_it_was(loaded):
    loaded.arm(START)
    loaded.board.is_stop_open = True
    loaded.run(0.1)
    assert loaded.state().mode is Mode.STOPPED
    loaded.press_start()
    assert loaded.state().mode is Mode.STOPPED
    loaded.board.is_stop_open = False
    loaded.run(0.1)
    loaded.press_start()
    assert loaded.state().mode is Mode.ARMED
    loaded.press_start()
    assert modes(loaded, 2.0) == [Mode.ARMED, Mode.HOLDING]
    assert loaded.counts() == START


def test_a_start_contact_that_is_closed_at_power_up_starts_nothing(driver):
    driver.run(0.4)
    driver.ask(CycleAxis(2, 0.002, 1000, 0.0))
    driver.run(2.0)
    driver.reset()
    driver.board.is_start_closed = True
    assert modes(driver, 1.0) == [Mode.DISARMED]
    driver.board.is_start_closed = False
    driver.run(0.1)
    driver.press_start()
    assert driver.state().mode is Mode.ARMING
