"""In which axes a commanded twist is meant; it is always the pivot's."""

from collections.abc import Callable

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import Refused
from manipulator.frames import Frames
from manipulator.pose import Pose

AXES: dict[str, Callable[[Frames, Pose], Array | None]] = {
    '': lambda frames, pose: None if frames.are_plain else frames.T_base_work.rotation.T,
    'base': lambda frames, pose: None if frames.are_plain else frames.T_base_work.rotation.T,
    'work': lambda frames, pose: None,
    'pivot': lambda frames, pose: None,
    'tool': lambda frames, pose: pose.rotation,
}
"""What turns each frame's axes into work axes; None where they are the same."""


def check_axes(frame: str) -> None:
    """Raises Refused, naming the frames that there are, for any other."""
    if frame not in AXES:
        raise Refused(f'frame {frame[:80]!r} is not one of {list(AXES)[1:]}')


def in_work_axes(command: Array, frame: str, pose: Pose, frames: Frames) -> Array:
    """The pivot's twist (6,) in work axes; pose is T_work_pivot. Refused for unknown frames.

    '' and 'base': along the base's axes. 'work': along the work frame's. 'pivot': the same, for
    those who want to say that turns are about the pivot. 'tool': along the axes of the platform
    or tool.
    """
    check_axes(frame)
    axes = AXES[frame](frames, pose)
    if axes is None:
        return command
    return np.concatenate([axes @ command[:3], axes @ command[3:]])
