"""Platforms on struts that slide on rails, from the measures that people have."""

from collections.abc import Iterator

import numpy as np

from hexarm.new import lines
from hexarm.new.cylinders import drive_text, pulses_text
from hexarm.new.lines import line, num
from hexarm.new.platforms import (
    END_SHARE,
    Measures,
    joints_of,
    machine_of,
    platform_dynamics,
    radius_of,
    scales,
    side_of,
)
from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.machine import Machine

SIDES = {'behind': 1.0, 'ahead': -1.0}
HEIGHTS = 20_001
"""Tried, to find the one with the carriages in the middle."""


def directions(m: Measures) -> Array:
    """Where each carriage goes as its position grows, (6, 3): a unit vector, or as given."""
    if m['rail_direction'] == 'own':
        return np.array(m['rail_directions'])
    if m['rail_direction'] in ('up', 'down'):
        return np.tile([0.0, 0.0, 1.0 if m['rail_direction'] == 'up' else -1.0], (6, 1))
    base = joints_of(m)[0] * [1.0, 1.0, 0.0]
    sizes = np.linalg.norm(base, axis=1, keepdims=True)
    if not sizes.all():
        raise InvalidInput('rail_direction: a joint on the z axis has no way out: needs own')
    result: Array = base / sizes * (1.0 if m['rail_direction'] == 'out' else -1.0)
    return result


def positions(m: Measures, heights: Array, side: float) -> Array:
    """Of the carriages (n, 6) under level platforms, mm, by docs/kinematics.md, (10.2)."""
    base, moving = joints_of(m)
    along = directions(m)
    along = along / np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
    gaps = moving - base + heights[:, None, None] * [0.0, 0.0, 1.0]
    parts = (gaps * along).sum(axis=-1)
    across = (gaps**2).sum(axis=-1) - parts**2
    with np.errstate(invalid='ignore'):
        result: Array = parts - side * np.sqrt(m['rod_length_mm'] ** 2 - across)
    return result


def home_of(m: Measures) -> tuple[float, str]:
    """Height at home, and on which side of their joints the carriages are there."""
    sides = list(SIDES) if m['carriages'] == 'auto' else [m['carriages']]
    given, middle = m['home_height_mm'], m['stroke_mm'] / 2
    if given != 'auto':
        off = [np.abs(positions(m, np.array([given]), SIDES[s]) - middle).max() for s in sides]
        return given, sides[int(np.argmin(np.nan_to_num(off, nan=np.inf)))]
    base, moving = joints_of(m)
    start = float((base - moving)[:, 2].mean())
    reach = m['rod_length_mm'] + m['stroke_mm']
    heights = np.linspace(start + side_of(m) * reach, start, HEIGHTS)
    for side in sides:
        off = positions(m, heights, SIDES[side]).mean(axis=1) - middle
        crossed = np.flatnonzero(off[:-1] * off[1:] <= 0.0)
        if crossed.size:
            k = crossed[0]
            share = off[k] / (off[k] - off[k + 1])
            return float(heights[k] + share * (heights[k + 1] - heights[k])), side
    raise InvalidInput(
        'home_height_mm: at no height above the base are the carriages in the middle of their '
        'travel: look at the rod_length_mm, the rail_direction and the order of the joints'
    )


def rail_text(m: Measures) -> Iterator[str]:
    """The machine file of a platform on rails."""
    height, side = home_of(m)
    machine, scale = _made(m, height, side), radius_of(joints_of(m)[1])
    home = 1e3 * machine.kinematics.inverse(machine.kinematics.home)
    is_by_driver = m['cylinder_input'] == 'driver'
    yield from lines.head('rail_hexapod', m['description'], is_by_driver)
    yield ''
    yield from _geometry(m, height, side)
    yield ''
    free = END_SHARE * m['stroke_mm']
    yield 'limits:'
    yield line(
        f'  rail_range_mm: {lines.row((free, m["stroke_mm"] - free))}',
        '2 % of the travel is kept free at each end',
    )
    yield line(f'  passive_cone_deg: {num(m["joint_swing_deg"])}', 'of a strut, from home')
    yield from scales(machine, scale)
    yield ''
    yield from lines.motion(machine, lines.RATED * m['cylinder_speed_mm_s'], 'mm')
    if not is_by_driver:
        yield ''
        yield from pulses_text(m, machine.kinematics.joint_names, m['stroke_mm'] / 2)
        yield line(f'  park_mm: {lines.row(np.round(home, 2))}', 'where they are switched on')
        yield ''
        yield from lines.link('hysteresis_mm: 0.2')
    yield ''
    yield from platform_dynamics(m, scale)
    yield '  carriage: {mass_g: 40.0, radius_mm: 8.0, length_mm: 30.0, source: estimate}'
    yield '  rod: {mass_g: 16.0, radius_mm: 4.0, source: estimate}'
    yield drive_text(m)


def _made(m: Measures, height: float, side: str) -> Machine:
    """The machine, with limits that are wide open."""
    base, moving = joints_of(m)
    geometry = {
        'rail_points_mm': base.tolist(),
        'rail_directions': directions(m).tolist(),
        'platform_joints_mm': moving.tolist(),
        'rod_length_mm': m['rod_length_mm'],
        'carriages': side,
        'home_height_mm': round(height, 3),
    }
    limits = {
        'rail_range_mm': [-3.0 * m['stroke_mm'], 4.0 * m['stroke_mm']],
        'passive_cone_deg': 180.0,
        'singularity_margin': 0.001,
        'characteristic_length_mm': radius_of(moving),
    }
    return machine_of('rail_hexapod', geometry, limits)


def _geometry(m: Measures, height: float, side: str) -> Iterator[str]:
    base, moving = joints_of(m)
    yield 'geometry:'
    yield from lines.rows('rail_points_mm', base, 'lower joints with the carriages at 0')
    yield from lines.rows('rail_directions', directions(m), 'to where positions grow', 6)
    yield from lines.rows('platform_joints_mm', moving, 'platform frame')
    yield f'  rod_length_mm: {num(m["rod_length_mm"])}'
    yield line(f'  carriages: {side}', 'of their joints on the platform')
    yield f'  home_height_mm: {num(height)}'
