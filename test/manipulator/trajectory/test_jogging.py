"""Jogging through the player: limits over random streams, edges, and the way back from them."""

import contextlib
import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hexarm.machines import load
from manipulator.errors import Refused, Unreachable
from manipulator.framed_machine import in_frames
from manipulator.frames import Frames
from manipulator.pose import Pose
from manipulator.teleop.feedback import Feedback
from manipulator.teleop.free import Free
from manipulator.teleop.modes import jog_mode
from manipulator.trajectory.cycle import Cycle
from manipulator.trajectory.goal import Goal
from manipulator.trajectory.jogging import Wish
from manipulator.trajectory.player import Player

DT = 0.01
FREE = Free()
FRAMES = Frames(T_base_work=Pose.from_xyz_rpy([0.01, 0.02, 0.0], [0.0, 0.0, 0.6])).with_pivot(
    [0.0, 0.01, 0.03]
)
MACHINES = {name: load(name) for name in ('robocake', 'stewart_6_3', 'arm_6r')}
MACHINES |= {f'{name} in frames': in_frames(MACHINES[name], FRAMES) for name in tuple(MACHINES)}
PLATFORMS = [name for name in MACHINES if not name.startswith('arm')]
JOY = 'cmd_vel/joy'


def player(machine):
    home = machine.kinematics.home
    return Player(machine, home, machine.kinematics.inverse(home), DT)


def wish(twist, mode=FREE, frame='', source=JOY):
    return Wish(source, np.array(twist, dtype=float), frame, mode)


def run(motion, ticks, wanted=None):
    """Poses and joints of every tick, the present one first."""
    poses, joints = [motion.state.pose], [motion.joints]
    for _ in range(ticks):
        motion.jog(wanted)
        poses.append(motion.step())
        joints.append(motion.joints)
    return poses, joints


def run_to_the_edge(motion, wanted):
    """As `run`, until the machine hardly moves any more."""
    poses, joints = run(motion, 3, wanted)
    while np.abs(poses[-2].twist_to(poses[-1])).max() > 1e-5 and len(poses) < 1000:
        more = run(motion, 1, wanted)
        poses.append(more[0][-1])
        joints.append(more[1][-1])
    return poses, joints


def check_limits(machine, poses, joints):
    """By differences: joints, tool or platform speed, every configuration inside.

    A parallel platform also keeps its own acceleration; an arm's joints may need to brake harder
    before a stop than its tool would.
    """
    motion, joints = machine.motion, np.array(joints)
    speed = np.diff(joints, axis=0) / DT
    assert (np.abs(speed) <= 1.01 * motion.joint.speed).all()
    assert (np.abs(np.diff(speed, axis=0)) / DT <= 1.01 * motion.joint.acceleration).all()
    twists = np.array([a.twist_to(b) for a, b in itertools.pairwise(poses)]) / DT
    assert np.linalg.norm(twists[:, :3], axis=1).max() <= 1.02 * motion.linear.speed
    assert np.linalg.norm(twists[:, 3:], axis=1).max() <= 1.02 * motion.angular.speed
    for pose, q in zip(poses, joints, strict=True):
        machine.constraints.check(pose, q)
        assert np.abs(machine.kinematics.inverse(pose, q) - q).max() < 1e-6


unit_twists = st.tuples(*([st.floats(-1.0, 1.0)] * 6))
shifts = st.tuples(*([st.floats(-1.0, 1.0)] * 6))
MODES = ('free', 'hold_orientation', 'turn_base_z', 'turn_tool_x', 'parallel', 'look_at')
commands = st.one_of(
    st.tuples(
        st.just('jog'),
        unit_twists,
        st.sampled_from(MODES),
        st.sampled_from(['', 'tool', 'work']),
    ),
    st.tuples(st.just('release')),
    st.tuples(st.just('goal'), shifts),
    st.tuples(st.just('stop')),
    st.tuples(st.just('pause'), st.booleans()),
    st.tuples(st.just('override'), st.floats(0.0, 1.0)),
    st.tuples(st.just('cycle')),
)
streams = st.lists(st.tuples(commands, st.integers(1, 40)), min_size=1, max_size=8)


def obey(motion, machine, command, stamp):
    """Gives one command; returns what the joystick wants from now on."""
    reach = 0.3 * machine.kinematics.characteristic_length
    home = machine.kinematics.home
    match command:
        case ('jog', part, name, frame):
            feedback, point = (
                Feedback.for_delay(0.0),
                home.moved([0, 0, 4 * reach, 0, 0, 0]).position,
            )
            size = 1.5 * np.repeat([machine.motion.linear.speed, machine.motion.angular.speed], 3)
            return wish(size * part, jog_mode(name, feedback, point), frame)
        case ('goal', shift):
            with contextlib.suppress(Refused):
                scale = np.repeat([reach, 0.3], 3)
                motion.pursue(Goal(home.moved(scale * shift), stamp))
        case ('stop',):
            motion.stop()
        case ('pause', is_paused):
            motion.pause(is_paused)
        case ('override', rate):
            motion.override(rate)
        case ('cycle',):
            amplitude = np.repeat([0.1 * reach, 0.03], 3)
            with contextlib.suppress(Refused, Unreachable):
                motion.start_cycle(Cycle(motion.state.pose, amplitude, [0.5] * 6, [0.5] * 6))
    return None


@pytest.mark.parametrize('name', MACHINES)
@settings(max_examples=4, deadline=None)
@given(stream=streams)
def test_no_stream_of_commands_and_twists_leaves_the_limits(name, stream):
    machine = MACHINES[name]
    motion, wanted = player(machine), None
    all_poses, all_joints = [motion.state.pose], [motion.joints]
    for k, (command, ticks) in enumerate(stream):
        wanted = obey(motion, machine, command, float(k))
        poses, joints = run(motion, ticks, wanted)
        all_poses += poses[1:]
        all_joints += joints[1:]
    check_limits(machine, all_poses, all_joints)


@pytest.mark.parametrize('seed', range(3))
@pytest.mark.parametrize('name', PLATFORMS)
def test_platform_slides_to_a_stop_at_the_edge_and_is_driven_back(name, seed):
    machine = MACHINES[name]
    first, second = np.random.default_rng(seed).uniform(-1.0, 1.0, (2, 6))
    motion = player(machine)
    size = np.repeat([machine.motion.linear.speed, machine.motion.angular.speed], 3)
    outward = [size * d / np.abs(d).max() for d in (first, second)]
    for out in outward:
        poses, joints = run_to_the_edge(motion, wish(out))
        check_limits(machine, poses, joints)
    # Backwards over the last edge, which may end at the first one, then away from that.
    run_to_the_edge(motion, wish(-outward[1]))
    edge = motion.state.pose
    back, _ = run(motion, 40, wish(-outward[0]))
    way = edge.twist_to(back[-1]) / size
    assert np.abs(way).max() > 0.01


@pytest.mark.parametrize('name', PLATFORMS)
def test_platform_keeps_its_accelerations_while_jogged(name):
    machine = MACHINES[name]
    motion, rng = player(machine), np.random.default_rng(5)
    size = np.repeat([machine.motion.linear.speed, machine.motion.angular.speed], 3)
    poses = [motion.state.pose]
    for _ in range(20):
        poses += run(motion, 25, wish(size * rng.uniform(-1, 1, 6)))[0][1:]
    twists = np.array([a.twist_to(b) for a, b in itertools.pairwise(poses)]) / DT
    changes = np.diff(twists, axis=0) / DT
    linear, angular = machine.motion.linear, machine.motion.angular
    assert np.linalg.norm(changes[:, :3], axis=1).max() <= 1.001 * linear.acceleration
    assert np.linalg.norm(changes[:, 3:], axis=1).max() <= 1.001 * angular.acceleration
    assert np.linalg.norm(changes[:, :3], axis=1).max() > 0.1 * linear.acceleration


@pytest.mark.parametrize('name', MACHINES)
def test_jog_says_why_it_is_scaled_but_not_at_every_tick(name):
    machine = MACHINES[name]
    motion = player(machine)
    reasons = set()
    for _ in range(400):
        motion.jog(wish([0, 0, 1.5 * machine.motion.linear.speed, 0, 0, 0]))
        motion.step()
        reasons.add(motion.status.reason)
    assert motion.status.mode == 'jog'
    assert any('scaled to' in reason for reason in reasons)
    assert len(reasons) <= 400 * DT / 0.5 + 1


@pytest.mark.parametrize('name', MACHINES)
def test_twist_is_the_pivots_in_the_axes_of_its_frame(name):
    machine = MACHINES[name]
    motion, frames = player(machine), machine.frames
    size = 0.3 * machine.motion.linear.speed
    start = frames.platform(motion.state.pose)
    run(motion, 60, wish([size, 0, 0, 0, 0, 0]))
    run(motion, 30)
    shift = start.twist_to(frames.platform(motion.state.pose))
    assert shift[0] > 0.3 * size
    assert np.abs(shift[1:]).max() < 0.02 * shift[0]
    before = motion.state.pose
    run(motion, 60, wish([0, 0, 0, 0, 0, 0.3 * machine.motion.angular.speed], frame='tool'))
    run(motion, 30)
    shift = before.twist_to(motion.state.pose)
    assert np.linalg.norm(shift[3:]) > 0.01
    assert np.linalg.norm(shift[:3]) < 2e-3 * np.linalg.norm(shift[3:])


def test_jog_brakes_the_plan_along_its_way_and_drops_it():
    machine = MACHINES['robocake']
    motion = player(machine)
    home = machine.kinematics.home
    motion.pursue(Goal(home.moved([0.012, 0.006, 0, 0, 0, 0]), 7.0))
    poses, joints = run(motion, 15)
    seen = []
    for _ in range(60):
        motion.jog(wish([0, 0, 0.02, 0, 0, 0]))
        poses.append(motion.step())
        joints.append(motion.joints)
        seen.append(motion.status)
    assert ('stopped', 7.0, f'{JOY} took the machine over') in [
        (s.result, s.goal_stamp, s.reason) for s in seen
    ]
    check_limits(machine, poses, joints)
    for pose in poses:
        shift = pose.position - home.position
        assert shift[1] == pytest.approx(shift[0] / 2, abs=1e-9)
    rest, _ = run(motion, 100)
    assert np.abs(rest[-1].twist_to(rest[-30])).max() == 0.0
    assert (motion.status.mode, motion.status.result) == ('hold', 'idle')


def test_goals_and_cycles_are_refused_during_a_jog_and_taken_after_it():
    machine = MACHINES['robocake']
    motion = player(machine)
    run(motion, 5, wish([0, 0, 0.01, 0, 0, 0]))
    goal = Goal(machine.kinematics.home, 3.0)
    with pytest.raises(Refused, match='cmd_vel/joy has the machine'):
        motion.pursue(goal)
    with pytest.raises(Refused, match='cmd_vel/joy has the machine'):
        motion.start_cycle(Cycle(machine.kinematics.home, [0.001] * 6, [0.5] * 6, [0] * 6))
    motion.jog(None)
    motion.pursue(goal)
    run(motion, 100)
    assert (motion.status.result, motion.status.goal_stamp) == ('reached', 3.0)


def test_paused_jog_stands_still_and_says_so():
    machine = MACHINES['robocake']
    motion = player(machine)
    motion.pause(True)
    poses, _ = run(motion, 20, wish([0, 0, 0.01, 0, 0, 0]))
    assert np.abs(poses[0].twist_to(poses[-1])).max() == 0.0
    assert 'paused' in motion.status.reason


def test_mode_that_makes_no_sense_stands_still_and_says_why():
    machine = MACHINES['arm_6r']
    motion = player(machine)
    here = jog_mode('look_at', Feedback.for_delay(0.0), machine.kinematics.home.position)
    poses, _ = run(motion, 20, wish([0.1, 0, 0, 0, 0, 0], here))
    assert np.abs(poses[0].twist_to(poses[-1])).max() < 1e-12
    assert 'look-at point' in motion.status.reason


def test_arm_beyond_its_range_moves_only_towards_it():
    machine = MACHINES['arm_6r']
    beyond = np.radians([0.0, 20.0, 80.0, 0.0, 125.0, 0.0])
    pose = machine.kinematics.forward(beyond).pose
    made = Player(machine, pose, beyond, DT)
    made.pursue(Goal(machine.kinematics.home, 1.0))
    _, joints = run(made, 500)
    assert made.status.result == 'reached'
    assert np.array(joints)[:, 4].max() <= beyond[4] + 1e-6
    for sign in (1, -1):
        made = Player(machine, pose, beyond, DT)
        _, joints = run(made, 100, wish([0, 0, 0, 0.5 * sign, 0, 0]))
        assert np.array(joints)[:, 4].max() <= beyond[4] + 1e-6


@pytest.mark.parametrize('name', [name for name in PLATFORMS if name.startswith('stewart')])
def test_platform_beyond_a_limit_is_driven_back_but_not_further(name):
    machine = MACHINES[name]
    motion = player(machine)
    up = [0, 0, 1, 0, 0, 0] * np.array(machine.motion.linear.speed)
    run_to_the_edge(motion, wish(up))
    run(motion, 30)
    pose = motion.state.pose.moved([0, 0, 1e-5, 0, 0, 0])
    joints = machine.kinematics.inverse_or_nan(pose, motion.joints)
    assert not machine.constraints.admits(pose, joints)
    beyond = Player(machine, pose, joints, DT)
    poses, _ = run(beyond, 20, wish(up))
    assert poses[-1].position[2] <= pose.position[2] + 1e-9
    poses, _ = run(beyond, 50, wish(-up))
    assert poses[-1].position[2] < pose.position[2] - 1e-4
