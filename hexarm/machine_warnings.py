"""What is doubtful in a valid machine file: a home on the other branch, odd pulses."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from bridge.calibration import COUNTS_PER_US, Calibration
from hexapod_control.geometry import RotaryGeometry
from hexapod_control.rotary import RotaryHexapod
from manipulator.arrays import Array, Mask
from manipulator.formatting import length
from manipulator.limits.machine_limits import JointRange
from manipulator.machine import Machine

LEVEL, NEARLY_LEVEL, TILTED = np.radians(2.0), np.radians(10.0), np.radians(20.0)
"""How far a crank or a tangent is from level, in either direction, to count as such; as tilted."""

ASIDE, FAR, NEAR = 0.2, 0.5, 0.2
"""Distances from the middle of a joint's range, as shares of half the range."""

UNEVEN = 300.0
"""Between what is allowed of the platform in moves and in turns, in the same unit."""

WIDEST = np.radians(270.0)
"""Of a crank range whose middle is significant: a wider one is just left open."""

PULSES_US = (450.0, 2550.0)
"""What hobby servos take, about 500 to 2500 µs; other centres are counts of other drives."""

US_PER_DEG = (5.5, 11.2)
"""Of servos that turn about 180° within 1000 to 2000 µs, from a third to all of it."""

SINGULAR = 0.01
"""Smallest singular value below which home counts as singular; those of shipped homes: 0.25 up."""

RADIANS = {'a right angle': np.pi / 2, 'half a turn': np.pi, 'a turn': 2 * np.pi}
ROUNDED = 1e-3
"""Share by which an angle in radians may be rounded, as in 3.14 or 1.5708."""

GEARED_US = 700.0
"""So far from its centre goes a pulse that fills what there is: a geared servo, or a winch's."""


def warnings_of(
    machine: Machine, calibration: Calibration | None, geometry: Mapping[str, Any]
) -> list[str]:
    """One sentence for each doubt about a machine without problems; geometry is its section."""
    found = [*_assumed_planes(machine, geometry), *_other_bend(machine)]
    found += [*_uneven_motion(machine), *_singular_home(machine), *_tiny_ranges(machine)]
    if calibration is not None:
        found += _pulses(machine, calibration)
    return found


def joint_range(machine: Machine) -> JointRange | None:
    """The machine's limit of its joints' travel."""
    return next((x for x in machine.constraints.limits if isinstance(x, JointRange)), None)


def _assumed_planes(machine: Machine, geometry: Mapping[str, Any]) -> Iterator[str]:
    """Tangents that are not level, of cranks that turn in vertical planes for want of an axis."""
    if 'crank_tangents' not in geometry or 'crank_axes' in geometry:
        return
    kinematics = machine.kinematics
    if isinstance(kinematics, RotaryHexapod):
        slopes = np.arcsin(kinematics.geometry.tangents[:, 2])
        legs = np.flatnonzero(np.abs(slopes) > LEVEL)
        if legs.size:
            yield (
                f'geometry.crank_tangents: {_names(kinematics.joint_names, legs.tolist())} at '
                f'{_degrees(slopes[legs])} to level, and without crank_axes every crank turns in '
                'the vertical plane of its tangent: if the planes are tilted, give crank_axes'
            )


def _singular_home(machine: Machine) -> Iterator[str]:
    """A home in which an arm is stretched, or two of its axes are in line; often all zeros."""
    kinematics = machine.kinematics
    margin = float(kinematics.sigma_min(kinematics.home, kinematics.inverse(kinematics.home)))
    if margin < SINGULAR:
        yield (
            f'geometry: home is a singular posture (singularity margin {margin:.3f}): from there '
            'no line leads in some directions, and the reach from home is small; choose another'
        )


def _tiny_ranges(machine: Machine) -> Iterator[str]:
    """Joints of an arm none of which leaves zero by more degrees than a turn has radians."""
    limit, kinematics = joint_range(machine), machine.kinematics
    if limit is None or isinstance(kinematics, RotaryHexapod) or kinematics.joint_unit != 'rad':
        return
    farthest = np.degrees(np.abs([limit.low, limit.high]).max())
    if farthest < 2 * np.pi * (1.0 + ROUNDED):
        yield f'limits: no joint goes beyond {farthest:.3g}°: are the ranges in radians?'


def radians_for_degrees(section: object, place: str = '') -> dict[str, str]:
    """A sentence for each key in degrees that holds a right angle or a turn in radians."""
    if isinstance(section, list):
        found = [radians_for_degrees(value, place) for value in section]
        return {key: text for each in reversed(found) for key, text in each.items()}
    if isinstance(section, Mapping):
        found = [radians_for_degrees(v, f'{place}.{k}'.lstrip('.')) for k, v in section.items()]
        return {key: text for each in found for key, text in each.items()}
    if not place.endswith('_deg') or 'us_per' in place or not isinstance(section, int | float):
        return {}
    for name, turn in RADIANS.items():
        if abs(abs(section) - turn) < ROUNDED * turn:
            meant = f'{section:g}° would be {name} in radians: is it in another unit?'
            return {place: f'{place}: {meant}'}
    return {}


def _other_bend(machine: Machine) -> Iterator[str]:
    """Cranks that home tilts, while the other bend has them level or in mid-range.

    So it is where a machine was described mirrored, or its crank angles were counted backwards.
    """
    kinematics, limit = machine.kinematics, joint_range(machine)
    if not isinstance(kinematics, RotaryHexapod) or limit is None:
        return
    bends = kinematics.inverse_all(kinematics.home)
    home, other = bends[0], bends[-1]
    legs = np.flatnonzero(_is_doubtful(kinematics.geometry, home, other, limit))
    if legs.size:
        middles = np.unique((limit.low + limit.high)[legs] / 2)
        yield (
            f'home has {_names(kinematics.joint_names, legs.tolist())} at {_degrees(home[legs])}, '
            f'in a range with its middle at {_degrees(middles)}; '
            f'on the other branch: {_degrees(other[legs])}. '
            'Is a crank tangent, or the whole, mirrored?'
        )


def _is_doubtful(geometry: RotaryGeometry, home: Array, other: Array, limit: JointRange) -> Mask:
    half, middle = (limit.high - limit.low) / 2, (limit.high + limit.low) / 2
    aside, other_aside = (np.abs(_wrapped(q - middle)) / half for q in (home, other))
    tilt, slope = (
        np.abs(np.arcsin(np.cos(q) * geometry.tangents[:, 2] + np.sin(q) * geometry.ups[:, 2]))
        for q in (home, other)
    )
    is_level = (slope < LEVEL) & (aside > ASIDE) | (slope < NEARLY_LEVEL) & (aside > FAR)
    is_central = (other_aside < NEAR) & (aside > FAR) & (2 * half <= WIDEST)
    doubtful: Mask = (aside <= 1.0) & (tilt > TILTED) & (is_level | is_central)
    return doubtful


def _uneven_motion(machine: Machine) -> Iterator[str]:
    """Moves that are far slower or faster than turns: one of both may be in another unit."""
    size, motion = machine.kinematics.characteristic_length, machine.motion
    for name, unit in {'speed': 'mm/s', 'acceleration': 'mm/s²', 'jerk': 'mm/s³'}.items():
        moves, turns = (1e3 * getattr(d, name) for d in (motion.linear, motion.angular))
        if not 1.0 / UNEVEN < moves / (turns * size) < UNEVEN:
            yield (
                f'motion: linear {name} {moves:.4g} {unit}, while the angular {name} makes '
                f'{turns * size:.4g} {unit} at the characteristic length of {length(size)}: '
                'is one of them in another unit?'
            )


def _pulses(machine: Machine, calibration: Calibration) -> Iterator[str]:
    """Servos whose pulses leave what servos take, or turn too little or too much a microsecond."""
    limit, names = joint_range(machine), machine.kinematics.joint_names
    if limit is None or not set(names) <= set(calibration.names):
        return
    order = [calibration.names.index(name) for name in names]
    centre_us = calibration.centre_count[order] / COUNTS_PER_US
    scale = calibration.scale[order] / COUNTS_PER_US
    ends = centre_us + scale * (np.stack([limit.low, limit.high]) - calibration.centre[order])
    is_servo = (centre_us > PULSES_US[0]) & (centre_us < PULSES_US[1])
    # Pulses that leave pulse_range_us are a problem already.
    own = (np.array(c)[order] / COUNTS_PER_US for c in (calibration.lowest, calibration.highest))
    low, high = np.clip((ends.min(axis=0), ends.max(axis=0)), *own)
    beyond = is_servo & ((low < PULSES_US[0]) | (high > PULSES_US[1]))
    for joints in _alike(beyond, low, high):
        yield (
            f'servos.joints: the range of {_names(names, joints)} needs pulses of '
            f'{low[joints[0]]:.0f} to {high[joints[0]]:.0f} µs, hobby servos take about 500 to '
            f'2500: is us_per_{"deg" if calibration.unit == "rad" else "mm"} right?'
        )
    if calibration.unit != 'rad':
        return
    per_deg = np.abs(scale) * np.radians(1.0)
    is_geared = np.maximum(high - centre_us, centre_us - low) >= GEARED_US
    fits = (per_deg >= US_PER_DEG[0]) & (per_deg <= US_PER_DEG[1]) | is_geared
    for joints in _alike(is_servo & ~beyond & ~fits, per_deg, low, high):
        yield (
            f'servos.joints: {_names(names, joints)} at {per_deg[joints[0]]:.3g} µs/deg, pulses '
            f'of only {low[joints[0]]:.0f} to {high[joints[0]]:.0f} µs in use; hobby servos have '
            f'{US_PER_DEG[0]} to {US_PER_DEG[1]} µs/deg, unless geared: is us_per_deg right?'
        )


def _alike(chosen: Mask, *values: Array) -> Iterator[list[int]]:
    """The chosen joints, those with the same values together."""
    groups: dict[tuple[float, ...], list[int]] = {}
    for i in np.flatnonzero(chosen).tolist():
        groups.setdefault(tuple(round(float(v[i]), 3) for v in values), []).append(i)
    yield from groups.values()


def _names(names: Sequence[str], joints: Sequence[int]) -> str:
    return ', '.join(names[i] for i in joints)


def _degrees(angles: Array) -> str:
    return ', '.join(f'{angle:.1f}°' for angle in np.degrees(angles) + 0.0)


def _wrapped(angles: Array) -> Array:
    """Within half a turn of zero."""
    wrapped: Array = np.remainder(angles + np.pi, 2 * np.pi) - np.pi
    return wrapped
