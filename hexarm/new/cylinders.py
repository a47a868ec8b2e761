"""Platforms on cylinders from the measures that people have."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from hexarm.new import lines
from hexarm.new.lines import line, num
from hexarm.new.platforms import (
    END_SHARE,
    Measures,
    joints_of,
    machine_of,
    platform_dynamics,
    radius_of,
    scales,
)
from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.machine import Machine

TO_SPEED = 0.005
"""Seconds in which a cylinder's drive gets up to speed (estimate)."""


def middle_height(base: Array, moving: Array, length: float) -> float:
    """The height of a level platform on legs that are so long, on average."""
    offsets = (moving - base)[:, :2]
    across = np.linalg.norm(offsets, axis=1)
    worst = int(np.round(across, 6).argmax())
    if across[worst] >= length:
        raise InvalidInput(
            f'retracted_mm, stroke_mm: {length:g} mm at half the stroke, but leg {worst + 1} has '
            f'{across[worst]:.1f} mm from joint to joint, seen from above: look at the order of '
            'the joints and the radii'
        )
    return float((base[:, 2] + np.sqrt(length**2 - across**2) - moving[:, 2]).mean())


def cylinder_text(m: Measures) -> Iterator[str]:
    """The machine file of a platform on six cylinders."""
    machine, scale = _made(m), radius_of(joints_of(m)[1])
    speed, is_by_driver = m['cylinder_speed_mm_s'], m['cylinder_input'] == 'driver'
    legs = 1e3 * machine.kinematics.inverse(machine.kinematics.home)
    yield from lines.head('linear_hexapod', m['description'], is_by_driver)
    yield ''
    yield from _geometry(m, 1e3 * float(machine.kinematics.home.position[2]), legs)
    yield ''
    yield from _limits(m, machine, scale)
    yield ''
    yield from lines.motion(machine, lines.RATED * speed, 'mm')
    if not is_by_driver:
        yield ''
        yield from pulses_text(m, machine.kinematics.joint_names, _middle(m))
        yield line(f'  park_mm: {lines.row(np.round(legs, 2))}', 'where they are switched on')
        yield ''
        yield from lines.link('hysteresis_mm: 0.2')
    yield ''
    yield from _dynamics(m, scale)


def _middle(m: Measures) -> float:
    """A leg's length at half its stroke."""
    return float(m['retracted_mm'] + m['stroke_mm'] / 2)


def _made(m: Measures) -> Machine:
    """The machine, with limits that are wide open."""
    base, moving = joints_of(m)
    height = m['home_height_mm']
    if height == 'auto':
        height = middle_height(base, moving, _middle(m))
    geometry = {
        'base_joints_mm': base.tolist(),
        'platform_joints_mm': moving.tolist(),
        'home_height_mm': round(height, 3),
    }
    limits = {
        'stroke_range_mm': [m['retracted_mm'] / 3, 3 * (m['retracted_mm'] + m['stroke_mm'])],
        'passive_cone_deg': 180.0,
        'singularity_margin': 0.001,
        'characteristic_length_mm': radius_of(moving),
    }
    return machine_of('linear_hexapod', geometry, limits)


def _limits(m: Measures, machine: Machine, scale: float) -> Iterator[str]:
    free = END_SHARE * m['stroke_mm']
    ends = (m['retracted_mm'] + free, m['retracted_mm'] + m['stroke_mm'] - free)
    yield 'limits:'
    yield line(
        f'  stroke_range_mm: {lines.row(ends)}', '2 % of the stroke is kept free at each end'
    )
    yield line(f'  passive_cone_deg: {num(m["joint_swing_deg"])}', 'of a leg, from home')
    yield from scales(machine, scale)


def _geometry(m: Measures, height: float, legs: Array) -> Iterator[str]:
    comment = f'legs of {legs.min():.1f} … {legs.max():.1f} mm' if np.ptp(legs) > 0.1 else (
        f'all legs {legs.mean():.1f} mm')  # fmt: skip
    yield from _joints(m)
    yield line(f'  home_height_mm: {num(height)}', comment)


def _joints(m: Measures) -> Iterator[str]:
    """By circles, or by coordinates where the keys of circles cannot say it."""
    yield 'geometry:'
    angles = [m.get(f'{plate}_angles_deg', ()) for plate in ('base', 'platform')]
    if not all(len(some) == 1 and 0.0 <= some[0] <= 60.0 for some in angles) or (
        min(m.get('base_joint_height_mm', 0.0), m.get('platform_joint_height_mm', 0.0)) < 0.0
    ):
        base, moving = joints_of(m)
        yield from lines.rows('base_joints_mm', base, 'base frame')
        yield from lines.rows('platform_joints_mm', moving, 'platform frame')
        return
    yield f'  base_radius_mm: {num(m["base_radius_mm"])}'
    yield line(f'  base_angle_deg: {num(angles[0][0])}', 'of the first joint')
    yield f'  platform_radius_mm: {num(m["platform_radius_mm"])}'
    yield f'  platform_angle_deg: {num(angles[1][0])}'
    yield line(f'  base_joint_height_mm: {num(m["base_joint_height_mm"])}', 'above the plate')
    yield line(f'  platform_joint_height_mm: {num(m["platform_joint_height_mm"])}', 'below it')


def pulses_text(m: Measures, names: tuple[str, ...], middle: float) -> Iterator[str]:
    """The section servos of drives that push, at `middle` (mm) in the middle of their stroke."""
    first, last = m['pulse_us']
    low, high = sorted((first, last))
    sign, scale = (1 if last > first else -1), (high - low) / m['stroke_mm']
    yield 'servos:'
    yield '  # position = centre_mm + sign · (pulse − centre_us) / us_per_mm'
    yield line(f'  speed_mm_s: {num(m["cylinder_speed_mm_s"])}', 'no load')
    yield '  joints:'
    for k, name in enumerate(names):
        yield (
            f'    - {{name: {name}, channel: {k}, sign: {sign}, '
            f'centre_us: {num((low + high) / 2)}, centre_mm: {num(middle)}, '
            f'us_per_mm: {num(scale, 4)}, pulse_range_us: {lines.row((low, high))}}}'
        )


def _dynamics(m: Measures, scale: float) -> Iterator[str]:
    yield from platform_dynamics(m, scale)
    for part, length in (('cylinder', 0.9 * m['retracted_mm']), ('piston', 1.1 * m['stroke_mm'])):
        mass, radius = (40.0, 8.0) if part == 'cylinder' else (16.0, 4.0)
        yield (
            f'  {part}: {{mass_g: {mass}, radius_mm: {radius}, '
            f'length_mm: {num(lines.significant(length))}, source: estimate}}'
        )
    yield drive_text(m)


def drive_text(m: Measures) -> str:
    """The key drive of the section dynamics."""
    force: Any = m['cylinder_force_n']
    rotor = lines.significant(1e3 * force * TO_SPEED / (1e-3 * m['cylinder_speed_mm_s']))
    return (
        f'  drive: {{force_n: {num(force)}, proportional_band_mm: 1.0, backdrive_n: {num(force)}, '
        f'rotor_mass_g: {num(rotor)}, source: "estimate, geared lead screw"}}'
    )
