"""Home, ranges and crank speeds of Prokopovich 2019, section on kinematics and figs 8 and 9."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from hexapod_control.leg_limits import rod_closure
from hexapod_control.rotary import RotaryHexapod
from hexarm import machines
from hexarm.papers.finding import ROTARY, Claim, Finding, minus, unstated
from manipulator.analysis.inside import joint_rates, ranges
from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.limits.constraints import Constraints
from manipulator.limits.machine_limits import BodyHeight
from manipulator.machine import Machine
from manipulator.pose import Pose

MACHINE = 'robocake'
SPEED = 0.030
HOME_ROUNDING = 1e-6
A_TENTH, A_HUNDREDTH = 0.1, 0.01
"""The last digit that the paper prints: mm and rad."""
FURTHER_MM, FURTHER_RAD = 1.0, 0.05
SAME = 'the same closed geometry'
BEYOND = 'the legs close beyond the paper’s range, which is thus on the safe side'
NONLINEAR = 1.5
"""From which ratio of speeds on we call the relation of crank and platform nonlinear."""


def findings() -> Iterator[Finding]:
    """Home, the range of each axis by geometry alone, and crank speeds along x."""
    machine = machines.load(MACHINE)
    yield from home_angle(machine)
    yield from range_findings(machine)
    yield from speed_findings(machine)


def free(machine: Machine, minimum_height: float | None = None) -> Machine:
    """The machine with no limit but that its legs close, as the paper's model has none.

    With minimum_height (m), the platform's centre stays above it. InvalidInput for a machine
    without cranks.
    """
    kinematics = machine.kinematics
    if not isinstance(kinematics, RotaryHexapod):
        raise InvalidInput('this machine has no cranks')
    closures = (rod_closure(kinematics), rod_closure(kinematics, is_surplus=True))
    floor = () if minimum_height is None else (BodyHeight(minimum_height),)
    return replace(machine, constraints=Constraints((*closures, *floor)))


def home_angle(machine: Machine) -> Iterator[Finding]:
    """Of all six cranks."""
    angles = np.degrees(machine.kinematics.inverse(machine.kinematics.home))
    yield Finding(
        'home_alike', ROTARY, 'crank angles at home differ by',
        Claim('level platform, all alike', (0.0,), HOME_ROUNDING),
        f'{np.ptp(angles):.0e}°', (float(np.ptp(angles)),), '°', HOME_ROUNDING,
        'only the misprint of eq. (8) is fatal (EC² is a sum); the third column of eq. (1) is '
        'multiplied by a zero, and the abs() of eq. (4) changes no angle of the paper’s ranges: '
        '[kinematics.md](kinematics.md), 2.1',
    )  # fmt: skip
    yield Finding(
        'home_angle', ROTARY, 'crank angle at home', unstated(), f'{angles[0]:.4f}°',
        (float(angles[0]),), '°', 1e-4, 'the branch with the elbow out',
    )  # fmt: skip


def range_findings(machine: Machine) -> Iterator[Finding]:
    """Each axis alone, by closed legs alone."""
    found = ranges(free(machine))
    yield _range('x', 'x range at home height', '±15.6 mm', (-15.6, 15.6), found['x'], SAME)
    yield _range('y', 'y range', '−15.1 … 19.6 mm', (-15.1, 19.6), found['y'], SAME)
    low, high = (1e3 * v for v in found['z'])
    yield Finding(
        'range_z_up', ROTARY, 'z range about 41.19 mm, upper end',
        Claim('17.9 mm', (17.9,), A_TENTH, FURTHER_MM), f'{high:.2f} mm', (high,), 'mm', 1e-3,
        SAME,
    )  # fmt: skip
    yield Finding(
        'range_z_down', ROTARY, 'z range, lower end',
        Claim('−17.8 mm', (-17.8,), A_TENTH, FURTHER_MM), minus(f'{low:.2f} mm'), (low,), 'mm',
        1e-3, 'the legs close down through the body: the paper’s end must be the lid of the '
        'body; the machine file takes its minimum height from the paper, so that cannot agree '
        'or disagree',
    )  # fmt: skip
    turns = (
        ('yaw', 'φ range, about z', '±0.20 rad', 0.20, SAME),
        ('roll', 'ψ range, about x', '±0.20 rad', 0.20, BEYOND),
        ('pitch', 'θ range, about y', '±0.17 rad', 0.17, f'{BEYOND}; 0.240/√2 is 0.170'),
    )
    for key, topic, text, most, reason in turns:
        yield _range(key, topic, text, (-most, most), found[key], reason)


def _range(
    key: str, topic: str, text: str, ends: tuple[float, float], found: tuple[float, float],
    reason: str,
) -> Finding:  # fmt: skip
    is_length = key in 'xyz'
    factor, unit = (1e3, 'mm') if is_length else (1.0, 'rad')
    values = (factor * found[0], factor * found[1])
    digit, further = (A_TENTH, FURTHER_MM) if is_length else (A_HUNDREDTH, FURTHER_RAD)
    digits = 2 if is_length else 3
    shown = f'{values[0]:.{digits}f} … {values[1]:.{digits}f} {unit}'
    return Finding(
        f'range_{key}', ROTARY, topic, Claim(text, ends, digit, further), minus(shown), values,
        unit, 0.01 * digit, reason,
    )  # fmt: skip


def crank_speeds(machine: Machine, places: Array) -> Array:
    """Crank rates (N, 6) in °/s while x moves at 30 mm/s through places (N) from home: fig. 9."""
    poses = along_x(machine, places)
    return np.asarray(np.degrees(SPEED * joint_rates(machine, poses)[..., 0]))


def along_x(machine: Machine, places: Array) -> Pose:
    """Home moved by places (N) metres along x."""
    return machine.kinematics.home.moved(places[:, None] * np.eye(6)[0])


def speed_findings(machine: Machine) -> Iterator[Finding]:
    """At home, up to 10 mm and up to 15 mm to either side."""
    speeds = np.abs(crank_speeds(machine, np.linspace(-0.015, 0.015, 301))).max(axis=1)
    middle, near, far = float(speeds[150]), float(speeds[50:251].max()), float(speeds.max())
    yield Finding(
        'fig_9', ROTARY, 'crank speeds, x at 30 mm/s (fig. 9)',
        unstated('a curve without numbers'),
        f'{middle:.1f}°/s at home, ≤ {near:.1f}°/s within ±10 mm, ≤ {far:.1f}°/s within ±15 mm',
        (middle, near, far), '°/s', 0.05, 'unbounded at the ends of the range',
    )  # fmt: skip
    yield Finding(
        'fig_9_nonlinear', ROTARY, 'crank speed 15 mm away by that at home',
        Claim('strongly nonlinear', (NONLINEAR,), side='at least'), f'{far / middle:.2f}',
        (far / middle,), '', 1e-3, 'the platform’s speed is the same',
    )  # fmt: skip
