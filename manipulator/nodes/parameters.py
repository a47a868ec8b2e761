"""Declaring parameters with descriptors that read well in `ros2 param describe`.

Those of `~/start_cycle` are six amplitudes, frequencies and phases a term.
"""

from collections.abc import Sequence
from enum import Enum
from typing import Any

import numpy as np
from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)
from rclpy.node import Node
from rclpy.parameter import Parameter

from manipulator.arrays import Array
from manipulator.errors import InvalidInput, Refused
from manipulator.formatting import not_one_of, shown
from manipulator.planning.cycle import Cycle
from manipulator.planning.goal import Motion, OnUnreachable
from manipulator.planning.orientation import Orientation
from manipulator.pose import Pose


def declare(
    node: Node,
    name: str,
    default: Any,
    description: str,
    bounds: tuple[float, float] | None = None,
    is_read_only: bool = True,
) -> Any:
    """Declares one parameter and returns its value; whole numbers are accepted for floats."""
    descriptor = ParameterDescriptor(
        name=name, description=description, read_only=is_read_only, dynamic_typing=True
    )
    if bounds is not None and isinstance(default, float):
        descriptor.floating_point_range = [
            FloatingPointRange(from_value=float(bounds[0]), to_value=float(bounds[1]), step=0.0)
        ]
    elif bounds is not None:
        descriptor.integer_range = [
            IntegerRange(from_value=int(bounds[0]), to_value=int(bounds[1]), step=1)
        ]
    value = node.declare_parameter(name, default, descriptor).value
    return checked(name, value, default, bounds)


def checked(name: str, value: Any, default: Any, bounds: tuple[float, float] | None) -> Any:
    """`value` in the default's type; InvalidInput names parameter, value and limit."""
    if isinstance(default, float) and isinstance(value, int) and not isinstance(value, bool):
        value = float(value)
    if type(value) is not type(default):
        expected = type(default).__name__
        raise InvalidInput(f'parameter {name}: {shown(value)} is not a {expected}')
    if bounds is not None and not bounds[0] <= value <= bounds[1]:
        raise InvalidInput(f'parameter {name}: {value} outside [{bounds[0]}, {bounds[1]}]')
    return value


CHOICES: dict[str, tuple[type[Enum], str]] = {
    'goal_motion': (
        Motion,
        'how a machine at rest goes to goal_pose: line, joint (all joints in proportion), any '
        '(a line where it can), or unwind (joint, to the branch and turns of home)',
    ),
    'goal_orientation': (
        Orientation,
        'of goal_pose and goal_path: given, or by their points alone hold_orientation, parallel, '
        'look_at (as jog_mode)',
    ),
    'on_unreachable': (
        OnUnreachable,
        'a goal_pose out of reach: refuse it, or go to the nearest pose within all limits',
    ),
}


class GoalParameters:
    """goal_motion, goal_orientation, on_unreachable: only names that are known are taken."""

    def __init__(self, node: Node) -> None:
        """Declares them; Refused for an unknown name."""
        self._node = node
        for name, (kind, description) in CHOICES.items():
            first = next(iter(kind)).value
            choice(name, declare(node, name, first, description, is_read_only=False))
        node.add_on_set_parameters_callback(_checked_choices)

    @property
    def motion(self) -> Motion:
        """How to go to goals."""
        return Motion(self._node.get_parameter('goal_motion').value)

    @property
    def orientation(self) -> Orientation:
        """Where the orientation of goals and paths comes from."""
        return Orientation(self._node.get_parameter('goal_orientation').value)

    @property
    def on_unreachable(self) -> OnUnreachable:
        """What becomes of goals out of reach."""
        return OnUnreachable(self._node.get_parameter('on_unreachable').value)


def choice(name: str, value: object) -> Enum:
    """What a parameter's value names; Refused, with the known names, for another."""
    kind = CHOICES[name][0]
    try:
        return kind(value)
    except ValueError:
        known = [one.value for one in kind]
        raise Refused(f'parameter {name}: {not_one_of(value, known)}') from None


def _checked_choices(parameters: Sequence[Parameter]) -> SetParametersResult:
    """What the node answers to new values: those that it would refuse later are not taken."""
    try:
        for parameter in parameters:
            if parameter.name in CHOICES:
                choice(parameter.name, parameter.value)
    except Refused as error:
        return SetParametersResult(successful=False, reason=str(error))
    return SetParametersResult(successful=True)


AXES = 'x, y, z, roll, pitch, yaw; further terms follow as further six'
AMPLITUDE = [0.003, 0.003, 0.0015, 0.05, 0.05, 0.04]
"""Half of the amplitudes of Prokopovich 2019, fig. 12, whose own corners are out of reach."""


class CycleParameters:
    """cycle.amplitude, cycle.frequency and cycle.phase; read when a cycle is started."""

    def __init__(self, node: Node) -> None:
        self._node = node
        defaults = {
            'amplitude': (AMPLITUDE, f'amplitudes (m, rad) about {AXES}'),
            'frequency': ([0.5] * 6, f'frequencies (Hz) about {AXES}'),
            'phase': ([0.0] * 6, f'phases (rad) about {AXES}'),
        }
        for name, (default, description) in defaults.items():
            declare(node, f'cycle.{name}', default, description, is_read_only=False)

    def read(self, centre: Pose) -> Cycle:
        """The cycle about `centre`; InvalidInput names the wrong parameter."""
        amplitude, frequency, phase = map(self._terms, ('amplitude', 'frequency', 'phase'))
        return Cycle(centre, amplitude, frequency, phase)

    def _terms(self, name: str) -> Array:
        values = np.array(self._node.get_parameter(f'cycle.{name}').value, dtype=np.float64)
        return values.reshape(-1, 6) if values.size % 6 == 0 else values
