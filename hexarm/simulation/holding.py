"""Whether the servos hold a machine up along a way, and where they do not."""

import numpy as np

from hexarm.simulation.drives import Drives
from hexarm.simulation.static_load import StaticLoad
from manipulator.arrays import Array
from manipulator.errors import ManipulatorError
from manipulator.pose import Pose


class Stalls(ManipulatorError, ValueError):
    """A load that the servos cannot hold; `joint` counts from 1, pose is the worst one's."""

    def __init__(self, message: str, joint: int, pose: Pose) -> None:
        super().__init__(message)
        self.joint = joint
        self.pose = pose


def check_holds(
    load: StaticLoad, drives: Drives, names: tuple[str, ...], poses: Pose, joints: Array
) -> None:
    """Raises Stalls at the worst of poses (N) where gravity asks for more than a drive gives."""
    efforts = np.abs(load(poses, joints))
    shares = efforts / drives.effort
    worst, joint = np.unravel_index(np.argmax(shares), shares.shape)
    if shares[worst, joint] <= 1.0:
        return
    pose = poses[int(worst)]
    place = ', '.join(
        f'{name} {1e3 * value:.1f}' for name, value in zip('xyz', pose.position, strict=True)
    )
    turn = ', '.join(f'{value:.3f}' for value in pose.rpy)
    raise Stalls(
        f'{names[joint]} stalls at {place} mm, rpy {turn} rad: needs {efforts[worst, joint]:.4g}, '
        f'its drive gives {drives.effort[joint]:.4g} (N·m or N)',
        int(joint) + 1,
        pose,
    )
