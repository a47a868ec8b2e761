"""An identified arm as lines of its machine file, in millimetres and degrees."""

import numpy as np

from arm_control.chain import Chain
from manipulator.arrays import Array

POINT_DIGITS, AXIS_DIGITS, ANGLE_DIGITS = 4, 8, 6


def geometry_lines(chain: Chain, rest: Array) -> list[str]:
    """The `geometry` section by joint axes, to 0.1 µm; rest (6,) are the joints at home, rad."""
    screws = [
        f'    - {{axis: {_list(axis, AXIS_DIGITS)}, point_mm: {_list(1e3 * point)}}}'
        for axis, point in zip(chain.axes, chain.points, strict=True)
    ]
    return [
        '  screws:',
        *screws,
        f'  tool_position_mm: {_list(1e3 * chain.home.position)}',
        f'  tool_rpy_deg: {_list(np.degrees(chain.home.rpy), ANGLE_DIGITS)}',
        f'  home_deg: {_list(np.degrees(rest), ANGLE_DIGITS)}',
    ]


def _list(numbers: Array, digits: int = POINT_DIGITS) -> str:
    # Adding zero makes -0.0 a plain zero.
    return f'[{", ".join(str(float(np.round(n, digits) + 0.0)) for n in numbers)}]'
