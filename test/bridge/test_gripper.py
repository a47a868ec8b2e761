import numpy as np
import pytest

from bridge.calibration import Calibration
from bridge.command_validator import CommandValidator
from bridge.gripper import Gripper
from bridge.servo_config import BoardConfig
from hexarm.machines import read
from manipulator.errors import InvalidInput, Refused

CONFIG = BoardConfig.from_machine(read('arm_6r')).servos
CALIBRATION = Calibration.from_config(CONFIG)
CLOSED, OPEN = np.radians([-50.0, 50.0])
PERIOD, DEADLINE = 0.01, 0.2


@pytest.fixture
def gripper():
    return Gripper(CONFIG, CALIBRATION, DEADLINE)


def step(gripper, now, present, is_admitted=True):
    """Where a command without it sends it."""
    joints = np.append(CALIBRATION.park[:6], present)
    _, positions = gripper.joined((CALIBRATION.names[:6], CALIBRATION.park[:6]), now, joints)
    if is_admitted:
        gripper.note_admitted()
    return positions[-1]


def test_machine_without_a_gripper_has_none():
    servos = BoardConfig.from_machine(read('robocake')).servos
    none = Gripper(servos, Calibration.from_config(servos), DEADLINE)
    with pytest.raises(InvalidInput, match='no gripper'):
        none.aim(0.5)
    command = (('crank_1',), (2.0,))
    assert none.joined(command, 0.0, None) == command


def test_it_stays_where_it_is_until_it_is_asked(gripper):
    assert [step(gripper, PERIOD * k, 0.3) for k in range(5)] == [0.3] * 5


@pytest.mark.parametrize(('opening', 'end'), [(0.0, CLOSED), (1.0, OPEN), (0.5, 0.0)])
def test_it_opens_over_its_pulse_range_no_faster_than_half_the_servos_speed(gripper, opening, end):
    step(gripper, 0.0, 0.1)
    gripper.aim(opening)
    way = [0.1] + [step(gripper, PERIOD * k, 0.1) for k in range(1, 100)]
    assert way[-1] == pytest.approx(end)
    assert np.abs(np.diff(way)).max() <= 0.5 * CALIBRATION.speed * PERIOD * 1.0001


@pytest.mark.parametrize('opening', [-0.1, 1.1, float('nan')])
def test_openings_out_of_range_are_refused(gripper, opening):
    with pytest.raises(InvalidInput, match='gripper'):
        gripper.aim(opening)


def test_it_does_not_move_after_a_restart_until_it_is_asked_again(gripper):
    step(gripper, 0.0, 0.1)
    gripper.aim(1.0)
    step(gripper, PERIOD, 0.1)
    gripper.restart()
    assert step(gripper, 2 * PERIOD, -0.2) == -0.2
    assert step(gripper, 3 * PERIOD, -0.2) == -0.2


def test_commands_that_are_refused_do_not_move_it(gripper):
    step(gripper, 0.0, 0.1)
    gripper.aim(1.0)
    refused = [step(gripper, PERIOD * k, 0.1, is_admitted=False) for k in range(1, 5)]
    assert refused == sorted(refused)
    assert step(gripper, 0.05, 0.1) == pytest.approx(0.1 + 0.5 * CALIBRATION.speed * 0.05)


def test_after_a_silence_it_begins_where_it_is_and_goes_on(gripper):
    step(gripper, 0.0, 0.1)
    gripper.aim(1.0)
    step(gripper, PERIOD, 0.1)
    assert step(gripper, 1.0, 0.2) == 0.2
    assert step(gripper, 1.0 + PERIOD, 0.2) == pytest.approx(
        0.2 + 0.5 * CALIBRATION.speed * PERIOD
    )


def test_a_command_without_it_becomes_one_that_the_validator_admits(gripper):
    present = CALIBRATION.park
    names, positions = gripper.joined((CALIBRATION.names[:6], present[:6]), 0.0, present)
    assert tuple(names) == CALIBRATION.names
    setpoint = CommandValidator(CALIBRATION, 0.2).admit(names, positions, None, 0.0, present)
    assert setpoint.counts == CALIBRATION.counts(present)


def test_a_command_that_names_it_is_left_alone(gripper):
    command = (CALIBRATION.names, tuple(CALIBRATION.park))
    assert gripper.joined(command, 0.0, CALIBRATION.park) == command


def test_it_waits_until_somebody_knows_where_it_is(gripper):
    with pytest.raises(Refused, match='gripper'):
        gripper.joined((CALIBRATION.names[:6], CALIBRATION.park[:6]), 0.0, None)
