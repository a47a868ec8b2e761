"""The gripper at the tool: how far it is open, and the lines that show it."""

from dataclasses import dataclass

import numpy as np

from bridge.calibration import Calibration
from hexarm.machines import board_config, read
from manipulator.arrays import Array
from manipulator.links import Stroke
from manipulator.pose import Pose

PART = 'gripper'
REACH, WIDEST, NARROWEST = 0.09, 0.055, 0.012
"""Of its fingers, by the machine's size: their length, and their distance from the tool's axis."""

PAST_TOOL = 0.02
"""How far the fingers go beyond the tool point, which lies between their tips."""


@dataclass(frozen=True)
class GripperJoint:
    """A joint outside the kinematics: its positions closed and open, in rad (or m)."""

    name: str
    closed: float
    opened: float

    def opening(self, position: float) -> float:
        """From 0, closed, to 1, open."""
        return float(np.clip((position - self.closed) / (self.opened - self.closed), 0.0, 1.0))


def gripper_of(name_or_path: str) -> GripperJoint | None:
    """The joint that a machine file marks as its gripper; ConfigError with all problems."""
    if read(name_or_path).driver != 'serial':
        return None
    servos = board_config(name_or_path).servos
    calibration = Calibration.from_config(servos)
    for joint in servos.joints:
        if joint.is_gripper:
            closed, opened = calibration.range_of(calibration.names.index(joint.name))
            return GripperJoint(joint.name, closed, opened)
    return None


def fingers(tool: Pose, opening: float, size: float) -> tuple[Stroke, ...]:
    """A line from fingertip to fingertip, in the tool's plane xz; size in metres."""
    aside = NARROWEST + opening * (WIDEST - NARROWEST)
    tip, root = PAST_TOOL, PAST_TOOL - REACH
    outline: Array = size * np.array(
        [[-aside, 0.0, tip], [-aside, 0.0, root], [aside, 0.0, root], [aside, 0.0, tip]]
    )
    return (Stroke(PART, tool.transform(outline)),)
