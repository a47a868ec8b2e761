"""What an identification has found, for people and for programs."""

from typing import Any

import numpy as np

from manipulator.analysis.identify import Identification
from manipulator.analysis.measurements import Noise, Parameter
from manipulator.analysis.observability import model_directions, what_is_not_seen
from manipulator.arrays import Array
from manipulator.formatting import counted
from manipulator.pose import Pose

WELL_MEASURED = 2.0
"""Measured numbers for each parameter; with fewer, noise goes into the machine file."""

LARGE_ERRORS = 1.5
UNITS = {'m': (1e3, 'mm'), 'rad': (float(np.degrees(1.0)), '°')}


def in_words(found: Identification, noise: Noise, rigid_motions: dict[str, Array]) -> list[str]:
    """Errors before and after, every parameter, and what is to be doubted."""
    free = found.is_free
    names = tuple(p for p, is_free in zip(found.parameters, free, strict=True) if is_free)
    lines = [
        f'{counted(len(found.after), "pose")}, {counted(len(names), "parameter")}; '
        'errors, rms an axis:',
        f'  before  {_errors(found.before)}  (the machine file, with the best frames)',
        f'  after   {_errors(found.after)}  '
        f'(noise: {1e3 * noise.position:g} mm, {np.degrees(noise.rotation):.3g}°)',
        *_warnings(found, noise, len(names)),
        '',
    ]
    lines += [
        _parameter(p, value, deviation)
        for p, value, deviation in zip(
            found.parameters, found.values, found.deviations, strict=True
        )
        if p in names and p.group not in ('device', 'marker')
    ]
    lines += ['', *_frames(found)]
    if names:
        motions = model_directions(rigid_motions, free)
        dark = what_is_not_seen(found.slopes[:, free], names, found.deviations[free], motions)
        lines += _dark(dark.unseen, dark.vague)
    return lines


def for_programs(found: Identification) -> dict[str, Any]:
    """In SI units."""
    free = found.is_free
    return {
        'poses': len(found.after),
        'rms_before': _rms(found.before),
        'rms_after': _rms(found.after),
        'parameters': {
            p.name: {'change': float(value), 'deviation': float(deviation), 'unit': p.unit}
            for p, value, deviation, is_free in zip(
                found.parameters, found.values, found.deviations, free, strict=True
            )
            if is_free and p.group not in ('device', 'marker')
        },
        'T_device_base': _pose(found.frames.T_device_base),
        'T_platform_marker': _pose(found.frames.T_platform_marker),
    }


def _rms(errors: Array) -> dict[str, float]:
    return {
        'position': float(np.sqrt((errors[:, :3] ** 2).mean())),
        'rotation': float(np.sqrt((errors[:, 3:] ** 2).mean())),
    }


def _errors(errors: Array) -> str:
    rms = _rms(errors)
    return f'{1e3 * rms["position"]:.3f} mm, {np.degrees(rms["rotation"]):.3f}°'


def _warnings(found: Identification, noise: Noise, free: int) -> list[str]:
    """What makes the result doubtful."""
    numbers, lines = found.after.size, []
    if numbers < WELL_MEASURED * free:
        needed = int(np.ceil(WELL_MEASURED * free / 6))
        lines.append(
            f'  few poses: {numbers} numbers for {counted(free, "parameter")}; '
            f'measure {counted(needed, "pose")} or more, or free fewer groups'
        )
    weighted = found.after * noise.weights
    left = max(numbers - free, 1)
    ratio = float(np.sqrt((weighted**2).sum() / left))
    if ratio > LARGE_ERRORS:
        worst = int(np.argmax((weighted**2).sum(axis=1))) + 1
        lines.append(
            f'  the errors that are left are {ratio:.1f} times the noise (worst: measured pose '
            f'{worst}): play in the joints, a mistake in a row, or more noise than given'
        )
    return lines


def _parameter(parameter: Parameter, value: float, deviation: float) -> str:
    factor, unit = UNITS[parameter.unit]
    return f'  {parameter.name:<22} {factor * value:+8.3f} ± {factor * deviation:.3f} {unit}'


def _frames(found: Identification) -> list[str]:
    lines = []
    for name, pose in (
        ('base in the device', found.frames.T_device_base),
        ('marker on the platform', found.frames.T_platform_marker),
    ):
        x, y, z = 1e3 * pose.position
        roll, pitch, yaw = np.degrees(pose.rpy)
        lines.append(
            f'  {name:<22} x {x:.2f}, y {y:.2f}, z {z:.2f} mm; '
            f'roll {roll:.2f}, pitch {pitch:.2f}, yaw {yaw:.2f}°'
        )
    return lines


def _dark(unseen: tuple[str, ...], vague: tuple[str, ...]) -> list[str]:
    lines = []
    if unseen:
        lines += ['', f'The measurements cannot see {counted(len(unseen), "combination")}:']
        lines += [f'  - {name}' for name in unseen]
        lines.append('These change nothing that was measured; they stay near the machine file.')
    if vague:
        lines += ['', f'Hardly better known than before: {", ".join(vague)}']
    return lines


def _pose(pose: Pose) -> dict[str, list[float]]:
    return {'xyz': pose.position.tolist(), 'quaternion_xyzw': pose.quaternion.tolist()}
