"""Every method of `Robot` refuses in words what it cannot use, and nothing is sent."""

from pathlib import Path

import numpy as np
import pytest

from hexarm import machines
from hexarm.robot import Robot
from manipulator.errors import InvalidInput
from manipulator.pose import Pose
from manipulator.saved_poses import SavedPose, SavedPoses

NAN, MANY = float('nan'), Pose.identity()[None]
POSES = (
    None,
    'up there',
    b'up',
    5,
    (1, 2),
    [],
    (0, 0, NAN),
    np.zeros((4, 4)),
    MANY,
    {},
    [None] * 3,
)
NUMBERS = (None, 'far', NAN, float('inf'), [], [1.0, 2.0], {})
NAMES = (None, 5, '9', 'a b', [], ('up',), b'up', 'x' * 41)
BY_NAME = (None, {}, 'a', ['joint_1'], [0.0] * 6, {1: 0.5}, {'joint_1': NAN}, {'joint_1': None})
GOAL = (0.0, 0.0, 0.3)


class Silent:
    """A client that may be asked where it is, and for nothing else."""

    def finish(self, timeout):
        pass

    def destination(self):
        return Pose.identity()

    def sent(self, *arguments):
        raise AssertionError('something was sent')

    begin = begin_path = change_saved_pose = use_tool = jog = jog_joints = sent


class Idle(Robot):
    """A Robot without a graph, and with a pose saved as `up`."""

    def __init__(self):
        self._machine = machines.load('arm_6r')
        self._client = Silent()

    @property
    def saved_poses(self):
        return SavedPoses.none_of(self._machine).with_pose('up', SavedPose(Pose.identity()))


def calls():
    """Method, arguments: what is bad one by one."""
    for bad in POSES:
        yield 'move_to', [bad], {}
        yield 'move_tool_to', [bad], {}
        yield 'reach', [bad], {}
        yield 'follow', [bad if bad is not MANY else [MANY]], {}
        yield 'follow', [[GOAL, bad]], {}
    yield 'follow', [[GOAL] * 2001], {}
    for bad in BY_NAME:
        yield 'move_joints', [bad], {}
        yield 'jog_joints', [bad], {}
    for bad in NUMBERS:
        yield 'move', [], {'x': bad}
        yield 'move_joints', [], {'joint_1': bad}
        yield 'jog', [], {'vx': bad}
        yield 'jog', [], {'vx': 0.01, 'seconds': bad}
        yield 'jog_joints', [], {'joint_1': 0.1, 'seconds': bad}
        yield 'wait', [bad], {}
        for name in ('home', 'park'):
            yield name, [], {'timeout': bad}
        for name, goal in (('move_to', GOAL), ('move_tool_to', GOAL), ('follow', [GOAL])):
            yield name, [goal], {'timeout': bad}
        yield 'replay', ['up'], {'repeat': bad}
        if bad is not None:
            yield 'move_to', [GOAL], {'speed': bad}
            yield 'follow', [[GOAL]], {'speed': bad}
            yield 'replay', ['up'], {'speed': bad}
            yield 'replay', ['up'], {'pause': bad}
    for bad in (0.0, -1.0):
        yield 'move_to', [GOAL], {'speed': bad}
        yield 'jog', [], {'vx': 0.01, 'seconds': bad}
        yield 'home', [], {'timeout': bad}
    for bad in NAMES:
        yield 'save_pose', [bad], {}
        yield 'delete_pose', [bad], {}
        yield 'use_tool', [bad], {}
        yield 'replay', [bad], {}
    for bad in (None, 5, 'moon', []):
        yield 'jog', [], {'vx': 0.01, 'frame': bad}
    for name, good in (('move_to', [GOAL]), ('follow', [[GOAL]]), ('replay', ['up'])):
        yield name, good, {'progress': 'often'}
    for name in ('move', 'move_joints', 'jog', 'jog_joints', 'replay'):
        yield name, [], {}


def test_every_method_refuses_bad_input_in_words_and_sends_nothing():
    robot, wrong = Idle(), []
    for name, arguments, named in calls():
        if name == 'move' and named == {'x': None}:
            continue
        try:
            getattr(robot, name)(*arguments, **named)
            found = 'accepted'
        except InvalidInput as error:
            found = '' if len(str(error)) > 10 else f'says only {error}'
        except (TypeError, ValueError, AttributeError, AssertionError) as error:
            found = repr(error)
        if found:
            wrong.append(f'{name}(*{arguments}, **{named}): {found}'[:200])
    assert not wrong, '\n'.join(wrong)


@pytest.mark.parametrize('bad', [None, 5, '', 'a b', b'arm', []])
def test_a_namespace_and_a_machine_are_checked_before_ros_starts(bad):
    with pytest.raises(InvalidInput, match='is not a ROS name'):
        Robot(bad)
    if not isinstance(bad, str):
        with pytest.raises(InvalidInput, match=r'machine: .* is neither a name nor a path'):
            Robot('/arm', machine=5 if bad is None else bad)
        with pytest.raises(InvalidInput, match=r'machine: .* is neither a name nor a path'):
            Robot.simulated(bad)
    with pytest.raises(ValueError, match='does not exist'):
        Robot.simulated(Path('nowhere.yaml'))


def test_matrices_that_are_no_transform_are_refused_by_what_is_wrong():
    robot, mirror, scaled = Idle(), np.diag([1.0, 1.0, -1.0, 1.0]), np.diag([1.0, 1.0, 1.0, 2.0])
    with pytest.raises(InvalidInput, match='are not a rotation'):
        robot.move_to(mirror)
    with pytest.raises(InvalidInput, match='the last row of the matrix'):
        robot.move_to(scaled)
