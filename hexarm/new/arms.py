"""Serial arms from a Denavit–Hartenberg table."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from arm_control.geometry import DhConfig, ModifiedDhConfig, placed
from arm_control.load import arm
from hexarm.arm_import import LENGTH_SHARE, ONSET, posture, reach_of
from hexarm.new import lines
from hexarm.new.lines import line, num, row
from hexarm.new.platforms import STAND_IN, Measures, servo_of
from manipulator.arrays import Array
from manipulator.config import build
from manipulator.errors import InvalidInput
from manipulator.machine import Machine, MachineFile

KEYS = ('a_mm', 'alpha_deg', 'd_mm', 'offset_deg')
FORMS: dict[str, tuple[str, str, Any]] = {
    'dh': ('dh', 'standard Denavit–Hartenberg', DhConfig),
    'modified_dh': ('modified_dh', 'modified Denavit–Hartenberg (Craig)', ModifiedDhConfig),
}


def arm_text(m: Measures) -> Iterator[str]:
    """The machine file of an arm."""
    servo, ends = servo_of(m), _ranges(m['joint_ranges_deg'])
    if servo.pulse_us and np.ptp(ends, axis=1).max() > servo.travel_deg:
        raise InvalidInput(
            f'joint_ranges_deg: {np.ptp(ends, axis=1).max():g}°, the servo turns '
            f'{servo.travel_deg:g}° at most'
        )
    speed = lines.RATED * servo.speed_deg_s if servo.pulse_us else servo.speed_deg_s
    geometry, length = _geometry(m, ends)
    machine = _made(geometry, length, ends, speed)
    home = geometry['home_deg']
    yield from lines.head('serial_arm', m['description'], servo.pulse_us is None)
    yield ''
    yield from _geometry_text(m, geometry)
    yield ''
    yield from _limits(length, ends, speed)
    yield ''
    yield from lines.motion(machine, speed, 'deg', lines.ARM_RAMP)
    if servo.pulse_us:
        names = machine.kinematics.joint_names
        yield ''
        yield from lines.servos(names, np.ones(6), ends.mean(axis=1), servo)
        yield line(f'  park_deg: {row(home)}', 'where they are switched on')
        yield ''
        yield from lines.link('hysteresis_deg: 0.5')


def _geometry(m: Measures, ends: Array) -> tuple[dict[str, Any], float]:
    """The section, with home, and what one radian counts (m)."""
    key, _, schema = FORMS[m['given_by']]
    table = [dict(zip(KEYS, each, strict=False)) for each in m['dh_table']]
    geometry = {key: table, 'tool_mm': m['tool_mm'], 'home_deg': [0.0] * 6}
    chain = placed(build(schema, geometry, 'geometry').chain())
    length = LENGTH_SHARE * reach_of(chain)
    low, high = np.radians(ends).T
    chosen = np.round(np.degrees(posture(chain, low, high, length)), 3).tolist()
    home = chosen if m['home_deg'] == 'auto' else m['home_deg']
    return {**geometry, 'home_deg': home}, length


def _geometry_text(m: Measures, geometry: dict[str, Any]) -> Iterator[str]:
    key, form, _ = FORMS[m['given_by']]
    yield 'geometry:'
    yield line(f'  {key}:', form)
    for each in geometry[key]:
        yield f'    - {{{", ".join(f"{name}: {num(each[name], 6)}" for name in each)}}}'
    yield line(f'  tool_mm: {num(m["tool_mm"])}', 'along z of the last frame')
    chosen = 'assumed: not near a singular posture' if m['home_deg'] == 'auto' else ''
    yield line(f'  home_deg: {row(geometry["home_deg"])}', chosen)


def _ranges(numbers: list[float]) -> Array:
    if len(numbers) not in (2, 12):
        raise InvalidInput(f'joint_ranges_deg: {len(numbers)} numbers, needs 2 or 12')
    pairs = np.reshape(numbers, (-1, 2))
    return np.sort(np.broadcast_to(pairs, (6, 2)), axis=1)


def _limits(length: float, ends: Array, speed: float) -> Iterator[str]:
    yield 'limits:'
    yield line(f'  characteristic_length_mm: {num(1e3 * length, 0)}', 'assumed: a quarter of all '
               'links')  # fmt: skip
    yield line(f'  damping_onset: {ONSET}', 'assumed: from where a posture is near to singular')
    yield '  joints:'
    for each in ends:
        acceleration = num(lines.significant(speed / lines.ARM_RAMP))
        yield (
            f'    - {{range_deg: {row(each)}, speed_deg_s: {num(speed)}, '
            f'acceleration_deg_s2: {acceleration}}}'
        )


def _made(geometry: dict[str, object], length: float, ends: Array, speed: float) -> Machine:
    joint = {'speed_deg_s': speed, 'acceleration_deg_s2': 10 * speed}
    limits = {
        'characteristic_length_mm': 1e3 * length, 'damping_onset': ONSET,
        'joints': [{'range_deg': each.tolist(), **joint} for each in ends],
    }  # fmt: skip
    return arm(MachineFile('serial_arm', geometry, limits, STAND_IN, driver='topic'))
