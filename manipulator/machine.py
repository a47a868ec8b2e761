"""A machine as the nodes use it: its kinematics, its limits, its way of moving."""

from dataclasses import dataclass
from typing import Any

from manipulator.kinematics import Kinematics
from manipulator.limits.constraints import Constraints
from manipulator.motion_limits import MotionConfig, MotionLimits


@dataclass(frozen=True)
class MachineFile:
    """The sections of a machine file; each room checks its own against its own schema.

    geometry and limits belong to the kind of machine, servos, link and simulation to the bridge.
    """

    kind: str
    geometry: dict[str, Any]
    limits: dict[str, Any]
    motion: MotionConfig
    servos: dict[str, Any]
    link: dict[str, Any]
    description: str = ''
    simulation: dict[str, Any] | None = None


@dataclass(frozen=True)
class Machine:
    """What trajectory, ik and pose need to know of a machine."""

    kinematics: Kinematics
    constraints: Constraints
    motion: MotionLimits
