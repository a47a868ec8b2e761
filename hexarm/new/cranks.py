"""Crank hexapods from the measures that people have: joints, tangents, home height, limits."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from hexapod_control.geometry import HexagonConfig
from hexarm.new import lines
from hexarm.new.lines import line, num
from hexarm.new.platforms import (
    Measures,
    around,
    joints_of,
    machine_of,
    platform_dynamics,
    radius_of,
    scales,
    servo_of,
    side_of,
)
from hexarm.new.servos import Servo
from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.machine import Machine

TO_SPEED = 0.003
"""Seconds in which a servo's rotor gets up to speed (estimate)."""
PAPER_KEYS = (
    'body_radius_mm', 'crank_offset_mm', 'crank_shift_mm', 'joint_inset_mm', 'joint_shift_mm',
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Cranks:
    """Where the horns' axes, the level horns (unit vectors) and the platform's joints are (mm)."""

    centres: Array
    horns: Array
    joints: Array


def cranks_of(m: Measures) -> Cranks:
    """By the paper's parameters, circles or coordinates."""
    if m['given_by'] == 'paper':
        config = HexagonConfig(
            **{key: m[key] for key in PAPER_KEYS}, crank_length_mm=m['horn_length_mm'],
            rod_length_mm=m['rod_length_mm'], home_height_mm=1.0,
        )  # fmt: skip
        found = config.geometry()
        return Cranks(1e3 * found.crank_centres, -found.tangents, 1e3 * found.platform_points)
    turn = np.radians(around(m['horn_direction_deg']))
    horns = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(6)])
    base, moving = joints_of(m)
    return Cranks(base, horns, moving)


def level_height(cranks: Cranks, horn: float, rod: float) -> float:
    """The height at which the horns are level (mean of all legs); InvalidInput for short rods."""
    tips = cranks.centres + horn * cranks.horns
    across = np.linalg.norm((tips - cranks.joints)[:, :2], axis=1)
    worst = int(np.round(across, 6).argmax())
    if across[worst] >= rod:
        raise InvalidInput(
            f'rod_length_mm: {rod:g} mm, but leg {worst + 1} has {across[worst]:.1f} mm from the '
            "level horn's end to the platform's joint, seen from above: look at the order of the "
            'joints, horn_direction_deg and the radii'
        )
    heights = cranks.centres[:, 2] + np.sqrt(rod**2 - across**2) - cranks.joints[:, 2]
    return float(heights.mean())


def crank_text(m: Measures) -> Iterator[str]:
    """The machine file of a crank hexapod."""
    cranks, servo = cranks_of(m), servo_of(m)
    if servo.pulse_us and m['horn_travel_deg'] > servo.travel_deg:
        raise InvalidInput(
            f'horn_travel_deg: {m["horn_travel_deg"]:g}°, the servo turns '
            f'{servo.travel_deg:g}° at most'
        )
    machine, scale = _made(m, cranks), radius_of(cranks.joints)
    home = np.degrees(machine.kinematics.inverse(machine.kinematics.home))
    middle = np.round(_middle(m, home), 1)
    yield from lines.head('rotary_hexapod', m['description'], servo.pulse_us is None)
    yield ''
    yield from _geometry(m, cranks, machine, home)
    yield ''
    yield from _limits(m, cranks, machine, middle)
    yield ''
    yield from lines.motion(machine, lines.RATED * servo.speed_deg_s, 'deg')
    if servo.pulse_us:
        yield ''
        signs = _signs(cranks, side_of(m))
        yield from lines.servos(machine.kinematics.joint_names, signs, middle, servo)
        yield line(f'  park_deg: {lines.row(np.round(home, 2))}', 'where they are switched on')
        yield ''
        yield from lines.link('hysteresis_deg: 0.5')
    yield ''
    yield from _crank_dynamics(m, servo, scale)


def _made(m: Measures, cranks: Cranks) -> Machine:
    """The machine, with limits that are wide open."""
    horn, rod, height = m['horn_length_mm'], m['rod_length_mm'], m['home_height_mm']
    if height == 'auto':
        height = level_height(cranks, horn, rod)
    geometry = {
        'crank_centres_mm': cranks.centres.tolist(),
        'crank_tangents': (-side_of(m) * cranks.horns).tolist(),
        'platform_joints_mm': cranks.joints.tolist(),
        'crank_length_mm': horn,
        'rod_length_mm': rod,
        'home_height_mm': round(height, 3),
    }
    limits = {
        'crank_range_deg': [0.0, 360.0] if side_of(m) > 0.0 else [-180.0, 180.0],
        'minimum_height_mm': height - 3 * (horn + rod),
        'platform_joint_swing_deg': 180.0,
        'crank_joint_tilt_deg': 90.0,
        'singularity_margin': 0.001,
        'characteristic_length_mm': radius_of(cranks.joints),
    }
    return machine_of('rotary_hexapod', geometry, limits)


def _geometry(m: Measures, cranks: Cranks, machine: Machine, home: Array) -> Iterator[str]:
    yield 'geometry:'
    if m['given_by'] == 'paper':
        for key in PAPER_KEYS:
            yield f'  {key}: {num(m[key])}'
    else:
        tangents = -side_of(m) * cranks.horns
        yield from lines.rows('crank_centres_mm', cranks.centres, "axis and the rod end's plane")
        yield from lines.rows('crank_tangents', tangents, 'angle 0: by horn_direction_deg', 6)
        yield from lines.rows('platform_joints_mm', cranks.joints, 'platform frame')
    yield line(f'  crank_length_mm: {num(m["horn_length_mm"])}', "servo's axis to rod end")
    yield line(f'  rod_length_mm: {num(m["rod_length_mm"])}', 'between the joints')
    spread = f'cranks at {home.min():.1f} … {home.max():.1f}°' if np.ptp(home) > 0.1 else (
        f'all cranks at {home.mean():.1f}°')  # fmt: skip
    yield line(f'  home_height_mm: {num(1e3 * machine.kinematics.home.position[2])}', spread)


def _limits(m: Measures, cranks: Cranks, machine: Machine, middle: Array) -> Iterator[str]:
    side, travel = side_of(m), m['horn_travel_deg']
    ends = np.column_stack([middle - travel / 2, middle + travel / 2])
    base, height = cranks.centres[:, 2].mean(), 1e3 * machine.kinematics.home.position[2]
    lowest = (base + height) / 2 if side > 0.0 else height - m['horn_length_mm']
    swing = num(m['joint_swing_deg'])
    yield 'limits:'
    level = 180 if side > 0.0 else 0
    yield lines.pairs('crank_range_deg', ends, f'{travel:g}° in all; level is {level}°')
    yield line(f'  minimum_height_mm: {num(lowest, 1)}', 'assumed: where would the platform hit?')
    yield line(f'  platform_joint_swing_deg: {swing}', 'of a rod, from home')
    yield line(f'  crank_joint_tilt_deg: {swing}', "out of its horn's plane")
    yield from scales(machine, radius_of(cranks.joints))


def _middle(m: Measures, home: Array) -> Array:
    """The crank angles in the middle of the travel."""
    above = m['horn_at_middle_deg']
    if above == 'auto':
        return home
    return np.full(6, 180.0 - above if side_of(m) > 0.0 else above)


def _signs(cranks: Cranks, side: float) -> Array:
    """1 where a longer pulse turns the crank on, of servos whose shafts point outwards.

    Such a servo turns counter-clockwise, seen from outside, as its pulse grows.
    """
    normals = np.cross(-side * cranks.horns, [0.0, 0.0, 1.0])
    outwards = (normals * (cranks.centres - cranks.centres.mean(axis=0))).sum(axis=1)
    return np.where(outwards >= 0.0, 1, -1)


def _crank_dynamics(m: Measures, servo: Servo, scale: float) -> Iterator[str]:
    torque = servo.torque_n_m
    rotor = lines.significant(1e9 * torque * TO_SPEED / np.radians(servo.speed_deg_s))
    size = num(lines.significant(6.0 * (servo.mass_g / 9.0) ** (1 / 3)))
    length = num(lines.significant(23.0 * (servo.mass_g / 9.0) ** (1 / 3)))
    yield from platform_dynamics(m, scale)
    yield '  crank: {mass_g: 2.0, radius_mm: 2.5, source: estimate}'
    yield '  rod: {mass_g: 4.0, radius_mm: 1.5, source: estimate}'
    yield (
        f'  servo: {{mass_g: {num(servo.mass_g)}, radius_mm: {size}, length_mm: {length}, '
        'source: estimate}'
    )
    yield '  drive:'
    yield line(f'    torque_n_m: {num(torque, 4)}', f'at standstill, {servo.note}')
    yield '    proportional_band_deg: 3.0'
    yield f'    backdrive_n_m: {num(torque / 6, 4)}'
    yield line(f'    rotor_inertia_g_mm2: {num(rotor)}', '3 ms to get up to speed')
    yield f'    source: "torque: {m["servo"]}; the rest: estimate"'
