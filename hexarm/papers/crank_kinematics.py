"""Ranges, volume, crank speeds and the noise experiment of Prokopovich 2019."""

from collections.abc import Iterator

import numpy as np

from hexarm import machines
from hexarm.cli.accuracy import rows, servo_errors
from hexarm.cli.progress import OnProgress
from hexarm.papers.finding import ROTARY, Finding
from manipulator.analysis.inside import joint_rates, ranges
from manipulator.analysis.survey import survey
from manipulator.analysis.volume import bounding_box, volume, with_orientation
from manipulator.arrays import Array
from manipulator.machine import Machine
from manipulator.pose import Pose

MACHINE = 'robocake'
SPEED, ALONG = 0.030, 0.010
RANGES = (
    ('x', 'x range at home height', '±15.6 mm', 15.6, 1e3, 'mm'),
    ('y', 'y range', '−15.1 … 19.6 mm', 19.6, 1e3, 'mm'),
    ('z', 'z range about 41.19 mm', '−17.8 … 17.9 mm', 17.9, 1e3, 'mm'),
    ('yaw', 'φ range, about z', '±0.20 rad', 0.20, 1.0, 'rad'),
    ('roll', 'ψ range, about x', '±0.20 rad', 0.20, 1.0, 'rad'),
    ('pitch', 'θ range, about y', '±0.17 rad', 0.17, 1.0, 'rad'),
)


def findings(draws: int, points: int, with_turns: bool, tell: OnProgress) -> Iterator[Finding]:
    """With draws for the noise, points for the volume; with_turns takes a minute more."""
    machine = machines.load(MACHINE)
    yield home_angle(machine)
    yield from range_findings(machine)
    tell('ranges', 1.0)
    yield from volume_findings(machine, points, with_turns, tell)
    yield from speed_findings(machine)
    yield from noise_findings(machine, draws)
    tell('noise experiment', 1.0)


def home_angle(machine: Machine) -> Finding:
    """Of all six cranks; the formulas as printed would not close."""
    angle = float(np.degrees(machine.kinematics.inverse(machine.kinematics.home)[0]))
    reason = (
        'eq. (8) requires +, eq. (4) the signs, eq. (1) another third column: '
        '[kinematics.md](kinematics.md), 2.1'
    )
    return Finding(
        'home_angle', ROTARY, 'crank angles at home', 'level platform, all alike',
        f'{angle:.4f}° on all six', angle, 1e-4, 'agrees', reason,
    )  # fmt: skip


def range_findings(machine: Machine) -> Iterator[Finding]:
    """Each axis alone, all limits of the machine file kept."""
    found = ranges(machine)
    for key, topic, told, number, factor, unit in RANGES:
        low, high = (factor * v for v in found[key])
        is_same = abs(high - number) < 0.06 * number
        shown = f'{low:.2f} … {high:.2f} {unit}' if unit == 'mm' else f'{low:.3f} … {high:.3f} rad'
        smaller = 'the paper’s range is smaller; rods reach farther'
        reason = 'the same closed geometry' if is_same else smaller
        yield Finding(
            f'range_{key}', ROTARY, topic, told, shown.replace('-', '−'), high, 1e-3 * abs(high),
            'agrees' if is_same else 'partly', reason,
        )  # fmt: skip


def volume_findings(
    machine: Machine, points: int, with_turns: bool, tell: OnProgress
) -> Iterator[Finding]:
    """Positions at home's orientation, and with any orientation up to ±0.5 rad."""
    home = machine.kinematics.home
    reached = with_orientation(machine, home.rotation)
    box = bounding_box(reached, home.position, machine.kinematics.characteristic_length)
    level = volume(reached, box, points, np.random.default_rng(1))
    tell('volume, level', 1.0)
    reason = (
        f'even a box around the whole shape, with a margin, has {1e3 * box.volume:.3f} dm³ only'
    )
    yield Finding(
        'volume', ROTARY, 'workspace, level', '0.64 dm³',
        f'{1e3 * level.value:.5f} ± {1e3 * level.error:.1g} dm³', 1e3 * level.value, 8e-4,
        'contradicts', reason,
    )  # fmt: skip
    if not with_turns:
        return
    found = survey(machine, points, 0.5, tell)
    some = found.some_orientation
    yield Finding(
        'volume_turned', ROTARY, 'workspace, with rotations of up to 0.5 rad', '0.64 dm³',
        f'{1e3 * some.value:.4f} ± {1e3 * some.error:.1g} dm³', 1e3 * some.value, 5e-3,
        'contradicts', 'a twentieth of the paper’s',
    )  # fmt: skip


def crank_speeds(machine: Machine, places: Array) -> Array:
    """Crank rates (N, 6) in °/s while x moves at 30 mm/s through places (N) from home: fig. 9."""
    home = machine.kinematics.home
    twists = np.zeros((len(places), 6))
    twists[:, 0] = places
    poses: Pose = home.moved(twists)
    return np.asarray(np.degrees(SPEED * joint_rates(machine, poses)[..., 0]))


def speed_findings(machine: Machine) -> Iterator[Finding]:
    """At home, and up to 10 mm to either side."""
    speeds = np.abs(crank_speeds(machine, np.linspace(-ALONG, ALONG, 201)))
    middle = float(speeds[100].max())
    worst = float(speeds.max())
    reason = f'{middle:.1f}°/s at home; unbounded at the ends of the range'
    yield Finding(
        'fig_9', ROTARY, 'crank speeds, x at 30 mm/s (fig. 9)', 'a curve without numbers',
        f'≤ {worst:.1f}°/s within ±10 mm', worst, 0.05, 'not stated', reason,
    )  # fmt: skip


def noise_findings(machine: Machine, draws: int) -> Iterator[Finding]:
    """±1° uniform and independent, position error at home, by drawing."""
    errors = servo_errors(machine.kinematics, machines.read(MACHINE), np.radians(1.0))
    for row in rows(machine.kinematics, errors, 1e-4, draws, True):
        if row.paper is None:
            continue
        law, drawn = 1e6 * float(row.linear.position_rms), 1e6 * float(row.drawn.position_rms)
        error = drawn * row.drawn.relative_error
        yield Finding(
            row.cause.replace(' ', '_').replace(',', ''), ROTARY, f'1° {row.cause}: rms error',
            f'{1e6 * row.paper:.1f} µm', f'{law:.1f} µm (drawn: {drawn:.0f} ± {error:.0f})', law,
            0.05, 'contradicts',
            'squares of independent errors add, none cancel; 1° moves a crank’s tip by 0.3 mm',
        )  # fmt: skip
