"""What the functions that read messages make of values that no honest sender would send."""

import contextlib
import math

import numpy as np
import pytest

pytest.importorskip('geometry_msgs')

from builtin_interfaces.msg import Time
from geometry_msgs.msg import PointStamped, TwistStamped
from sensor_msgs.msg import JointState

from hexarm.machines import load
from manipulator.errors import InvalidInput, Refused
from manipulator.message_filter import StaleMessage, StampFilter
from manipulator.nodes.messages import (
    goal_of,
    joint_message,
    joints_of,
    point_of,
    pose_message,
    pose_of,
    twist_of,
)
from manipulator.nodes.parameters import choice
from manipulator.pose import Pose

BAD = (math.nan, math.inf, -math.inf)
HUGE = 'x' * 50_000
NAMES = tuple(f'crank_{i}' for i in range(1, 7))
GOOD = Pose.from_xyz_rpy((0.001, -0.002, 0.045), (0.1, 0.2, 0.3))


def message_with(change):
    message = pose_message(GOOD, Time())
    change(message)
    return message


def test_a_pose_comes_back_as_it_was_sent():
    assert np.abs(pose_of(pose_message(GOOD, Time())).twist_to(GOOD)).max() < 1e-12


@pytest.mark.parametrize('bad', BAD)
@pytest.mark.parametrize('part', ['position', 'orientation'])
def test_a_number_of_a_pose_that_is_not_finite_is_named(part, bad):
    for name in 'xyz' if part == 'position' else 'xyzw':
        reported = name if part == 'position' else f'q{name}'
        message = message_with(lambda m, n=name: setattr(getattr(m.pose, part), n, bad))
        with pytest.raises(InvalidInput, match=f'^{reported} is {bad}, needs a finite number'):
            pose_of(message)


@pytest.mark.parametrize(
    ('quaternion', 'words'),
    [
        ((0.0, 0.0, 0.0, 0.0), 'quaternion has length 0'),
        ((0.0, 0.0, 0.0, 2.0), 'quaternion has length 2'),
        ((0.0, 0.0, 0.0, -1e308), 'quaternion has length'),
    ],
)
def test_a_quaternion_that_is_no_rotation_is_reported_with_its_length(quaternion, words):
    def change(message):
        q = message.pose.orientation
        q.x, q.y, q.z, q.w = quaternion

    with pytest.raises(InvalidInput, match=words):
        pose_of(message_with(change))


@pytest.mark.parametrize('frame', ['moon', 'Base', ' base', 'base\0', HUGE])
def test_an_unknown_frame_is_named_shortly_with_those_that_there_are(frame):
    message = message_with(lambda m: setattr(m.header, 'frame_id', frame))
    frames = load('robocake').frames
    for read in (pose_of, lambda m: goal_of(m, frames)):
        with pytest.raises(InvalidInput, match="is unknown, needs 'base'") as refusal:
            read(message)
        assert len(str(refusal.value)) < 200


def test_a_goal_in_the_work_frame_is_the_pivots():
    frames = load('robocake').frames.with_pivot([0.0, 0.0, 0.03])
    in_base = goal_of(pose_message(GOOD, Time()), frames)
    in_work = goal_of(pose_message(in_base, Time(), 'work'), frames)
    assert np.abs(in_work.twist_to(in_base)).max() < 1e-12
    assert frames.platform(in_work).position == pytest.approx(GOOD.position)


@pytest.mark.parametrize('bad', [*BAD, 101.0, -1e308])
def test_a_twist_that_no_hand_can_mean_is_refused(bad):
    for part in ('linear', 'angular'):
        for name in 'xyz':
            message = TwistStamped()
            setattr(getattr(message.twist, part), name, bad)
            with pytest.raises(InvalidInput, match=r'not finite|beyond 100 m/s'):
                twist_of(message)


def test_a_twist_is_six_numbers_in_their_order():
    message = TwistStamped()
    v, w = message.twist.linear, message.twist.angular
    v.x, v.y, v.z, w.x, w.y, w.z = 1.0, 2.0, 3.0, 4.0, 5.0, 100.0
    assert twist_of(message).tolist() == [1.0, 2.0, 3.0, 4.0, 5.0, 100.0]


@pytest.mark.parametrize('bad', BAD)
def test_a_point_that_is_no_place_is_refused(bad):
    for name in 'xyz':
        message = PointStamped()
        setattr(message.point, name, bad)
        with pytest.raises(InvalidInput, match='is not finite'):
            point_of(message, 'platform')


def test_a_point_in_an_unknown_frame_is_refused():
    message = PointStamped()
    message.header.frame_id = 'moon'
    with pytest.raises(InvalidInput, match="'moon' is unknown, needs 'base' or 'work'"):
        point_of(message, 'base', 'work')


HOSTILE_JOINTS = [
    (NAMES, [0.0] * 5, '6 names but 5 positions'),
    (NAMES[:5], [0.0] * 6, '5 names but 6 positions'),
    (('crank_1',) * 6, [0.0] * 6, 'a joint is named twice'),
    ((HUGE,) * 2, [0.0] * 2, 'a joint is named twice'),
    ((*NAMES[:5], 'crank_9'), [0.0] * 6, r"joints \['crank_6'\] are missing"),
    ((), [], 'are missing'),
    (NAMES, [0.0] * 5 + [math.nan], 'crank_6 is nan, needs a finite number'),
    (NAMES, [math.inf] + [0.0] * 5, 'crank_1 is inf, needs a finite number'),
]


@pytest.mark.parametrize(('names', 'positions', 'words'), HOSTILE_JOINTS)
def test_joints_that_do_not_fit_are_refused_in_few_words(names, positions, words):
    message = JointState(name=list(names), position=positions)
    with pytest.raises(InvalidInput, match=words) as refusal:
        joints_of(message, NAMES)
    assert len(str(refusal.value)) < 2000


def test_ten_thousand_joints_of_other_names_are_ignored():
    others = [f'j{k}' for k in range(10_000)]
    message = JointState(name=[*others, *NAMES], position=[0.0] * 10_000 + [1.0] * 6)
    assert joints_of(message, NAMES).tolist() == [1.0] * 6


def test_joints_come_back_in_the_order_that_was_asked_for():
    message = joint_message(np.arange(6.0), NAMES, Time())
    assert joints_of(message, tuple(reversed(NAMES))).tolist() == [5.0, 4.0, 3.0, 2.0, 1.0, 0.0]


@pytest.mark.parametrize('sec', [2**31 - 1, -(2**31), 1])
def test_a_stamp_from_anywhere_is_refused_or_believed_and_the_next_good_one_works(sec):
    stamps = StampFilter()
    stamps.admit(1_700_000_000.0, 1_700_000_000.0)
    with contextlib.suppress(StaleMessage):
        stamps.admit(float(sec), 1_700_000_000.1)
    refused = 0
    for k in range(20):
        try:
            stamps.admit(1_700_000_001.0 + 0.1 * k, 1_700_000_001.0 + 0.1 * k)
        except StaleMessage:
            refused += 1
    assert refused <= 3


def test_a_goal_of_zeros_for_its_quaternion_is_a_point_where_no_orientation_is_asked_for():
    message = pose_message(Pose.from_xyz_rpy((0.1, 0.2, 0.3), (0.1, 0.2, 0.3)), Time())
    q = message.pose.orientation
    q.x = q.y = q.z = q.w = 0.0
    with pytest.raises(InvalidInput, match='quaternion has length 0'):
        pose_of(message)
    assert pose_of(message, is_oriented=False).position.tolist() == [0.1, 0.2, 0.3]
    q.w = math.nan
    with pytest.raises(InvalidInput, match='qw is nan'):
        pose_of(message, is_oriented=False)


@pytest.mark.parametrize('name', ['goal_motion', 'goal_orientation', 'on_unreachable'])
@pytest.mark.parametrize('value', ['', 'straight', 3, HUGE])
def test_an_unknown_choice_is_refused_with_the_known_ones(name, value):
    with pytest.raises(Refused, match=f'parameter {name}: .* is not one of ') as raised:
        choice(name, value)
    assert len(str(raised.value)) < 300
