import numpy as np
import pytest

from hexarm.machines import load
from manipulator import rotation as so3
from manipulator.errors import InvalidInput, LimitViolated
from manipulator.framed_machine import in_frames
from manipulator.frames import Frames, FramesConfig
from manipulator.planning.plan import MotionState
from manipulator.planning.planner import plan_to
from manipulator.planning.start import Start
from manipulator.pose import Pose

MACHINE = load('robocake')
FRAMES = Frames.from_config(
    FramesConfig((100.0, -50.0, 20.0), (10.0, 20.0, 30.0), (0.0, 10.0, 40.0))
)
FRAMED = in_frames(MACHINE, FRAMES)


def platform_pose(rng):
    return Pose(
        MACHINE.kinematics.home.position + rng.uniform(-0.003, 0.003, 3),
        so3.exp(rng.uniform(-0.04, 0.04, 3)),
    )


def test_pivot_and_platform_undo_each_other():
    rng = np.random.default_rng(0)
    pose = platform_pose(rng)
    assert np.abs(FRAMES.platform(FRAMES.pivot(pose)).twist_to(pose)).max() < 1e-12


def test_pivot_lies_where_it_was_put_on_the_platform():
    pose = platform_pose(np.random.default_rng(1))
    point = FRAMES.T_base_work.transform(FRAMES.pivot(pose).position[None])[0]
    np.testing.assert_allclose(point, pose.transform([[0.0, 0.01, 0.04]])[0], atol=1e-15)


def test_framed_machine_has_the_same_joints_and_comes_back():
    rng = np.random.default_rng(2)
    for _ in range(20):
        pose = platform_pose(rng)
        joints = FRAMED.kinematics.inverse(FRAMES.pivot(pose))
        np.testing.assert_allclose(joints, MACHINE.kinematics.inverse(pose), atol=1e-12)
        back = FRAMED.kinematics.forward(joints).pose
        assert np.abs(back.twist_to(FRAMES.pivot(pose))).max() < 1e-9


def test_framed_jacobian_is_the_derivative_of_the_pivot_in_work_axes():
    rng, h = np.random.default_rng(3), 1e-6
    pose = FRAMES.pivot(platform_pose(rng))
    joints = FRAMED.kinematics.inverse(pose)
    jacobian = FRAMED.kinematics.jacobian(pose, joints)
    for k in range(6):
        step = np.zeros(6)
        step[k] = h
        ahead, behind = (FRAMED.kinematics.forward(joints + s * step, pose).pose for s in (1, -1))
        np.testing.assert_allclose(jacobian[:, k], behind.twist_to(ahead) / (2 * h), atol=1e-6)


def test_limits_stay_those_of_the_platform():
    too_low = FRAMES.pivot(Pose.from_xyz_rpy((0.0, 0.0, 0.0234 - 0.001)))
    with pytest.raises(LimitViolated, match='platform height'):
        FRAMED.constraints.check(too_low, FRAMED.kinematics.inverse(too_low))


def test_turn_about_the_pivot_keeps_the_pivot_in_place():
    start = FRAMED.kinematics.home
    goal = Pose(start.position, so3.exp([0.0, 0.08, 0.05]) @ start.rotation)
    joints = FRAMED.kinematics.inverse(start)
    move = plan_to(FRAMED, Start(MotionState.at_rest(start), joints, 0.01), goal)
    poses = FRAMES.platform(move.at(np.linspace(0, move.duration, 30)).pose)
    pivots = FRAMES.T_base_work.inverse().transform(
        np.array([p.transform([[0.0, 0.01, 0.04]])[0] for p in (poses[i] for i in range(30))])
    )
    assert np.ptp(pivots, axis=0).max() < 1e-12
    assert np.ptp(poses.position, axis=0).max() > 0.001


def test_plain_frames_change_nothing():
    assert in_frames(MACHINE, Frames()).kinematics is MACHINE.kinematics


def test_pivot_nowhere_is_refused():
    with pytest.raises(InvalidInput, match='pivot'):
        Frames().with_pivot((float('nan'), 0.0, 0.0))


@pytest.mark.parametrize('name', ['arm_6r', 'robocake', 'stack_6_6'])
def test_frames_leave_the_kinematics_what_they_are(name):
    inner = load(name)
    framed = in_frames(inner, Frames().with_pivot([0.0, 0.01, 0.03]))
    for claim in ('is_explicit', 'joins_branches', 'joint_unit', 'joint_names'):
        assert getattr(framed.kinematics, claim) == getattr(inner.kinematics, claim), claim
