"""Machines do not meet themselves, nor what stands around them: floor, boxes, a workspace."""

import re
from dataclasses import dataclass

import numpy as np
import pytest

from hexarm import machines
from hexarm.machine_check import problems_of
from manipulator import _kernel
from manipulator.analysis.nearest import nearest_reachable
from manipulator.analysis.reach import reach
from manipulator.analysis.travel import travel
from manipulator.errors import ConfigError, Refused, Unreachable
from manipulator.framed_machine import in_frames
from manipulator.frames import Frames
from manipulator.limits.clearance import Clearance
from manipulator.limits.surroundings import (
    BodiesConfig,
    BoxConfig,
    SurroundingsConfig,
)
from manipulator.machine import Machine
from manipulator.planning.goal import Goal, Motion
from manipulator.planning.nearest_goal import NearestGoal
from manipulator.planning.plan import MotionState
from manipulator.planning.planner import plan_goal
from manipulator.planning.start import Start
from manipulator.planning.worker import Effort
from manipulator.pose import Pose
from manipulator.teleop.jogger import JogMotion
from manipulator.teleop.joint_jogger import JointJogger, JointMotion

DT = 0.01
SHARES = np.linspace(0.0, 1.0, 101)
FRAMES = Frames(Pose.from_xyz_rpy([0.01, 0.02, 0.0], [0.0, 0.0, 0.6])).with_pivot(
    [0.0, 0.01, 0.03]
)
AXES = {'arm_6r': 1, 'robocake': 2, 'stewart_6_6': 2, 'stack_6_6': 2}
"""Of the base frame, along which a wall stands before the machine."""
GAPS = {'arm_6r': 0.04, 'robocake': 0.003, 'stewart_6_6': 0.003, 'stack_6_6': 0.006}
"""Metres from the machine at home to it."""


def front(machine, axis, pose, joints):
    """How far (...) along an axis everything is that moves, lines without thickness."""
    bodies = machine.make_bodies(BodiesConfig())
    segments = bodies.segments(pose, joints)[..., bodies.moving, :]
    return segments[..., [axis, axis + 3]].max(axis=(-1, -2))


@dataclass(frozen=True)
class Walled:
    """A machine before a wall; gap in metres from home."""

    machine: Machine
    axis: int
    gap: float
    wall: float

    def moved(self, share):
        """Home moved by a share of the gap."""
        return self.machine.kinematics.home.moved(share * self.gap * np.eye(6)[self.axis])

    def room(self, pose, joints):
        """Metres left to the wall."""
        return self.wall - front(self.machine, self.axis, pose, joints)


def walled(name):
    machine, axis, gap = machines.load(name), AXES[name], GAPS[name]
    home = machine.kinematics.home
    wall = gap + float(front(machine, axis, home, machine.kinematics.inverse(home)))
    corners = np.array([[-5e3] * 3, [5e3] * 3])
    corners[0, axis] = 1e3 * wall
    box = BoxConfig('wall', tuple(map(tuple, corners.tolist())))
    surroundings = SurroundingsConfig(boxes=(box,))
    return Walled(machine.among(surroundings, BodiesConfig()), axis, gap, wall)


def start_of(machine):
    home = machine.kinematics.home
    return Start(MotionState.at_rest(home), machine.kinematics.inverse(home), DT)


def points_of(segment):
    """Points (..., 101, 3) of segments (..., 6)."""
    start, end = segment[..., None, :3], segment[..., None, 3:]
    return start + SHARES[:, None] * (end - start)


def sampled_distance(one, other):
    """The least between points of two segments, at most half of a step too much."""
    return np.linalg.norm(points_of(one)[:, None] - points_of(other), axis=-1).min()


def test_distances_of_segments_are_the_least_of_their_points():
    rng = np.random.default_rng(1)
    pairs = rng.normal(size=(2, 120, 6))
    pairs[1, :30] = pairs[0, :30] + 0.3  # parallel ones
    pairs[0, 30:60, 3:] = pairs[0, 30:60, :3]  # points
    pairs[0, 60:90, :3] = pairs[1, 60:90, 3:]  # joined ones
    found = np.empty(120)
    _kernel.segment_distance(*pairs, found)
    sampled = np.array([sampled_distance(*two) for two in zip(*pairs, strict=True)])
    assert (found <= sampled + 1e-12).all()
    assert (sampled - found).max() < 0.06
    np.testing.assert_allclose(found[60:90], 0.0, atol=1e-9)
    np.testing.assert_allclose(found[:30] <= np.sqrt(3) * 0.3 + 1e-12, True)


@pytest.mark.parametrize('side', [1.0, -1.0])
def test_clearances_of_boxes_are_the_least_of_the_points_signed(side):
    rng = np.random.default_rng(2)
    segments, size = rng.normal(scale=1.5, size=(400, 6)), np.array([1.0, 0.5, 2.0])
    box = np.concatenate([[side], -size, size])
    found = np.empty(400)
    _kernel.box_clearance(segments, np.tile(box, (400, 1)), found)
    inside = (size - np.abs(points_of(segments))).min(axis=-1)
    if side > 0:
        expected = inside.min(axis=-1)
    else:
        nearest = points_of(segments).clip(-size, size)
        outside = np.linalg.norm(points_of(segments) - nearest, axis=-1)
        expected = np.where(outside > 0, outside, -inside).min(axis=-1)
        assert (found <= expected + 1e-8).all()
    np.testing.assert_allclose(found, expected, atol=1e-9 if side > 0 else 0.08)


def test_what_is_not_known_is_no_clearance():
    segment, out = np.full(6, np.nan), np.empty(1)
    segment[:3] = 0.0
    _kernel.segment_distance(segment, np.arange(6.0), out)
    assert np.isnan(out)
    _kernel.box_clearance(segment, np.array([1.0, -9, -9, -9, 9, 9, 9]), out)
    assert np.isnan(out)


@pytest.mark.parametrize('name', AXES)
def test_a_goal_that_would_meet_the_wall_is_refused_and_says_what_meets_it(name):
    walled_in = walled(name)
    machine, start = walled_in.machine, start_of(walled_in.machine)
    with pytest.raises((Unreachable, Refused), match=r'meets the box wall by \d+(\.\d+)? mm'):
        plan_goal(machine, start, Goal(walled_in.moved(1.5)), Effort())
    plan = plan_goal(machine, start, Goal(walled_in.moved(0.9)), Effort())
    poses = plan.at(np.linspace(0.0, plan.duration, 50)).pose
    joints = machine.kinematics.inverse_along(poses, start.joints)
    assert (walled_in.room(poses, joints) >= -1e-9).all()


def test_a_line_and_a_joint_move_through_a_box_are_refused():
    machine = machines.load('arm_6r')
    kinematics = machine.kinematics
    joints, turn = kinematics.inverse(kinematics.home), np.radians([50.0, 0, 0, 0, 0, 0])
    across = kinematics.forward(joints + turn).pose
    for motion, at in (
        (Motion.JOINT, kinematics.forward(joints + turn / 2).pose.position),
        (Motion.LINE, (kinematics.home.position + across.position) / 2),
    ):
        box = BoxConfig('post', centre_mm=tuple(1e3 * at), size_mm=(60.0, 60.0, 60.0))
        beside = machine.among(SurroundingsConfig(boxes=(box,)), BodiesConfig())
        with pytest.raises(Refused, match='meets the box post by'):
            plan_goal(beside, start_of(beside), Goal(across, motion=motion), Effort())


@pytest.mark.parametrize('frames', [Frames(), FRAMES], ids=['plain', 'framed'])
@pytest.mark.parametrize('name', AXES)
def test_jogs_brake_before_the_wall_and_lead_back(name, frames):
    walled_in = walled(name)
    driven = in_frames(walled_in.machine, frames)
    speed = 0.1 if name == 'arm_6r' else 0.02
    to_wall = np.zeros(6)
    to_wall[:3] = frames.T_base_work.rotation.T @ (speed * np.eye(3)[walled_in.axis])
    jogger, home = driven.make_jogger(driven), driven.kinematics.home
    motion = JogMotion.at_rest(home, driven.kinematics.inverse(home))
    most = driven.motion.linear.acceleration * DT * 1.1
    for _ in range(120):
        before, motion = motion, jogger.step(motion, to_wall, DT)
        room = walled_in.room(frames.platform(motion.pose), motion.joints)
        assert room >= -1e-9
        assert np.linalg.norm((motion.twist - before.twist)[:3]) <= most
    assert motion.held_by.endswith('meets the box wall')
    assert np.linalg.norm(motion.twist) < 0.02 * speed
    assert room < 0.05 * walled_in.gap + 2e-4
    for _ in range(20):
        motion = jogger.step(motion, -to_wall, DT)
    assert motion.twist @ -to_wall > 0.1 * speed**2


def test_no_jog_drives_an_arm_into_boxes_or_itself():
    machine = machines.load('arm_6r')
    home, rng = machine.kinematics.home, np.random.default_rng(3)
    x, y, z = 1e3 * home.position
    boxes = (
        BoxConfig('left', centre_mm=(x, y + 180, z), size_mm=(200.0, 100.0, 400.0)),
        BoxConfig('low', centre_mm=(x + 100, y, z - 200), size_mm=(200.0, 300.0, 100.0)),
    )
    machine = machine.among(
        SurroundingsConfig(0.0, boxes), BodiesConfig((80.0,) * 5 + (40.0,) * 2)
    )
    jogger = machine.make_jogger(machine)
    motion = JogMotion.at_rest(home, machine.kinematics.inverse(home))
    clearance = machine.constraints.limits[-1]
    met = set()
    for _ in range(40):
        twist = rng.normal(size=6) * [0.3, 0.3, 0.3, 1.0, 1.0, 1.0]
        for _ in range(60):
            motion = jogger.step(motion, twist, DT)
            assert (clearance.values(motion.pose, motion.joints) >= -1e-9).all()
        met.add(motion.held_by)
    assert any('meets' in words for words in met)


@pytest.mark.parametrize('name', ['arm_6r', 'robocake'])
def test_joint_jogs_stop_before_the_wall(name):
    walled_in = walled(name)
    machine = walled_in.machine
    kinematics, jogger = machine.kinematics, JointJogger(machine)
    joints = kinematics.inverse(kinematics.home)
    ahead = kinematics.inverse(walled_in.moved(1.0)) - joints
    motion = JointMotion.at_rest(kinematics.home, joints)
    for _ in range(300):
        motion = jogger.step(motion, 0.2 * ahead / np.abs(ahead).max(), DT)
        assert walled_in.room(motion.pose, motion.joints) >= -1e-9
    assert motion.held_by.endswith('meets the box wall')


@pytest.mark.parametrize('name', AXES)
def test_reach_and_the_nearest_pose_end_at_the_wall(name):
    walled_in = walled(name)
    machine = walled_in.machine
    refused = reach(machine, walled_in.moved(1.5))
    assert not refused.is_reachable
    assert 'meets the box wall' in str(refused.reason)
    nearest = nearest_reachable(machine, walled_in.moved(1.5)).pose
    room = walled_in.room(nearest, machine.kinematics.inverse(nearest))
    assert -1e-9 <= room < 0.2 * walled_in.gap


@pytest.mark.parametrize('name', AXES)
def test_streamed_goals_lead_up_to_the_wall(name):
    walled_in = walled(name)
    machine, start = walled_in.machine, start_of(walled_in.machine)
    home = machine.kinematics.home
    goal = NearestGoal(machine).reached(Goal(walled_in.moved(1.5)), home, start.joints)
    assert 'meets the box wall' in goal.note
    room = walled_in.room(goal.pose, machine.kinematics.inverse(goal.pose, start.joints))
    assert -1e-9 <= room < 0.2 * walled_in.gap


@pytest.mark.parametrize('name', AXES)
def test_streamed_goals_behind_the_wall_lead_along_it(name):
    walled_in = walled(name)
    machine, start = walled_in.machine, start_of(walled_in.machine)
    home, along = machine.kinematics.home, (walled_in.axis + 1) % 3
    goal = walled_in.moved(3.0).moved(2.0 * walled_in.gap * np.eye(6)[along])
    found = NearestGoal(machine).reached(Goal(goal), home, start.joints).pose
    assert walled_in.room(found, machine.kinematics.inverse(found, start.joints)) >= -1e-9
    assert abs(found.twist_to(goal)[along]) < 0.02 * walled_in.gap


def test_rods_and_platform_meet_only_where_they_are_given_a_thickness():
    machine = machines.load('robocake')
    thin = machine.among(SurroundingsConfig(), BodiesConfig())
    assert thin is machine
    thick = machine.among(SurroundingsConfig(), BodiesConfig(rod_diameter_mm=3.0))
    clearance = thick.constraints.limits[-1]
    assert all(re.fullmatch(r'rod \d meets rod \d', owner) for owner in clearance.owners)
    kinematics, home = machine.kinematics, machine.kinematics.home
    rng = np.random.default_rng(4)
    for _ in range(5):
        pose = home.moved(rng.uniform(-1, 1, 6) * [0.005, 0.005, 0.005, 0.1, 0.1, 0.1])
        joints = kinematics.inverse_or_nan(pose)
        if np.isnan(joints).any():
            continue
        ends = kinematics.base_points(joints), pose.transform(kinematics.geometry.platform_points)
        rods = np.concatenate(ends, axis=1)
        for owner, value in zip(clearance.owners, clearance.values(pose, joints), strict=True):
            one, other = (rods[int(leg) - 1] for leg in re.findall(r'\d', owner))
            assert value + 3e-3 == pytest.approx(sampled_distance(one, other), abs=3e-4)


def test_links_that_are_not_joined_may_not_meet():
    machine = machines.load('arm_6r')
    kinematics, bodies = machine.kinematics, BodiesConfig((80.0,) * 7)
    clearance = Clearance(machine.make_bodies(bodies), ())
    names = ['base', *(f'link {i}' for i in range(1, 6)), 'tool']
    pairs = [owner.split(' meets ') for owner in clearance.owners]
    assert not any(abs(names.index(a) - names.index(b)) == 1 for a, b in pairs)
    assert ['link 2', 'tool'] in pairs
    rng, (low, high) = np.random.default_rng(5), machine.joint_ranges
    for joints in rng.uniform(low, high, (20, 6)):
        pose = kinematics.forward(joints).pose
        line = kinematics.skeleton(pose, joints)[0].points
        links = dict(zip(names, np.hstack([line[:-1], line[1:]]), strict=True))
        found = clearance.values(pose, joints)
        for (a, b), value in zip(pairs, found, strict=True):
            assert value + 0.08 == pytest.approx(sampled_distance(links[a], links[b]), abs=6e-3)


def test_a_folded_arm_that_would_meet_itself_is_refused_by_name():
    machine = machines.load('arm_6r')
    home = machine.kinematics.inverse(machine.kinematics.home)
    thick = machine.among(SurroundingsConfig(), BodiesConfig((160.0,) * 7))
    _, high = machine.joint_ranges
    folded = np.array([home[0], home[1], high[2], 0.0, high[4], 0.0])
    pose = machine.kinematics.forward(folded).pose
    assert machine.constraints.admits(pose, folded)
    with pytest.raises(Unreachable, match=r'(link \d|base) meets (link \d|tool) by \d+'):
        thick.constraints.check(pose, folded)
    with pytest.raises(ConfigError, match='home: base meets tool by'):
        machine.among(SurroundingsConfig(), BodiesConfig((1200.0, *[5.0] * 5, 300.0)))


@pytest.mark.parametrize('name', AXES)
def test_travel_ends_at_the_wall(name):
    walled_in = walled(name)
    machine = walled_in.machine
    way = travel(machine, machine.kinematics.home, np.eye(6)[walled_in.axis])
    assert way.seconds == pytest.approx(walled_in.gap, abs=1e-7)
    assert 'meets the box wall' in way.reason


def test_a_machine_that_meets_something_already_may_move_away_alone():
    machine = machines.load('arm_6r')
    home = machine.kinematics.home
    joints = machine.kinematics.inverse(home)
    x, y, z = 1e3 * home.position
    tall = BoxConfig('post', centre_mm=(x, y + 45.0, z), size_mm=(80.0, 80.0, 80.0))
    posted = machine.among(SurroundingsConfig(boxes=(tall,)), BodiesConfig())
    inside = home.moved([0, 0.02, 0, 0, 0, 0])
    joints = machine.kinematics.inverse(inside, joints)
    jogger = posted.make_jogger(posted)
    for way, is_free in ((1.0, False), (-1.0, True)):
        motion = JogMotion.at_rest(inside, joints)
        for _ in range(20):
            motion = jogger.step(motion, np.array([0, way * 0.1, 0, 0, 0, 0]), DT)
        assert (abs(motion.pose.position[1] - inside.position[1]) > 0.005) == is_free


def test_bad_surroundings_are_named_all_at_once():
    text = machines.find('arm_6r').read_text()
    bad = (
        'surroundings: {floor: 3, boxes: [{name: a}, '
        '{name: b, centre_mm: [0, 0, 0], size_mm: [1, 1, 0]}]}\n'
        'bodies: {rod_diameter_mm: -1, link_diameters_mm: 5}\n'
    )
    assert problems_of(text + bad) == [
        "surroundings.floor: unknown key, did you mean 'floor_mm'?",
        'surroundings.boxes[0]: needs either corners_mm, or centre_mm and size_mm',
        'surroundings.boxes[1].size_mm[2]: 0 outside [0.001, 1e+06]',
        'bodies.link_diameters_mm: holds the number 5, needs a list',
        'bodies.rod_diameter_mm: -1 outside [0.001, 1e+06]',
    ]
    flat = (
        'surroundings: {workspace_mm: [[0, 0, 0], [9, 9, 0]], boxes: ['
        '{name: a, corners_mm: [[0, 0, 0], [1, 0, 1]]}, '
        '{name: " ", centre_mm: [0, 0, 0], size_mm: [1, 1, 1]}]}\n'
    )
    assert problems_of(text + flat) == [
        'surroundings.boxes[0]: corners_mm: has no size along y',
        'surroundings.boxes[1]: name: is empty',
    ]
    known = 'boxes: [{name: a, corners_mm: [[0, 0, 0], [1, 1, 1]]}]'
    assert problems_of(text + flat.replace('[1, 0, 1]', '[1, 1, 1]').replace('" "', 'b')) == [
        'surroundings: workspace_mm: has no size along z'
    ]
    assert problems_of(text + 'bodies: {link_diameters_mm: [1, 2]}\n') == [
        'bodies.link_diameters_mm: has 2 entries, needs 7'
    ]
    assert problems_of(
        text + f'surroundings: {{floor_mm: 900, {known}}}\nbodies: {{rod_diameter_mm: 3}}\n'
    ) == ['bodies.rod_diameter_mm: an arm has no such parts']
    meeting = problems_of(text + f'surroundings: {{floor_mm: 350, {known}}}\n')
    assert 'home: link 2 meets the floor by 50 mm' in meeting
    below = 'surroundings: {floor_mm: 200}\ntools: [{name: pole, xyz_mm: [0, 0, 300]}]\n'
    assert problems_of(text + below) == ['home: tool meets the floor by 13.6 mm']
