"""What every board does with a cycle about home, which it solves by itself."""

import dataclasses
import math

import numpy as np
import pytest

from bridge.calibration import Calibration
from bridge.protocol import CycleAxis, Fault, FaultCode, Finish, Mode, Play, Program, Result, State
from bridge.servo_config import BoardConfig
from hexapod_control.load import hexapod
from hexarm import machines
from hexarm.board.kinematics import crank_hexapod
from manipulator import rotation
from manipulator.limits.constraints import Constraints
from manipulator.limits.machine_limits import BodyHeight, JointRange
from manipulator.pose import Pose

PARK = (3000, 2900, 3100, 3000, 2900, 3100)
HOME = (3000,) * 6
ARMED = (Mode.ARMED, Mode.HOLDING)  # it waits 2 s for a host, then holds
STEP = 252  # counts that a servo can do in one pulse period
WAVE = [
    tuple(round(c + 150 * math.sin(math.pi * k / 20)) for c in PARK) for k in range(41)
]  # 2 s at 50 ms, from PARK and back to it
ROBOCAKE = machines.load('robocake')
SERVOS = Calibration.from_config(BoardConfig.from_machine(machines.read('robocake')).servos)
KNOWN_LIMITS = tuple(
    limit for limit in ROBOCAKE.constraints.limits if isinstance(limit, JointRange | BodyHeight)
)
TURN = CycleAxis(5, 0.0625, 500, 0.0)  # yaw, with a period of 2 s


def solve(offsets, machine=ROBOCAKE):
    """Counts of x, y, z, roll, pitch and yaw from home; None beyond what the board allows."""
    kinematics = machine.kinematics
    turn = rotation.from_rpy(np.array(offsets[3:])) @ kinematics.home.rotation
    pose = Pose(kinematics.home.position + np.array(offsets[:3]), turn)
    cranks = kinematics.inverse_or_nan(pose)
    if not Constraints(KNOWN_LIMITS).admits(pose, cranks):
        return None
    return SERVOS.nearest_counts(cranks)


def test_a_cycle_is_solved_by_the_board_itself(make_driver):
    driver = make_driver()
    driver.arm(HOME)
    assert driver.ask(TURN) is Result.OK
    assert driver.ask(CycleAxis(2, 0.003, 500, math.pi / 2)) is Result.OK
    assert driver.ask(Play(Program.CYCLE, True)) is Result.OK
    driver.run(6.0)
    modes, counts = driver.record(4.0)
    assert set(modes) == {Mode.PLAYING}
    angle = np.arange(200) * 0.02 * math.pi
    wanted = np.array(
        [solve([0, 0, 0.003 * math.cos(a), 0, 0, 0.0625 * math.sin(a)]) for a in angle]
    )
    shifts = [np.abs(np.roll(wanted, k, axis=0) - counts).max() for k in range(100)]
    assert min(shifts) <= 1.0
    driver.ask(Finish())
    modes, counts = driver.record(3.0)
    assert modes[-1] in ARMED
    assert counts[-1] == pytest.approx(solve([0] * 6), abs=0.51)
    assert np.abs(np.diff(counts, axis=0)).max() < 60


def test_a_cycle_turns_about_all_axes_as_the_inverse_kinematics_say(make_driver):
    driver, axes = make_driver(), (0.003, -0.002, 0.002, 0.04, -0.05, 0.06)
    driver.arm(HOME)
    phases = [0.3 * k for k in range(6)]
    for k, (amplitude, phase) in enumerate(zip(axes, phases, strict=True)):
        assert driver.ask(CycleAxis(k, amplitude, 500, phase)) is Result.OK
    assert driver.ask(Play(Program.CYCLE, True)) is Result.OK
    driver.run(6.0)
    modes, counts = driver.record(2.0)
    assert set(modes) == {Mode.PLAYING}
    angle = np.arange(100) * 0.02 * math.pi
    wanted = np.array([solve(np.array(axes) * np.sin(a + np.array(phases))) for a in angle])
    shifts = [np.abs(np.roll(wanted, k, axis=0) - counts).max() for k in range(100)]
    assert min(shifts) <= 1.0
    assert driver.ask(TURN) is Result.NO_PROGRAM  # not while it is played


def test_a_cycle_once_is_one_period_and_home_again(make_driver):
    driver = make_driver()
    driver.arm(HOME)
    driver.ask(TURN)
    driver.ask(Play(Program.CYCLE, False))
    modes, counts = driver.record(8.0)
    assert modes[-1] in ARMED
    assert 2.5 < 0.02 * modes.count(Mode.PLAYING) < 4.0
    assert counts[-1] == pytest.approx(solve([0] * 6), abs=0.51)


def test_a_cycle_is_about_a_home_that_is_shifted_and_turned(make_driver):
    file = machines.read('robocake')
    home = {'home_xy_mm': [1.0, -0.5], 'home_rpy_deg': [1.0, 0.5, -1.0]}
    machine = hexapod(dataclasses.replace(file, geometry=file.geometry | home))
    driver = make_driver(hexapod=crank_hexapod(machine, SERVOS))
    driver.arm(solve([0] * 6, machine))
    assert driver.ask(TURN) is Result.OK
    assert driver.ask(Play(Program.CYCLE, True)) is Result.OK
    driver.run(3.0)
    _, counts = driver.record(3.0)
    for yaw in (-0.0625, 0.0625):
        turned = solve([0, 0, 0, 0, 0, yaw], machine)
        assert np.abs(counts - turned).max(axis=1).min() <= 2.0
    driver.ask(Finish())
    _, counts = driver.record(3.0)
    assert counts[-1] == pytest.approx(solve([0] * 6, machine), abs=0.51)


@pytest.mark.parametrize(
    ('axis', 'code'),
    [
        (CycleAxis(0, 0.03, 500, 0.0), FaultCode.OUT_OF_REACH),
        (CycleAxis(2, 0.0179, 500, 0.0), FaultCode.OUT_OF_REACH),
        (CycleAxis(5, 0.125, 12_500, 0.4), FaultCode.TOO_FAST),
    ],
)
def test_a_cycle_that_cannot_be_followed_is_refused_before_anything_moves(make_driver, axis, code):
    driver = make_driver()
    driver.arm(HOME)
    driver.ask(axis)
    driver.send(Play(Program.CYCLE, True))
    messages = driver.run(4.0)
    assert [m.code for m in messages if isinstance(m, Fault)] == [code]
    states = [m for m in messages if isinstance(m, State)]
    assert {joint.count for state in states for joint in state.joints} == {3000}
    assert states[-1].mode in ARMED


@pytest.mark.parametrize('axis', [CycleAxis(2, 0.0179, 500, 0.0), CycleAxis(2, 0.0179, 100, 0.0)])
def test_where_in_the_cycle_it_is_out_of_reach_is_told_in_ms(make_driver, axis):
    driver = make_driver()
    driver.arm(HOME)
    period = 1e3 / axis.frequency_mhz

    def counts(k):
        height = axis.amplitude * math.sin(2 * math.pi * 0.02 * k / period + axis.phase)
        return solve([0, 0, height, 0, 0, 0])

    lost = next(k for k in range(4000) if counts(k) is None)
    driver.ask(axis)
    driver.send(Play(Program.CYCLE, True))
    messages = driver.run(0.02 * lost + 0.5)
    (fault,) = [m for m in messages if isinstance(m, Fault)]
    assert fault.code is FaultCode.OUT_OF_REACH
    assert fault.value == pytest.approx(20 * lost, abs=20)


def test_a_cycle_whose_samples_hide_its_speed_ends_where_it_would_be_too_fast(make_driver):
    """24.9 Hz in samples of 50 Hz: all near zero in the first period, farther off in each next."""
    driver = make_driver()
    driver.arm(HOME)
    assert driver.ask(CycleAxis(5, 0.06, 24_900, 0.0)) is Result.OK
    assert driver.ask(Play(Program.CYCLE, True)) is Result.OK
    messages = driver.run(4.0)
    assert [m.code for m in messages if isinstance(m, Fault)] == [FaultCode.TOO_FAST]
    states = [m for m in messages if isinstance(m, State)]
    assert Mode.PLAYING in [state.mode for state in states]
    counts = np.array([[joint.count for joint in state.joints] for state in states])
    assert np.abs(np.diff(counts, axis=0)).max() <= STEP
    assert states[-1].mode in ARMED


@pytest.mark.parametrize(
    'axis',
    [
        CycleAxis(6, 0.001, 500, 0.0),
        CycleAxis(0, math.nan, 500, 0.0),
        CycleAxis(0, 0.001, 500, math.inf),
        CycleAxis(0, 0.001, 25_001, 0.0),
    ],
)
def test_an_axis_without_sense_is_refused(armed, axis):
    assert armed.ask(axis) is Result.OUT_OF_RANGE


def test_a_cycle_that_repeats_only_after_more_than_a_minute_is_refused(make_driver):
    driver = make_driver()
    driver.arm(HOME)
    driver.ask(CycleAxis(0, 0.001, 500, 0.0))
    driver.ask(CycleAxis(1, 0.001, 501, 0.0))
    assert driver.ask(Play(Program.CYCLE, True)) is Result.OUT_OF_RANGE


def test_a_board_without_kinematics_has_no_cycle(make_driver):
    driver = make_driver(hexapod=None)
    driver.arm()
    assert driver.ask(TURN) is Result.NO_PROGRAM


def test_a_cycle_outlives_a_reset_and_a_table_does_not(make_driver):
    driver = make_driver()
    driver.arm(HOME)
    driver.ask(TURN)
    driver.upload(WAVE[:3])
    driver.run(2.0)
    driver.reset()
    driver.arm(HOME)
    assert driver.ask(Play(Program.TABLE, False)) is Result.NO_PROGRAM
    assert driver.ask(Play(Program.CYCLE, False)) is Result.OK


@pytest.mark.parametrize('axis', [CycleAxis(2, 0.0, 500, 0.0), CycleAxis(2, 0.003, 0, 0.0)])
def test_a_cycle_in_which_no_axis_moves_is_none(make_driver, axis):
    driver = make_driver()
    driver.arm(HOME)
    assert driver.ask(axis) is Result.OK
    assert driver.ask(Play(Program.CYCLE, True)) is Result.NO_PROGRAM
