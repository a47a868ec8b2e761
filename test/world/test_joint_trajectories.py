"""Joint trajectories as joint_trajectory_controller takes them: stamps, some joints, refusals."""

import re

import numpy as np
import pytest

from manipulator.planning.joint_points import JointPoint
from world.world import World

DT = 0.01
TICK = 1.01 * DT


def smooth(begin, end, duration, count=9, since=0.0):
    """Points of a quintic from rest to rest, whose times begin at `since`."""
    begin, end = np.array(begin), np.array(end)
    s = np.linspace(0.0, 1.0, count)
    x = 10 * s**3 - 15 * s**4 + 6 * s**5
    v = (30 * s**2 - 60 * s**3 + 30 * s**4) / duration
    a = (60 * s - 180 * s**2 + 120 * s**3) / duration**2
    way = end - begin
    return [
        JointPoint(since + duration * t, list(begin + way * i), list(way * j), list(way * k))
        for t, i, j, k in zip(s, x, v, a, strict=True)
    ]


def at(points, time):
    """Positions at a time of points as `smooth` makes them, by their own formula."""
    begin, end = np.array(points[0].positions), np.array(points[-1].positions)
    s = np.clip((time - points[0].time) / (points[-1].time - points[0].time), 0.0, 1.0)
    return begin + (end - begin) * (10 * s**3 - 15 * s**4 + 6 * s**5)


@pytest.fixture
def arm(make_world):
    """On stepper drives with encoders, whose play is none."""
    return make_world('arm_6r_stepper', hysteresis=0.0)


def send(world, names, points, starts_in=None):
    """Sends a trajectory; joints that are not named stay where they are."""
    known = world.machine.kinematics.joint_names
    joints = world.controller.supervisor.executor.joints
    rest = [name for name in known if name not in names]
    stay = [joints[known.index(name)] for name in rest]
    still = [0.0] * len(rest)

    def whole(point):
        rows = (point.velocities, point.accelerations)
        more = [[*row, *still] if len(row) else [] for row in rows]
        return JointPoint(point.time, [*point.positions, *stay], *more, point.effort)

    return world.send_trajectory([*names, *rest], list(map(whole, points)), starts_in)


def started(world, stamp):
    """When its motion was reported as begun."""
    moving = [
        t for t, s in world.controller.statuses if s.goal_stamp == stamp and s.result == 'moving'
    ]
    return moving[0]


@pytest.mark.parametrize('name', ['arm_6r_stepper', 'robocake', 'stewart_6_6'])
def test_a_trajectory_is_tracked_within_a_tick(make_world, name):
    world = make_world(name, hysteresis=0.0)
    begin = world.controller.supervisor.executor.joints
    names = world.machine.kinematics.joint_names
    low, high = world.machine.joint_ranges
    end = begin + 0.04 * np.minimum(high - low, 2 * np.pi) * [1, 1, -1, 1, -1, 1]
    points = smooth(begin, end, 3.0)
    stamp = world.send_trajectory(names, points)
    assert world.end_of(stamp).result == 'reached'
    begun = started(world, stamp)
    rows = [(t - begun, q) for t, q in world.controller.requested]
    for time, joints in rows:
        ahead, behind = at(points, time + TICK), at(points, time - TICK)
        slack = 1e-5 * np.ones(6)
        assert (joints <= np.maximum(ahead, behind) + slack).all()
        assert (joints >= np.minimum(ahead, behind) - slack).all()
    assert len(rows) >= 290
    world.run(0.3)
    assert np.abs(rows[-1][1] - end).max() < 1e-3
    assert np.abs(world.joints - end).max() < 0.01


def test_names_come_in_any_order(arm):
    before = arm.joints
    points = smooth([before[5], before[1]], [0.3, before[1] + 0.2], 2.0)
    assert arm.end_of(send(arm, ('joint_6', 'joint_2'), points)).result == 'reached'
    arm.run(0.3)
    expected = before.copy()
    expected[[5, 1]] = 0.3, before[1] + 0.2
    assert np.abs(arm.joints - expected).max() < 2e-3


def test_points_without_velocities_are_joined_by_lines_with_rounded_corners(arm):
    points = [JointPoint(1.0, [0.1]), JointPoint(2.0, [0.3]), JointPoint(3.0, [0.0])]
    stamp = send(arm, ('joint_1',), points)
    assert arm.end_of(stamp).result == 'reached'
    begun = started(arm, stamp)
    times = np.array([t - begun for t, _ in arm.controller.requested])
    angles = np.array([q[0] for _, q in arm.controller.requested])
    middle = (times > 1.4) & (times < 1.8)
    assert np.abs(np.diff(angles[middle]) / DT - 0.2).max() < 1e-6
    limit = arm.machine.motion.for_plans.joint.acceleration
    assert (np.abs(np.diff(angles, 2)) / DT**2 <= 1.02 * np.broadcast_to(limit, 6)[0]).all()
    assert angles.max() == pytest.approx(0.3, abs=0.03)


def test_a_trajectory_begins_at_the_time_of_its_stamp(arm):
    asked = arm.now
    points = smooth([0.0], [0.3], 2.0)
    stamp = send(arm, ('joint_1',), points, starts_in=0.7)
    assert arm.end_of(stamp).result == 'reached'
    assert started(arm, stamp) == pytest.approx(asked + 0.7, abs=TICK)


def test_what_is_left_of_a_trajectory_that_began_earlier_is_executed_by_its_times(arm):
    asked = arm.now
    points = [*smooth([0.0], [0.05], 0.5), *smooth([0.05], [0.3], 2.0, since=1.5)]
    stamp = send(arm, ('joint_1',), points, starts_in=-0.6)
    assert arm.end_of(stamp).result == 'reached'
    for time, joints in arm.controller.requested:
        if time > asked + 0.95:
            expected = at(points[9:], time - asked + 0.6)[0]
            assert joints[0] == pytest.approx(expected, abs=2e-3)


def test_a_newer_trajectory_begins_where_the_older_one_was_braked(arm):
    first = send(arm, ('joint_1',), smooth([0.0], [0.5], 3.0))
    arm.run(1.2)
    second = send(arm, ('joint_1',), [JointPoint(2.5, [0.0], [0.0])])
    assert arm.end_of(second).result == 'reached'
    ends = [s for _, s in arm.controller.statuses if s.goal_stamp == first]
    assert (ends[-1].result, ends[-1].reason) == ('stopped', 'replaced by a newer trajectory')
    angles = np.array([q[0] for _, q in arm.controller.requested])
    assert np.abs(np.diff(angles)).max() < 0.5 * DT
    arm.run(0.3)
    assert arm.joints[0] == pytest.approx(0.0, abs=2e-3)


def test_a_bad_trajectory_does_not_stop_the_one_that_is_executed(arm):
    good = send(arm, ('joint_1',), smooth([0.0], [0.3], 3.0))
    arm.run(1.0)
    bad = arm.send_trajectory(('joint_1', 'joint_1'), [JointPoint(1.0, [0.1, 0.1])])
    assert arm.end_of(bad).result == 'refused'
    assert arm.status.mode == 'path'
    assert arm.end_of(good).result == 'reached'


def test_a_goal_takes_the_place_of_a_trajectory_that_waits_for_its_time(arm):
    stamp = send(arm, ('joint_1',), smooth([0.0], [0.5], 3.0), starts_in=1.0)
    arm.run(0.3)
    assert arm.status.result == 'planning'
    assert arm.end_of(arm.send_goal_joints(joint_6=0.1)).result == 'reached'
    arm.run(1.5)
    results = [s.result for _, s in arm.controller.statuses if s.goal_stamp == stamp]
    assert results[-1] == 'stopped'
    assert arm.joints[0] == pytest.approx(0.0, abs=2e-3)


def test_a_stop_brakes_on_the_trajectory(arm):
    stamp = send(arm, ('joint_1', 'joint_2'), smooth([0.0, 0.35], [0.5, 0.1], 3.0))
    arm.timeline.after(1.5, arm.controller.core.stop)
    assert arm.end_of(stamp).result == 'stopped'
    rows = np.array([q for _, q in arm.controller.requested])
    way = rows[-1] - rows[0]
    share = (rows - rows[0]) @ way / (way @ way)
    assert np.abs(rows - rows[0] - share[:, None] * way).max() < 1e-3


STILL, ONE = [0.0], ('joint_1',)


@pytest.mark.parametrize(
    ('names', 'points', 'starts_in', 'reason'),
    [
        ((), [JointPoint(1.0, [])], None, 'no joint is named, needs some of joint_1, '),
        (('joint_9',), [JointPoint(1.0, [0.1])], None, "joint 'joint_9' is unknown"),
        (('joint_1', 'joint_1'), [JointPoint(1.0, [0.1, 0.1])], None, 'joint_1 is named twice'),
        (
            ('joint_1', 'joint_2'),
            [JointPoint(1.0, [0.1, 0.1])],
            None,
            'joint joint_3 is missing, needs all of joint_1, ',
        ),
        (('joint_1',), [], None, 'a trajectory of 0 points, needs 1 to 2,000'),
        (
            ('joint_1',),
            [JointPoint(1.0, [0.1, 0.2])],
            None,
            'point 1: 7 numbers in positions for 6 joints',
        ),
        (
            ('joint_1',),
            [JointPoint(1.0, [0.1]), JointPoint(1.0, [0.2])],
            None,
            'point 2: time_from_start is 1 s, that of the point before 1 s: it must increase',
        ),
        (
            ('joint_1',),
            [JointPoint(-0.5, [0.1])],
            None,
            'point 1: time_from_start is -0.5 s, needs at least 0',
        ),
        (
            ('joint_1',),
            [JointPoint(1.0, [0.1], effort=[1.0])],
            None,
            'point 1: effort is not supported',
        ),
        (
            ('joint_1',),
            [JointPoint(2000.0, [0.1])],
            None,
            'the trajectory would take 2000 s, at most 1000 s',
        ),
        (
            ('joint_1',),
            [JointPoint(1.0, [float('nan')])],
            None,
            'point 1: positions of joint_1 is nan, needs a finite number',
        ),
        (
            ('joint_1',),
            [JointPoint(1.0, [0.1], STILL), JointPoint(2.0, [0.2])],
            None,
            'point 2 has no velocities, others have: give all or none',
        ),
        (
            ('joint_1',),
            [JointPoint(1.0, [0.1], [0.2])],
            None,
            'the last point: velocity of joint_1 is 0.2, needs 0',
        ),
        (
            ('joint_1',),
            smooth([0.4], [0.5], 2.0),
            None,
            'joint_1 is at 0 rad, the trajectory begins at 0.4 rad: at most 0.0087 rad away',
        ),
        (
            ('joint_1',),
            smooth([0.0], [2.0], 0.5),
            None,
            r's after the start, before point \d: .* would be too high: .* times as much time',
        ),
        (
            ('joint_1',),
            [JointPoint(1.0, [9.0], STILL)],
            None,
            r'joint 1: joint angle .* outside \[',
        ),
        (
            ('joint_1',),
            smooth([0.0], [0.2], 2.0),
            -5.0,
            r'the trajectory ended 3\.\d+ s ago, by its stamps',
        ),
    ],
)
def test_a_bad_trajectory_is_refused_by_name_nothing_moves_and_the_next_one_works(
    arm, names, points, starts_in, reason
):
    since = arm.now
    sent = send if names == ONE else World.send_trajectory
    refused = arm.end_of(sent(arm, names, points, starts_in))
    assert refused.result == 'refused'
    assert re.search(reason, refused.reason), refused.reason
    assert arm.moved(since) <= 1.0
    good = send(arm, ('joint_1',), smooth([0.0], [0.05], 1.0))
    assert arm.end_of(good).result == 'reached'


def test_a_platform_refuses_joints_that_do_not_fit_together_on_the_way(make_world):
    world = make_world('robocake')
    since = world.now
    begin = world.controller.supervisor.executor.joints
    names = world.machine.kinematics.joint_names
    apart = np.array([1.4, 1.4, -1.4, -1.4, 0.0, 0.0])
    points = smooth(begin, begin + apart, 6.0)
    refused = world.end_of(world.send_trajectory(names, points))
    assert refused.result == 'refused'
    assert 'on the trajectory: forward kinematics found no pose' in refused.reason
    assert world.moved(since) <= 1.0


def test_a_trajectory_may_begin_with_its_full_acceleration(arm):
    """As planners make them: an acceleration that falls as a cosine from the first point on."""
    begin, duration = arm.joints[5], 0.6
    pull = 0.97 * arm.machine.motion.for_plans.angular.acceleration
    times = np.linspace(0.0, duration, 13)
    phase, rate = np.pi * times / duration, np.pi / duration
    rows = zip(
        times.tolist(),
        (begin + pull / rate**2 * (1 - np.cos(phase))).tolist(),
        (pull / rate * np.sin(phase)).tolist(),
        (pull * np.cos(phase)).tolist(),
        strict=True,
    )
    points = [JointPoint(t, [q], [v], [a]) for t, q, v, a in rows]
    assert arm.end_of(send(arm, ('joint_6',), points)).result == 'reached'
    arm.run(0.3)
    assert arm.joints[5] == pytest.approx(begin + 2 * pull / rate**2, abs=2e-3)
