"""kinematics.c on this computer against the Python kinematics, over the whole workspace."""

import ctypes
import dataclasses

import numpy as np
import pytest

from bridge.calibration import Calibration
from bridge.fake.program import program
from bridge.servo_config import BoardConfig
from hexapod_control.leg_limits import RotaryLimits
from hexapod_control.workspace import sample
from hexarm import machines
from hexarm.board.kinematics import crank_hexapod
from manipulator import rotation
from manipulator.pose import Pose

POSES = 2000
FLOATS = ctypes.POINTER(ctypes.c_float)


class Solver:
    """The functions of kinematics.c, for RoboCake."""

    def __init__(self):
        config = BoardConfig.from_machine(machines.read('robocake'))
        calibration = Calibration.from_config(config.servos)
        self._hexapod = ctypes.byref(crank_hexapod(machines.load('robocake'), calibration))
        self._library = program()

    def kinematics_cranks(self, *arguments):
        self._library.kinematics_cranks.restype = ctypes.c_bool
        return self._library.kinematics_cranks(self._hexapod, *arguments)

    def kinematics_is_within_limits(self, *arguments):
        self._library.kinematics_is_within_limits.restype = ctypes.c_bool
        return self._library.kinematics_is_within_limits(self._hexapod, *arguments)

    def kinematics_counts(self, *arguments):
        self._library.kinematics_counts(self._hexapod, *arguments)

    def kinematics_rotation(self, *arguments):
        self._library.kinematics_rotation(*arguments)


@pytest.fixture(scope='module')
def board():
    return Solver()


@pytest.fixture(scope='module')
def machine():
    return machines.load('robocake')


@pytest.fixture(scope='module')
def poses(machine):
    return sample(machine, POSES, np.random.default_rng(1))


def floats(values):
    array = np.ascontiguousarray(values, np.float32)
    return array, array.ctypes.data_as(FLOATS)


def cranks(board, position, matrix):
    """Crank angles, or None where a leg does not close."""
    angles, out = floats(np.full(6, np.nan))
    (_p, at), (_r, turn) = floats(position), floats(matrix.ravel())
    return angles if board.kinematics_cranks(at, turn, out) else None


def test_crank_angles_are_the_python_ones_over_the_whole_workspace(board, machine, poses):
    ours = np.array(
        [cranks(board, p, r) for p, r in zip(poses.position, poses.rotation, strict=True)]
    )
    error = np.abs(ours - machine.kinematics.inverse(poses))
    # The last bit is multiplied by 1/sin where a crank and its rod are nearly in line.
    elbows = np.array(
        [
            machine.kinematics.inverse_all(pose)[[0, -1]]
            for pose in map(poses.__getitem__, range(POSES))
        ]
    )
    half = (elbows[:, 0] - elbows[:, 1]) / 2
    assert (error * np.abs(np.sin(half))).max() < 2e-6
    assert error.max() < 1e-4
    assert np.median(error) < 5e-7


def test_the_angles_close_the_rods(board, machine, poses):
    g = machine.kinematics.geometry
    for k in range(0, POSES, 20):
        pose = poses[k]
        tips = machine.kinematics.crank_tips(cranks(board, pose.position, pose.rotation))
        rods = np.linalg.norm(pose.transform(g.platform_points) - tips, axis=-1)
        assert rods == pytest.approx(g.rod_lengths, abs=2e-7)


def test_what_does_not_close_is_refused_where_python_refuses_it(board, machine):
    rng = np.random.default_rng(2)
    position = machine.kinematics.home.position + rng.normal(0, 0.006, (2000, 3))
    matrix = rotation.exp(rng.normal(0, 0.06, (2000, 3)))
    closes = np.isfinite(machine.kinematics.inverse_or_nan(Pose(position, matrix))).all(axis=1)
    ours = [cranks(board, p, r) is not None for p, r in zip(position, matrix, strict=True)]
    assert 200 < closes.sum() < 1800
    assert np.array_equal(ours, closes)


@pytest.mark.parametrize('bad', [np.nan, np.inf, 1e30])
def test_poses_that_are_none_are_refused(board, bad):
    assert cranks(board, [0.0, bad, 0.04], np.eye(3)) is None


def test_limits_are_those_of_the_machine_file(board, machine):
    home = machine.kinematics.home.position
    inside = np.full(6, 2.0)

    def is_within(position, angles):
        return board.kinematics_is_within_limits(floats(position)[1], floats(angles)[1])

    assert is_within(home, inside)
    assert not is_within([0, 0, 0.0233], inside)
    for i in range(6):
        for angle in (np.radians(29.9), np.radians(210.1), np.nan):
            outside = inside.copy()
            outside[i] = angle
            assert not is_within(home, outside)


def test_each_crank_has_its_own_range(machine):
    limits = machines.read('robocake').limits
    ranges = [[30.0 + leg, 210.0 - leg] for leg in range(6)]
    own = RotaryLimits(**limits | {'crank_range_deg': ranges}).constraints(machine.kinematics)
    config = BoardConfig.from_machine(machines.read('robocake'))
    calibration = Calibration.from_config(config.servos)
    hexapod = crank_hexapod(dataclasses.replace(machine, constraints=own), calibration)
    for leg in range(6):
        ends = hexapod.crank_lowest[leg], hexapod.crank_highest[leg]
        assert np.degrees(ends) == pytest.approx(ranges[leg])


def test_rotation_is_about_fixed_x_then_y_then_z(board):
    rpy = np.array([0.3, -0.2, 0.5])
    matrix, out = floats(np.zeros(9))
    board.kinematics_rotation(floats(rpy)[1], out)
    assert matrix.reshape(3, 3) == pytest.approx(rotation.from_rpy(rpy), abs=1e-6)


def test_counts_are_those_of_the_calibration(board, machine):
    config = BoardConfig.from_machine(machines.read('robocake'))
    calibration = Calibration.from_config(config.servos)
    angles = np.radians([100.0, 110.0, 120.0, 130.0, 140.0, 150.0])
    counts, out = floats(np.zeros(6))
    board.kinematics_counts(floats(angles)[1], out)
    assert np.rint(counts).tolist() == list(calibration.counts(angles))
