"""The frames of a machine's moving parts, for viewers (tf, URDF)."""

from dataclasses import dataclass

from manipulator.pose import Pose

PLATFORM = 'platform'


@dataclass(frozen=True, eq=False)
class Link:
    """A moving part and T_base_link; the machine's last link is the platform, or the tool."""

    name: str
    pose: Pose
