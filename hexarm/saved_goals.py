"""How a machine returns to a saved pose: an arm in its saved posture, a platform by the pose.

An arm has up to eight branches with one pose. The saved joints choose the branch and the turns.
The saved pose counts if a user has edited it in the file.
"""

import numpy as np

from arm_control.arm import SerialArm
from manipulator.arrays import Array
from manipulator.errors import Refused
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.saved_poses import SavedPose

SAME_POSE = 1e-6
"""m and rad within which the saved joints make the saved pose: its digits in the file."""
SAME_JOINTS = 2e-3
"""rad within which joints are the saved ones, and by which one at its stop is measured beyond."""
LINE_POSES = 200
"""On a line whose branch is followed."""


def joints_of(machine: Machine, saved: SavedPose) -> dict[str, float] | None:
    """The joints (rad) by name in which an arm takes a saved pose; None: the pose is enough.

    Raises Unreachable for a pose that a user has edited and no joints reach.
    """
    kinematics = machine.kinematics
    if saved.joints is None or not isinstance(kinematics, SerialArm):
        return None
    joints = saved.joints
    taken = kinematics.forward(joints, saved.pose).pose
    if np.abs(taken.twist_to(saved.pose)).max() > SAME_POSE:
        joints = kinematics.inverse(saved.pose, joints)
    inside = np.clip(joints, *machine.joint_ranges)
    joints = np.where(np.abs(inside - joints) < SAME_JOINTS, inside, joints)
    return dict(zip(kinematics.joint_names, joints.tolist(), strict=True))


def check_line(machine: Machine, start: Pose, near: Array, saved: SavedPose) -> None:
    """Refused where a line from pose `start`, joints `near` (n,), ends in another posture."""
    named = joints_of(machine, saved)
    if named is None:
        return
    shares = np.linspace(0.0, 1.0, LINE_POSES)[:, None]
    line = start.moved(shares * start.twist_to(saved.pose))
    end = machine.kinematics.inverse_along(line, near)[-1]
    for name, arrival in zip(named, end.tolist(), strict=True):
        if np.isnan(arrival):
            raise Refused('the line leaves the reach: without a speed a joint move goes there')
        if abs(arrival - named[name]) > SAME_JOINTS:
            raise Refused(
                f'along a line {name} arrives at {np.degrees(arrival):.1f}°, and is saved at '
                f'{np.degrees(named[name]):.1f}°: without a speed it is reached by a joint move'
            )
