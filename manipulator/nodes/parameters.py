"""Declaring parameters with descriptors that read well in `ros2 param describe`."""

from typing import Any

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.node import Node

from manipulator.errors import InvalidInput
from manipulator.words import shown


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
        wanted = type(default).__name__
        raise InvalidInput(f'parameter {name}: {shown(value)} is not a {wanted}')
    if bounds is not None and not bounds[0] <= value <= bounds[1]:
        raise InvalidInput(f'parameter {name}: {value} outside [{bounds[0]}, {bounds[1]}]')
    return value
