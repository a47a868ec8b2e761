"""Paths: worked out beside the motion, then driven; a newer command takes their place."""

import re

import numpy as np
import pytest

from manipulator.errors import InvalidInput, Refused
from manipulator.planning.goal import Goal
from manipulator.planning.path import Tolerance
from manipulator.planning.path_timing import PathRequest
from manipulator.pose import Pose
from manipulator.trajectory.motion_status import OVERTAKEN
from manipulator.trajectory.path_planning import PathGoal

HIGHER = Pose.from_xyz_rpy((0.0, 0.0, 0.0452))
FAR = Pose.from_xyz_rpy((0.008, 0.0, 0.045))
RADIUS, HEIGHT = 0.004, 0.043
TOLERANCE = Tolerance(1e-4, 1e-3)


def circle(count=60, radius=RADIUS, height=HEIGHT):
    angle = np.linspace(0.0, 2 * np.pi, count)
    ring = [radius * np.cos(angle), radius * np.sin(angle), np.full(count, height)]
    return Pose(np.stack(ring, axis=1), np.eye(3))


def path(poses, stamp=3.0, is_of_platform=True, reads=None):
    """reads: gets the stamp of each path that is worked out."""

    def read():
        if reads is not None:
            reads.append(stamp)
        return PathRequest(poses, 0.02, TOLERANCE)

    return PathGoal(stamp, read, is_of_platform)


def heights(stage, since):
    return np.array([pose.position for pose in stage.setpoints[since:]])


def test_a_path_is_planned_approached_and_driven(slow):
    slow.follow(path(circle()))
    slow.run(2000)
    assert slow.status.result == 'reached'
    assert [s.result for s in slow.statuses if s.goal_stamp == 3.0][:2] == ['planning', 'moving']
    assert 'path' in {s.mode for s in slow.statuses}
    on_path = heights(slow, 0)
    on_path = on_path[np.abs(on_path[:, 2] - HEIGHT) < 1e-9]
    radii = np.hypot(on_path[:, 0], on_path[:, 1])
    assert radii == pytest.approx(RADIUS, abs=3e-4)
    assert np.ptp(np.unwrap(np.arctan2(on_path[:, 1], on_path[:, 0]))) > 0.98 * 2 * np.pi


def test_poses_of_the_platform_are_turned_into_those_of_the_pivot(slow):
    slow.core.supervisor.set_pivot([0.0, 0.0, 0.01])
    slow.run(2)
    slow.follow(path(circle()))
    slow.run(2000)
    assert slow.pose.position[2] == pytest.approx(HEIGHT)
    slow.follow(path(circle(height=HEIGHT + 0.01), is_of_platform=False))
    slow.run(2000)
    assert slow.status.result == 'reached'
    assert slow.pose.position[2] == pytest.approx(HEIGHT)


def test_a_path_of_one_place_is_a_goal(slow):
    slow.follow(path(Pose(np.tile(HIGHER.position, (5, 1)), np.eye(3))))
    slow.run(300)
    assert (slow.status.result, slow.status.mode) == ('reached', 'hold')
    assert np.abs(slow.pose.twist_to(HIGHER)).max() < 1e-9


@pytest.mark.parametrize(
    ('poses', 'reason'), [(circle(radius=0.05), r'pose \d+.*leg'), (None, 'pose 2: y is nan')]
)
def test_a_path_that_cannot_be_driven_is_refused_and_nothing_moves(slow, poses, reason):
    def read():
        if poses is None:
            raise InvalidInput('pose 2: y is nan')
        return PathRequest(poses, 0.02, TOLERANCE)

    slow.follow(PathGoal(3.0, read, is_of_platform=True))
    slow.run(30)
    (refused,) = [s for s in slow.statuses if s.result == 'refused']
    assert refused.goal_stamp == 3.0
    assert re.search(reason, refused.reason)
    assert np.abs(slow.pose.twist_to(slow.machine.kinematics.home)).max() < 1e-9


def test_a_newer_goal_takes_its_place(slow):
    reads = []
    slow.follow(path(circle(), reads=reads))
    slow.run(2)
    slow.pursue(Goal(HIGHER, 4.0))
    slow.run(300)
    overtaken = [s for s in slow.statuses if s.reason == OVERTAKEN]
    assert [(s.result, s.goal_stamp) for s in overtaken] == [('stopped', 3.0)]
    assert (slow.status.result, slow.status.goal_stamp) == ('reached', 4.0)
    assert 'path' not in {s.mode for s in slow.statuses}
    assert reads == []


def test_a_newer_path_takes_its_place(slow):
    reads = []
    slow.follow(path(circle(), 3.0, reads=reads))
    slow.run(2)
    slow.follow(path(circle(radius=0.002), 4.0, reads=reads))
    slow.run(2000)
    assert (slow.status.result, slow.status.goal_stamp) == ('reached', 4.0)
    assert reads == [4.0]
    older = [(s.result, s.reason) for s in slow.statuses if s.goal_stamp == 3.0]
    assert older == [('planning', ''), ('stopped', OVERTAKEN)]


def test_a_path_that_a_newer_goal_has_overtaken_does_not_displace_it(slow):
    slow.pursue(Goal(HIGHER, 100.2))
    slow.run(2)
    with pytest.raises(Refused, match=r'stamped 0\.200 s before the last goal or path'):
        slow.follow(path(circle(), 100.0))
    slow.run(300)
    assert (slow.status.result, slow.status.goal_stamp) == ('reached', 100.2)


@pytest.mark.parametrize(('stamp', 'ticks'), [(99.0, 2), (100.0, 60), (0.0, 2)])
def test_a_path_with_the_stamp_of_another_clock_or_none_is_driven(slow, stamp, ticks):
    slow.pursue(Goal(HIGHER, 100.2))
    slow.run(ticks)
    slow.follow(path(circle(), stamp))
    slow.run(2000)
    assert (slow.status.result, slow.status.goal_stamp) == ('reached', stamp)


@pytest.mark.parametrize(
    ('end', 'reason'),
    [
        ('stop', 'stopped before it began'),
        ('fault', 'the machine is fault: clear the fault first'),
        ('jog', 'cmd_vel/joy took over the machine'),
    ],
)
@pytest.mark.parametrize('is_moving', [False, True])
def test_what_ends_the_motion_ends_the_path_before_it_began(slow, end, reason, is_moving):
    if is_moving:
        slow.pursue(Goal(FAR, 2.0))
        slow.run(10)
        assert slow.status.result == 'moving'
    slow.follow(path(circle()))
    slow.run(1)
    if end == 'stop':
        slow.core.stop()
    elif end == 'fault':
        slow.state = 'fault'
    else:
        slow.core.teleop.receive('cmd_vel/joy', np.zeros(6) + 1e-4, '', slow.now)
    slow.run(10)
    slow.state = 'enabled'
    slow.run(300)
    results = {s.result: s.reason for s in slow.statuses if s.goal_stamp == 3.0}
    assert results == {'planning': '', 'stopped': reason}


def test_a_stop_at_rest_is_the_last_that_is_reported_of_the_path(slow):
    slow.follow(path(circle()))
    slow.run(1)
    slow.core.stop()
    slow.run(10)
    assert [(s.result, s.goal_stamp) for s in slow.statuses if s.result == 'stopped'] == [
        ('stopped', 3.0)
    ]


def test_a_path_while_somebody_jogs_is_refused(slow):
    slow.core.teleop.receive('cmd_vel/joy', np.full(6, 1e-3), '', slow.now)
    slow.run(2)
    with pytest.raises(Refused, match='cmd_vel/joy controls the machine'):
        slow.follow(path(circle()))


def test_a_path_that_comes_too_early_is_driven_once_the_machine_is_taken_over(slow):
    slow.is_followed = False
    slow.tick()
    reads = []
    slow.follow(path(circle(), reads=reads))
    slow.run(20)
    assert reads == []
    slow.is_followed = True
    slow.run(2000)
    assert (slow.status.result, slow.refusals) == ('reached', [])


def test_a_path_for_which_the_worker_has_no_room_is_refused(slow, monkeypatch):
    def refuse(task):
        raise Refused('8 plans wait already: try again')

    monkeypatch.setattr(slow.worker, 'submit', refuse)
    slow.follow(path(circle()))
    slow.run(5)
    assert (slow.status.result, slow.status.goal_stamp) == ('refused', 3.0)
    assert 'plans wait already' in slow.status.reason


def test_a_controller_that_is_closed_gives_its_path_up(slow):
    reads = []
    slow.follow(path(circle(), reads=reads))
    slow.core.close()
    slow.run(5)
    assert reads == []
