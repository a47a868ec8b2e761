"""Refusals of numbers in another unit, wherever a goal or a question comes from."""

from dataclasses import replace

import numpy as np
import pytest

from hexarm.machines import load, shipped
from manipulator.analysis.reach import reach
from manipulator.errors import InvalidInput, LimitViolated, Refused, Unreachable
from manipulator.planning.path import Tolerance
from manipulator.planning.path_timing import PathRequest, plan_path
from manipulator.planning.planner import check_goal
from manipulator.pose import Pose
from manipulator.unit_hints import check_pivot, check_turns, hint_at_metres

HINT = 'millimetres'


@pytest.mark.parametrize('name', shipped())
def test_home_in_millimetres_is_refused_with_the_hint(name):
    machine = load(name)
    home = machine.kinematics.home
    near = machine.kinematics.inverse(home)
    with pytest.raises(Unreachable, match=HINT):
        check_goal(machine, Pose(1e3 * home.position, home.rotation), near)


@pytest.mark.parametrize('name', shipped())
def test_what_is_a_little_out_of_reach_is_refused_without_it(name):
    machine = load(name)
    home = machine.kinematics.home
    up = np.array([0.0, 0.0, 3 * machine.kinematics.characteristic_length])
    far = Pose(home.position + up, home.rotation)
    assert not reach(machine, far).is_reachable
    assert HINT not in reach(machine, far).reason


def test_path_in_millimetres_is_refused_with_it():
    machine = load('robocake')
    home = machine.kinematics.home
    poses = Pose(
        np.array([[0.0, 0.0, 41.0], [1.0, 0.0, 41.0]]), np.stack([home.rotation, home.rotation])
    )
    request = PathRequest(poses, machine.motion.linear.speed, Tolerance())
    with pytest.raises(Refused, match=HINT):
        plan_path(machine, request, machine.kinematics.inverse(home), 0.01)


def test_a_pivot_is_far_by_the_machines_own_size():
    kinematics, pivot = load('robocake').kinematics, Pose.from_xyz_rpy((0.0, 0.0, 2.758))
    with pytest.raises(InvalidInput, match=r'2\.758 m from the platform, at most 1\.4 m'):
        check_pivot(kinematics, pivot)
    check_pivot(replace(kinematics, characteristic_length=1.5), pivot)


def test_the_error_keeps_its_facts():
    machine = load('stewart_6_6')
    pose = Pose.from_xyz_rpy((0.0, 0.0, 200.0))
    with (
        pytest.raises(LimitViolated, match=HINT) as caught,
        hint_at_metres(machine.kinematics, pose),
    ):
        machine.constraints.check(pose, machine.kinematics.inverse(pose))
    assert (caught.value.limit, caught.value.leg) == ('leg length', 1)


def test_more_than_a_turn_is_taken_for_degrees():
    check_turns((-6.283, 0.0, 6.2832))
    with pytest.raises(InvalidInput, match=r'yaw: 10 rad .* degrees\? .* 10° are 0.1745'):
        check_turns((0.0, 0.0, 10.0))
