"""ROS messages to values of the core and back; what does not fit raises InvalidInput."""

import math

import numpy as np
from builtin_interfaces.msg import Time
from geometry_msgs.msg import PointStamped, PoseStamped, TwistStamped
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory

from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.formatting import counted
from manipulator.frames import Frames
from manipulator.planning.joint_points import (
    InvalidJoints,
    JointPoint,
    JointPoints,
    joint_points,
)
from manipulator.pose import Pose

FASTEST_TWIST = 100.0
"""m/s or rad/s. Less is scaled to what the machine can do; more is a damaged message."""

BASE_FRAME, WORK_FRAME, PLATFORM_FRAME, PIVOT_FRAME = 'base', 'work', 'platform', 'pivot'


NO_TURN = (0.0, 0.0, 0.0, 1.0)


def seconds(stamp: Time) -> float:
    """A stamp in seconds."""
    return float(stamp.sec + stamp.nanosec * 1e-9)


def pose_of(
    message: PoseStamped, frames: tuple[str, ...] = (BASE_FRAME,), is_oriented: bool = True
) -> Pose:
    """The pose in its frame, which must be one of `frames`; an empty frame_id means the first.

    A quaternion of zeros is no rotation, and allowed only where the pose is not `is_oriented`.
    """
    check_frame(message.header.frame_id, frames)
    p, q = message.pose.position, message.pose.orientation
    numbers = {'x': p.x, 'y': p.y, 'z': p.z, 'qx': q.x, 'qy': q.y, 'qz': q.z, 'qw': q.w}
    for name, value in numbers.items():
        if not math.isfinite(value):
            raise InvalidInput(f'{name} is {value}, needs a finite number')
    xyzw = (q.x, q.y, q.z, q.w)
    if not is_oriented and not any(xyzw):
        xyzw = NO_TURN
    return Pose.from_xyz_quaternion((p.x, p.y, p.z), xyzw)


def goal_of(message: PoseStamped, frames: Frames) -> Pose:
    """The pivot's pose in the work frame; a message in the base frame holds the platform's."""
    pose = pose_of(message, (BASE_FRAME, WORK_FRAME))
    return pose if message.header.frame_id == WORK_FRAME else frames.pivot(pose)


def pose_message(pose: Pose, stamp: Time, frame: str = BASE_FRAME) -> PoseStamped:
    """A pose as a message."""
    message = PoseStamped()
    message.header.stamp = stamp
    message.header.frame_id = frame
    p, q = message.pose.position, message.pose.orientation
    p.x, p.y, p.z = pose.position.tolist()
    q.x, q.y, q.z, q.w = pose.quaternion.tolist()
    return message


def check_frame(frame_id: str, frames: tuple[str, ...]) -> None:
    """Raises InvalidInput unless the frame is one of `frames`, or empty."""
    if frame_id and frame_id not in frames:
        known = ' or '.join(repr(frame) for frame in frames)
        raise InvalidInput(f'frame_id {frame_id[:80]!r} is unknown, needs {known}, or nothing')


def twist_of(message: TwistStamped) -> Array:
    """The twist (6,) in the axes of its frame; InvalidInput for what no hand can mean."""
    v, w = message.twist.linear, message.twist.angular
    twist = np.array([v.x, v.y, v.z, w.x, w.y, w.z])
    if not np.isfinite(twist).all():
        raise InvalidInput(f'twist {twist.tolist()} is not finite')
    if np.abs(twist).max() > FASTEST_TWIST:
        raise InvalidInput(f'twist {twist.tolist()} is beyond {FASTEST_TWIST:g} m/s or rad/s')
    return twist


def point_of(message: PointStamped, *frames: str) -> list[float]:
    """The coordinates of a point in its frame; an empty frame_id means the first of `frames`."""
    check_frame(message.header.frame_id, frames)
    point = [message.point.x, message.point.y, message.point.z]
    if not all(math.isfinite(c) for c in point):
        raise InvalidInput(f'point {point} is not finite')
    return point


def joints_of(message: JointState, names: tuple[str, ...]) -> Array:
    """Positions in the order of `names`; joints of other names are not ours and are ignored.

    Raises InvalidInput for missing or repeated joints, for arrays that do not match and for
    numbers that are not finite.
    """
    if len(message.name) != len(message.position):
        raise InvalidInput(
            f'{counted(len(message.name), "name")} but '
            f'{counted(len(message.position), "position")}'
        )
    positions = dict(zip(message.name, message.position, strict=True))
    if len(positions) != len(message.name):
        raise InvalidInput(
            f'a joint is named twice in {[name[:80] for name in message.name[:20]]}'
        )
    missing = [name for name in names if name not in positions]
    if missing:
        raise InvalidInput(f'joints {missing} are missing')
    joints = np.array([positions[name] for name in names])
    if not np.isfinite(joints).all():
        name = names[int(np.argmin(np.isfinite(joints)))]
        raise InvalidInput(f'{name} is {positions[name]}, needs a finite number')
    return joints


def named_joints(message: JointState, what: str) -> dict[str, float]:
    """One number a joint of the array `what` of the message: position or velocity.

    Raises InvalidJoints for a joint that is named twice, InvalidInput for an array of another
    length.
    """
    names, values = [name[:80] for name in message.name], getattr(message, what)
    if len(names) != len(values):
        many = 'positions' if what == 'position' else 'velocities'
        there = counted(len(values), what, many)
        raise InvalidInput(f'{counted(len(names), "name")} but {there}')
    named = dict(zip(names, values, strict=True))
    if len(named) != len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise InvalidJoints(f'joint {twice} is named twice')
    return named


def joint_points_of(message: JointTrajectory, known: tuple[str, ...]) -> JointPoints:
    """The points of a trajectory, checked as `joint_points` does."""
    points = [
        JointPoint(
            point.time_from_start.sec + point.time_from_start.nanosec * 1e-9,
            point.positions,
            point.velocities,
            point.accelerations,
            point.effort,
        )
        for point in message.points
    ]
    return joint_points(message.joint_names, points, known)


def known_joints(message: JointState, names: tuple[str, ...]) -> Array | None:
    """As `joints_of`; None where the message does not name all of them."""
    return joints_of(message, names) if set(names) <= set(message.name) else None


def joint_message(joints: Array, names: tuple[str, ...], stamp: Time) -> JointState:
    """Joint positions as a message."""
    message = JointState(name=list(names), position=joints.tolist())
    message.header.stamp = stamp
    return message
