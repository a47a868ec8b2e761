import numpy as np
import pytest

from hexapod_control import load
from hexapod_control.modes import all_modes
from hexapod_control.workspace import sample
from manipulator.config import build
from manipulator.errors import NoSolution
from manipulator.framed_machine import in_frames
from manipulator.frames import Frames
from manipulator.machine import MachineFile
from manipulator.pose import Pose
from sampling import enough


@pytest.fixture(params=['robocake', 'stewart_6_6', 'stewart_6_3'])
def machine(request, robocake, stewart_content):
    if request.param == 'robocake':
        return robocake
    return load.hexapod(build(MachineFile, stewart_content(request.param)))


def legs_by_definition(machine, pose, joints):
    g = machine.kinematics.geometry
    ends = g.platform_points @ pose.rotation.T + pose.position
    return np.linalg.norm(ends - machine.kinematics.base_points(joints), axis=1)


def test_the_pose_that_made_the_joints_is_the_only_mode_that_fits(machine):
    poses = sample(machine, enough(8, 20), np.random.default_rng(5))
    for k, joints in enumerate(machine.kinematics.inverse(poses)):
        found = all_modes(machine, joints)
        (fitting,) = found.that_fit
        assert np.abs(poses[k].twist_to(fitting.pose)).max() < 1e-8
        assert found.is_complete
        assert len(found.other_than(poses[k])) == len(found.modes) - 1


def test_every_mode_has_the_joints_and_says_what_it_breaks(machine):
    kinematics = machine.kinematics
    joints = kinematics.inverse(kinematics.home.moved([0.003, 0.002, 0.004, 0.03, 0.02, 0.05]))
    found = all_modes(machine, joints)
    assert len(found.modes) >= 4
    for mode in found.modes:
        legs = legs_by_definition(machine, mode.pose, joints)
        np.testing.assert_allclose(legs, kinematics.rod_lengths(joints), atol=1e-11)
        violations = machine.constraints.violations(mode.pose, joints)
        assert list(mode.violations) == violations
        assert mode.is_reachable <= (not violations)
        assert mode.sigma_min == pytest.approx(kinematics.sigma_min(mode.pose, joints))


def test_a_pose_beyond_the_singularity_with_a_twin_inside_is_told(robocake):
    """The angles of a platform that was forced through also belong to a pose inside."""
    generator = np.random.default_rng(7)
    xyz = generator.uniform([-0.02, -0.02, 0.02339], [0.02, 0.02, 0.06], (20_000, 3))
    poses = Pose.from_xyz_rpy(xyz, generator.uniform(-0.5, 0.5, (20_000, 3)))
    kinematics = robocake.kinematics
    joints = kinematics.inverse_or_nan(poses)
    closed = np.isfinite(joints).all(axis=1)
    poses, joints = poses[closed], joints[closed]
    beyond = np.flatnonzero(~kinematics.is_as_at_home(poses, joints))
    told = 0
    for k in beyond[:60]:
        fitting = all_modes(robocake, joints[k]).that_fit
        assert all(np.abs(poses[k].twist_to(mode.pose)).max() > 1e-4 for mode in fitting)
        if fitting:
            cold = kinematics.forward(joints[k]).pose
            assert np.abs(cold.twist_to(fitting[0].pose)).max() < 1e-7
            told += 1
    assert told >= 5


def test_joints_that_are_not_six_finite_numbers_are_refused(machine):
    with pytest.raises(NoSolution, match='not finite'):
        all_modes(machine, np.array([np.nan] + [0.19] * 5))
    with pytest.raises(NoSolution, match='shape'):
        all_modes(machine, np.full(5, 0.19))


def test_legs_too_long_to_meet_have_no_modes(stewart_content):
    machine = load.hexapod(build(MachineFile, stewart_content('stewart_6_6')))
    found = all_modes(machine, np.array([0.5, 0.19, 0.19, 0.19, 0.19, 0.19]))
    assert found.modes == ()
    assert found.is_complete


def test_modes_of_home_are_complete_where_symmetry_makes_real_turns_with_complex_places(machine):
    """All cranks alike: a half turn about z solves the RoboCake's equations, at no real place."""
    kinematics = machine.kinematics
    found = all_modes(machine, kinematics.inverse(kinematics.home))
    assert found.is_complete
    assert np.abs(found.that_fit[0].pose.twist_to(kinematics.home)).max() < 1e-9


def test_modes_of_a_machine_in_the_users_frames_are_those_of_the_machine(machine):
    frames = Frames(Pose.from_xyz_rpy([0.1, -0.2, 0.05], [0.0, 0.0, 0.7])).with_pivot([0, 0, 0.03])
    joints = machine.kinematics.inverse(machine.kinematics.home.moved([2e-3, 0, 0, 0, 0, 0.03]))
    plain, framed = all_modes(machine, joints), all_modes(in_frames(machine, frames), joints)
    assert len(framed.modes) == len(plain.modes) > 1
    for one, other in zip(plain.modes, framed.modes, strict=True):
        assert np.abs(frames.pivot(one.pose).twist_to(other.pose)).max() < 1e-12
        assert one.is_reachable == other.is_reachable
        assert len(one.violations) == len(other.violations)
