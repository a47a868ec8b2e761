"""Declaring parameters with descriptors that read well in `ros2 param describe`.

Those of `~/start_cycle` are six amplitudes, frequencies and phases a term.
"""

from typing import Any

import numpy as np
from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.node import Node

from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.formatting import shown
from manipulator.pose import Pose
from manipulator.trajectory.cycle import Cycle


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
