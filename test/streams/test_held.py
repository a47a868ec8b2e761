"""What the jog modes hold through the whole chain, at every moment and at the end of a metre.

Read from the drives' true angles, in between the board's pulses too; its steps are as irregular
as those of a thread that bytes wake up.
"""

import itertools

import numpy as np
import pytest

from manipulator.planning.goal import Goal
from sampling import enough

TILTED = np.radians([10.0, 20.0, 80.0, 20.0, 50.0, 0.0])
SIGHT = 0.35
HELD_ANGLE, HELD_POINT = np.radians(0.1), 0.5e-3
METRE = (([0.25, 0, 0], 120), ([0, -0.15, 0.1], 100), ([-0.25, 0, 0], 200))
STALL, STALL_EVERY = 10, 80
WAYS = list(itertools.product(['arm_6r', 'ur5', 'puma560'], range(3), [1, -1]))
EDGES = [('arm_6r', 1, 1), ('arm_6r', 2, 1), ('ur5', 0, -1), ('puma560', 0, 1), ('puma560', 0, -1)]
"""The ways on which two seconds lead to the edge of reach."""


@pytest.fixture
def arm(loop_of):
    """A stepper arm in a posture without symmetry, on a board that runs between the ticks."""
    loop = loop_of('arm_6r_stepper')
    rng = np.random.default_rng(3)
    loop.times_of_a_tick = lambda: 0.01 * rng.dirichlet([1.0, 1.0, 1.0])
    pose = loop.machine.kinematics.forward(TILTED).pose
    loop.supervisor.executor.pursue(Goal(pose, loop.now))
    while loop.supervisor.status.result != 'reached':
        loop.run(10)
        assert loop.tick < 1000
    return loop


def start_of(arm):
    return arm.machine.kinematics.forward(arm.true_joints[-1]).pose


def driven(arm, mode, commands, stall=0, point=None):
    """The true poses while a stick is held, and until the arm stands again."""
    if point is not None:
        arm.teleop.look_at(point)
    arm.teleop.set_mode(mode)
    arm.run(30)
    arm.true_joints.clear()
    for tick, twist in enumerate([part for part, ticks in commands for _ in range(ticks)]):
        arm.teleop.receive('cmd_vel/joy', np.resize([*twist, 0, 0, 0], 6), '', arm.now)
        arm.is_stalled = tick % STALL_EVERY >= STALL_EVERY - stall
        arm.run(1)
    arm.is_stalled = False
    arm.run(60)
    assert not arm.refusals
    return [arm.machine.kinematics.forward(q).pose for q in arm.true_joints]


def turned(poses):
    return np.array([np.linalg.norm(poses[0].twist_to(pose)[3:]) for pose in poses])


def way(poses):
    return np.linalg.norm(np.diff([pose.position for pose in poses], axis=0), axis=1).sum()


@pytest.mark.parametrize('stall', [0, STALL])
def test_orientation_is_held_over_a_metre_also_through_stalls_of_a_tenth_of_a_second(arm, stall):
    poses = driven(arm, 'hold_orientation', METRE, stall)
    assert way(poses) > 1.0
    assert turned(poses).max() < HELD_ANGLE
    assert turned(poses)[-1] < 0.3 * HELD_ANGLE


def test_point_is_held_while_the_tool_turns(arm):
    poses = driven(arm, 'turn_base_z', (([0, 0, 0, 0, 0, 0.5], 150), ([0, 0, 0, 0, 0, -0.5], 300)))
    shifts = np.linalg.norm([pose.position - poses[0].position for pose in poses], axis=1)
    assert turned(poses).max() > 0.6
    assert shifts.max() < 0.3 * HELD_POINT


def test_sight_stays_on_its_point_over_a_metre(arm):
    start = start_of(arm)
    point = start.position + SIGHT * start.rotation[:, 2]
    poses = driven(arm, 'look_at', METRE, point=point)
    missed = [np.linalg.norm(np.cross(p.rotation[:, 2], point - p.position)) for p in poses]
    assert way(poses) > 1.0
    assert max(missed) < HELD_POINT


def test_joint_at_the_end_of_its_range_is_followed_there(loop_of):
    """Who solves the jogged pose again for its joints must not find one beyond the range."""
    loop = loop_of('arm_6r_stepper')
    home = loop.machine.kinematics.home
    point = home.position + 0.3 * home.rotation[:, 2]
    driven(loop, 'look_at', (([-0.25, 0, 0], 100), ([0, 0.075, 0.15], 100)), point=point)
    limits = loop.machine.kinematics.limits
    assert np.min(np.abs(limits.high - loop.true_joints[-1])) < np.radians(0.1)


def test_jog_through_a_stretched_elbow_is_followed_on_its_branch(loop_of):
    loop = loop_of('puma560')
    driven(loop, 'free', (([0.2, 0, 0], 260),))
    assert np.abs(loop.sent[-1].joints - loop.supervisor.executor.joints).max() < 1e-6


@pytest.mark.parametrize(('name', 'axis', 'sign'), enough(EDGES, WAYS))
def test_jog_to_the_edge_of_reach_and_back_is_followed(loop_of, name, axis, sign):
    loop, out = loop_of(name), 0.25 * sign * np.eye(6)[axis]
    driven(loop, 'free', ((out, 200), (-out, 100), (out, 60), (-out, 60)))
    assert np.abs(loop.sent[-1].joints - loop.supervisor.executor.joints).max() < 1e-6
