"""An identified platform as lines and values of its machine file, in millimetres and degrees."""

import numpy as np

from hexapod_control.geometry import RotaryGeometry
from hexapod_control.linear_geometry import LinearGeometry
from manipulator.arrays import Array


def geometry_lines(geometry: RotaryGeometry | LinearGeometry) -> list[str]:
    """The `geometry` section by coordinates, to 0.1 µm."""
    height = f'  home_height_mm: {1e3 * geometry.home_height:g}'
    joints = _points('platform_joints_mm', 1e3 * geometry.platform_points)
    if isinstance(geometry, LinearGeometry):
        return [*_points('base_joints_mm', 1e3 * geometry.base_points), *joints, height]
    return [
        *_points('crank_centres_mm', 1e3 * geometry.crank_centres),
        *_points('crank_tangents', geometry.tangents, 6),
        *joints,
        f'  crank_length_mm: {_list(1e3 * geometry.crank_lengths)}',
        f'  rod_length_mm: {_list(1e3 * geometry.rod_lengths)}',
        height,
    ]


def _points(key: str, points: Array, digits: int = 4) -> list[str]:
    return [f'  {key}:', *(f'    - {_list(point, digits)}' for point in points)]


def _list(numbers: Array, digits: int = 4) -> str:
    # Adding zero makes -0.0 a plain zero.
    return f'[{", ".join(str(float(np.round(n, digits) + 0.0)) for n in numbers)}]'
