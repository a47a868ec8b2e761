"""Lines of a machine file: numbers as YAML takes them, comments in one column."""

import json
from collections.abc import Iterable, Iterator

import numpy as np

from hexarm.new.servos import Servo
from manipulator.arrays import Array
from manipulator.machine import Machine

COLUMN = 35
RATED, RAMP, ARM_RAMP = 0.8, 0.05, 0.25
"""Of a servo's no-load speed, how much is asked for; seconds to that, and of an arm's joint."""
EASE, SOFT_RAMP, SOFT_JERK = 0.5, 0.1, 0.05
"""Of what the joints allow at home, how much the platform asks for; seconds to speed and force."""
SINGULAR = 1e-3
"""Of the Jacobian's largest singular value, what counts as none."""
MOST_MM_S, MOST_DEG_S = 250.0, 180.0
"""However fast the joints are: 250 mm/s is what ISO 10218 allows beside people."""


def line(text: str, comment: str = '') -> str:
    """With its comment, if there is one."""
    return f'{text:<{COLUMN - 2}}  # {comment}' if comment else text


def num(value: float, digits: int = 3) -> str:
    """Rounded, with a point."""
    return repr(round(float(value), digits) + 0.0)


def row(values: Iterable[float], digits: int = 3) -> str:
    """A flow list."""
    return f'[{", ".join(num(value, digits) for value in values)}]'


def rows(key: str, points: Array, comment: str, digits: int = 3) -> Iterator[str]:
    """A list of six points."""
    yield line(f'  {key}:', comment)
    for point in points:
        yield f'    - {row(point, digits)}'


def pairs(key: str, ends: Array, comment: str) -> str:
    """A range of all joints, or of each where they differ; ends (6, 2)."""
    if np.ptp(ends, axis=0).max() == 0.0:
        return line(f'  {key}: {row(ends[0])}', comment)
    return line(f'  {key}: [{", ".join(map(row, ends))}]', comment)


def significant(value: float) -> float:
    """To two digits."""
    return float(f'{value:.2g}')


def motion(machine: Machine, joint_speed: float, unit: str, ramp: float = RAMP) -> Iterator[str]:
    """The section motion: what the joints allow at home, along and about the slowest axis.

    joint_speed: asked of every joint, in the file's unit, 'deg' or 'mm'; ramp: seconds to it.
    """
    kinematics = machine.kinematics
    home = kinematics.home
    jacobian = kinematics.jacobian(home, kinematics.inverse(home))
    rates = np.linalg.pinv(jacobian, rcond=SINGULAR)  # an arm may be singular at home
    per_twist = np.abs(rates).max(axis=0)
    most = np.radians(joint_speed) if unit == 'deg' else 1e-3 * joint_speed
    linear = min(EASE * 1e3 * most / per_twist[:3].max(), MOST_MM_S)
    angular = min(EASE * np.degrees(most / per_twist[3:].max()), MOST_DEG_S)
    yield line('motion:', 'half of what the joints allow at home; make it slower at will')
    for name, fastest, of in (('linear', linear, 'mm'), ('angular', angular, 'deg')):
        speed = significant(fastest)
        yield f'  {name}_speed_{of}_s: {num(speed)}'
        yield f'  {name}_acceleration_{of}_s2: {num(significant(speed / SOFT_RAMP))}'
        yield f'  {name}_jerk_{of}_s3: {num(significant(speed / SOFT_RAMP / SOFT_JERK))}'
    yield f'  joint_speed_{unit}_s: {num(joint_speed)}'
    yield f'  joint_acceleration_{unit}_s2: {num(significant(joint_speed / ramp))}'


def servos(names: Iterable[str], signs: Array, centres: Array, servo: Servo) -> Iterator[str]:
    """The sections servos and link of servos that turn; centres (n,) in degrees."""
    low, high = servo.pulse_us or (0.0, 0.0)
    yield 'servos:'
    yield '  # position = centre_deg + sign · (pulse − centre_us) / us_per_deg. Signs and centres'
    yield '  # are by the drawing: `hexarm calibrate servos` sets them right by the machine.'
    yield line(f'  speed_deg_s: {num(servo.speed_deg_s, 1)}', f'no load, {servo.note}')
    yield '  joints:'
    for k, (name, sign, centre) in enumerate(zip(names, signs, centres, strict=True)):
        yield (
            f'    - {{name: {name}, channel: {k}, sign: {int(sign)}, '
            f'centre_us: {num((low + high) / 2)}, centre_deg: {num(centre)}, '
            f'us_per_deg: {num(servo.us_per_deg, 4)}, pulse_range_us: {row((low, high))}}}'
        )


def link(play: str) -> Iterator[str]:
    """The section of the serial line, and the fake board's; play: its key and value there."""
    yield 'link:'
    yield '  baud: 250000'
    yield line('  setpoint_deadline_ms: 200', 'how long a setpoint is good for')
    yield line('  on_link_loss: hold', 'hold or release, when no other came in time')
    yield ''
    yield line('simulation:', "what the fake board's servos do")
    yield line(f'  {play}', 'assumed: play')


def head(kind: str, description: str, is_by_driver: bool) -> Iterator[str]:
    """The first lines."""
    yield '# Made by hexarm new; millimetres and degrees. All keys: docs/machine-files.md.'
    yield '# What is marked "assumed" was not asked: look at it before the machine moves.'
    yield f'kind: {kind}'
    yield f'description: {json.dumps(description, ensure_ascii=False)}'
    if is_by_driver:
        yield line('driver: topic', 'other software moves the joints: docs/actuators.md')
