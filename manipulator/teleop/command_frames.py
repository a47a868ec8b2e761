"""In which axes, and about which point, a commanded twist is meant."""

from typing import Literal, get_args

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import Refused
from manipulator.pose import Pose

CommandFrame = Literal['base', 'tool', 'pivot']


def in_base(command: Array, frame: str, pose: Pose, pivot: Array | None = None) -> Array:
    """The twist (6,) of the moving frame's origin in base axes, for the named frame's command.

    '' and 'base': already so. 'tool': both vectors in the moving frame's axes. 'pivot': base
    axes, turning about `pivot` (3,) in the base frame. Raises Refused for any other name, and
    for a pivot that was never given.
    """
    if frame in ('', 'base'):
        return command
    if frame == 'tool':
        return np.concatenate([pose.rotation @ command[:3], pose.rotation @ command[3:]])
    if frame != 'pivot':
        raise Refused(f'frame {frame!r} is not one of {list(get_args(CommandFrame))}')
    if pivot is None:
        raise Refused('frame pivot: no pivot was given yet')
    arm = pose.position - pivot
    return np.concatenate([command[:3] + np.cross(command[3:], arm), command[3:]])
