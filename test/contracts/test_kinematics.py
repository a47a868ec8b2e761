"""What every kinematics must do, over the whole workspace of every machine in config/."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from arm_control.load import arm
from hexapod_control.load import hexapod
from hexapod_control.stacks.load import stack
from hexapod_control.workspace import sample
from hexarm.machines import content_of
from leg_kinds import FLAT_CRANKS, HANGING_LEGS, RAILS, SCREW_LEGS, TILTED_CRANKS
from manipulator.config import build
from manipulator.errors import NoSolution, Unreachable
from manipulator.machine import Machine, MachineFile
from manipulator.pose import Pose

CONFIG = Path(__file__).parents[2] / 'config'
POSES = 200


@dataclass(frozen=True)
class Case:
    """settles: m or rad to which the inverse finds the same joints again."""

    file: str
    load: Callable[[MachineFile], Machine]
    sample: Callable[[Machine, int, np.random.Generator], Pose]
    settles: float = 1e-12


def sample_stack(machine, count, generator):
    """Ends of sections that are anywhere in their own workspaces, those that the rule admits."""
    stack = machine.kinematics.stack
    ends = stack.end_of([sample(section, 2 * count, generator) for section in stack.sections])
    return ends[machine.constraints.admits(ends, machine.kinematics.inverse(ends))][:count]


def sample_arm(machine: Machine, count: int, rng: np.random.Generator) -> Pose:
    """Poses of joint angles that are uniform within the joint ranges."""
    chain, limits = machine.kinematics.chain, machine.kinematics.limits
    return chain.forward(rng.uniform(limits.low, limits.high, (count, 6)))


CASES = [
    Case('robocake.yaml', hexapod, sample),
    Case('stewart_6_3.yaml', hexapod, sample),
    Case(TILTED_CRANKS, hexapod, sample),
    Case(FLAT_CRANKS, hexapod, sample),
    Case(RAILS, hexapod, sample),
    Case('linear_rails.yaml', hexapod, sample),
    Case(HANGING_LEGS, hexapod, sample),
    Case(SCREW_LEGS, hexapod, sample),
    Case('stewart_6_6.yaml', hexapod, sample),
    Case('stack_6_6.yaml', stack, sample_stack, settles=1e-9),
    Case('arm_6r.yaml', arm, sample_arm),
    Case('ur5.yaml', arm, sample_arm),
    Case('puma560.yaml', arm, sample_arm),
]


@dataclass(frozen=True)
class Subject:
    machine: Machine
    poses: Pose
    joints: np.ndarray
    settles: float


@pytest.fixture(scope='module', params=CASES, ids=lambda case: Path(case.file).stem)
def subject(request):
    case = request.param
    file = build(MachineFile, content_of(CONFIG / case.file), source=case.file)
    machine = case.load(file)
    poses = case.sample(machine, POSES, np.random.default_rng(20))
    return Subject(machine, poses, machine.kinematics.inverse(poses), case.settles)


def test_last_link_is_the_moving_frame(subject):
    for k in range(0, POSES, 20):
        *_, last = subject.machine.kinematics.links(subject.poses[k], subject.joints[k])
        assert last.name == 'platform'
        assert np.abs(subject.poses[k].twist_to(last.pose)).max() < 1e-12


def test_cold_forward_finds_the_pose_that_made_the_joints(subject):
    for k in range(POSES):
        solution = subject.machine.kinematics.forward(subject.joints[k])
        error = subject.poses[k].twist_to(solution.pose)
        assert np.abs(error[:3]).max() < 1e-9
        assert np.abs(error[3:]).max() < 1e-8


def test_warm_forward_finds_the_pose_from_one_nearby(subject):
    twists = np.random.default_rng(21).uniform(-1, 1, (POSES, 6)) * ([5e-4] * 3 + [0.01] * 3)
    starts = subject.poses.moved(twists)
    iterations = np.zeros(2)
    for k in range(POSES):
        solution = subject.machine.kinematics.forward(subject.joints[k], starts[k])
        cold = subject.machine.kinematics.forward(subject.joints[k])
        iterations += solution.iterations, cold.iterations
        error = subject.poses[k].twist_to(solution.pose)
        assert np.abs(error[:3]).max() < 1e-9
        assert np.abs(error[3:]).max() < 1e-8
    assert iterations[0] <= 0.9 * iterations[1]


def test_forward_reports_what_the_pose_deserves(subject):
    kinematics = subject.machine.kinematics
    margins = kinematics.sigma_min(subject.poses, subject.joints)
    for k in range(POSES):
        solution = kinematics.forward(subject.joints[k])
        assert solution.sigma_min == pytest.approx(margins[k], abs=1e-6)
        assert solution.residual < 1e-9


def test_jacobian_agrees_with_finite_differences_of_forward(subject):
    kinematics, step = subject.machine.kinematics, 1e-5
    jacobians = kinematics.jacobian(subject.poses, subject.joints)
    for k in range(0, POSES, 10):
        pose, joints = subject.poses[k], subject.joints[k]
        for j, change in enumerate(np.eye(len(joints)) * step):
            ahead = kinematics.forward(joints + change, pose).pose
            behind = kinematics.forward(joints - change, pose).pose
            slope = behind.twist_to(ahead) / (2 * step)
            np.testing.assert_allclose(jacobians[k, :, j], slope, rtol=1e-4, atol=1e-6)


def test_arrays_of_poses_give_what_single_poses_give(subject):
    kinematics = subject.machine.kinematics
    grid = Pose(
        subject.poses.position.reshape(2, -1, 3), subject.poses.rotation.reshape(2, -1, 3, 3)
    )
    joints = kinematics.inverse(grid)
    assert joints.shape == (2, POSES // 2, len(kinematics.joint_names))
    near = kinematics.inverse(grid, joints[0, 0])
    jacobians = kinematics.jacobian(grid, joints)
    margins = kinematics.sigma_min(grid, joints)
    for index in [(0, 0), (0, 7), (1, 3), (1, POSES // 2 - 1)]:
        pose = grid[index]
        np.testing.assert_allclose(joints[index], kinematics.inverse(pose), rtol=1e-12)
        np.testing.assert_allclose(near[index], kinematics.inverse(pose, joints[0, 0]), rtol=1e-12)
        single = kinematics.jacobian(pose, joints[index])
        np.testing.assert_allclose(jacobians[index], single, rtol=1e-9, atol=1e-12)
        assert margins[index] == pytest.approx(kinematics.sigma_min(pose, joints[index]))


def test_no_poses_have_no_joints(subject):
    none = subject.poses[:0]
    assert subject.machine.kinematics.inverse_or_nan(none).shape == (0, subject.joints.shape[-1])


def test_inverse_stays_on_the_branch_that_it_is_given(subject):
    again = subject.machine.kinematics.inverse(subject.poses, subject.joints)
    np.testing.assert_allclose(again, subject.joints, atol=subject.settles)


def test_a_pose_out_of_reach_is_refused_by_the_inverse_or_by_the_limits(subject):
    machine = subject.machine
    far = machine.kinematics.home.moved([0.0, 0.0, 50.0, 0.0, 0.0, 0.0])
    with pytest.raises(Unreachable):
        machine.constraints.check(far, machine.kinematics.inverse(far))
    assert not machine.constraints.admits(far, machine.kinematics.inverse_or_nan(far))


def test_one_pose_out_of_reach_does_not_spoil_its_neighbours(subject):
    kinematics = subject.machine.kinematics
    position = subject.poses.position.copy()
    position[3] += [0.0, 0.0, 50.0]
    poses = Pose(position, subject.poses.rotation)
    joints = kinematics.inverse_or_nan(poses)
    assert not subject.machine.constraints.admits(poses, joints)[3]
    others = np.arange(POSES) != 3
    np.testing.assert_array_equal(joints[others], subject.joints[others])


@pytest.mark.parametrize('bad', [np.nan, np.inf, -np.inf])
def test_joints_that_are_not_finite_are_refused(subject, bad):
    joints = subject.joints[0].copy()
    joints[2] = bad
    for near in (None, subject.poses[0]):
        with pytest.raises(NoSolution):
            subject.machine.kinematics.forward(joints, near)


def test_joints_of_the_wrong_shape_are_refused(subject):
    for joints in (subject.joints[0][:-1], subject.joints[:1], np.array(0.1)):
        with pytest.raises(NoSolution):
            subject.machine.kinematics.forward(joints)


def test_nan_joints_have_no_margin(subject):
    joints = np.full(subject.joints.shape[-1], np.nan)
    assert np.isnan(subject.machine.kinematics.sigma_min(subject.poses[0], joints))


def test_every_sampled_pose_keeps_the_constraints(subject):
    assert subject.machine.constraints.admits(subject.poses, subject.joints).all()


def test_home_is_where_forward_of_its_own_joints_starts(subject):
    kinematics = subject.machine.kinematics
    solution = kinematics.forward(kinematics.inverse(kinematics.home))
    assert solution.iterations == 0
    assert len(kinematics.joint_names) == subject.joints.shape[-1]
    assert kinematics.joint_unit in ('rad', 'm')
