"""Why a pose is out of reach and which one is not, in one line for people."""

import numpy as np

from manipulator.analysis.nearest import nearest_reachable
from manipulator.analysis.reach import reach
from manipulator.arrays import Array
from manipulator.machine import Machine
from manipulator.pose import Pose


def explained(machine: Machine, pose: Pose, near: Array | None = None) -> str:
    """The reason and the nearest reachable pose; empty where the pose is reachable.

    Takes some 5 ms: for the answer to a question, not for a control tick.
    """
    reason = reach(machine, pose, near).reason
    if not reason:
        return ''
    return f'{reason}; nearest reachable: {pose_in_words(nearest_reachable(machine, pose).pose)}'


def pose_in_words(pose: Pose) -> str:
    """As 'x 14.200  y 0.000  z 41.190 mm  roll 0.00  pitch 0.00  yaw 0.00°'."""
    # + 0.0 turns −0 into 0
    places = zip('xyz', np.round(1e3 * pose.position, 3) + 0.0, strict=True)
    angles = zip(('roll', 'pitch', 'yaw'), np.round(np.degrees(pose.rpy), 2) + 0.0, strict=True)
    return (
        '  '.join(f'{n} {v:.3f}' for n, v in places)
        + ' mm  '
        + '  '.join(f'{n} {v:.2f}' for n, v in angles)
        + '°'
    )
