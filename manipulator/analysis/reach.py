"""Whether a machine reaches a pose, by which limits not, and by how much; also in one line."""

from dataclasses import dataclass

import numpy as np

from manipulator.analysis.free_paths import is_connected
from manipulator.analysis.nearest import nearest_reachable
from manipulator.analysis.readings import LimitReading
from manipulator.analysis.slope import slopes
from manipulator.arrays import Array
from manipulator.errors import Unreachable
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.unit_hints import hint_at_metres


@dataclass(frozen=True)
class Reach:
    """The answer for one pose.

    is_admitted: it closes and keeps every limit; is_connected: a path from home was found. limits
    holds a reading for every value that exists, the nearest limit first: what is broken, the
    farthest out first, comes before what is kept. Values that a leg which does not close leaves
    undefined are missing. reason is empty for a reachable pose.
    """

    is_admitted: bool
    is_connected: bool
    limits: tuple[LimitReading, ...]
    reason: str

    @property
    def is_reachable(self) -> bool:
        """Whether the machine can go there from home without leaving its limits."""
        return self.is_admitted and self.is_connected

    @property
    def broken(self) -> tuple[LimitReading, ...]:
        """The limits that are broken."""
        return tuple(r for r in self.limits if r.margin < 0.0) if not self.is_admitted else ()


def reach(machine: Machine, pose: Pose, near: Array | None = None) -> Reach:
    """Which limits one pose meets, on the branch nearest to `near` (default: home's).

    Connection is judged as `free_paths.is_connected` does.
    """
    limits = readings(machine, pose, near)
    try:
        with hint_at_metres(machine.kinematics, pose):
            machine.constraints.check(pose, machine.kinematics.inverse(pose, near))
    except Unreachable as error:
        return Reach(False, False, limits, str(error))
    connected = is_connected(machine, pose)
    reason = '' if connected else 'keeps all limits, but no path from home that does was found'
    return Reach(True, connected, limits, reason)


def readings(machine: Machine, pose: Pose, near: Array | None = None) -> tuple[LimitReading, ...]:
    """Every limit that has a value at one pose, the nearest first; endless joints have none."""
    found = slopes(machine, pose, near)
    names, values = found.readings.names, found.readings.values
    margins = found.readings.margins.reshape(2, -1)
    nearer, columns = np.argmin(margins, axis=0), np.arange(len(values))
    margin, slope = margins[nearer, columns], found.steepness.reshape(2, -1)[nearer, columns]
    with np.errstate(divide='ignore', invalid='ignore'):
        distance = np.where(slope > 0.0, margin / slope, np.copysign(np.inf, margin))
    low, high = found.readings.low, found.readings.high
    exists = np.isfinite(values) & (np.isfinite(low) | np.isfinite(high))
    order = [k for k in np.argsort(distance, kind='stable') if exists[k]]
    return tuple(
        LimitReading(
            quantity=names[k][0],
            owner=names[k][1],
            unit=names[k][2],
            value=float(values[k]),
            low=float(low[k]),
            high=float(high[k]),
            distance=float(distance[k]),
        )
        for k in order
    )


def smallest_margins(machine: Machine, count: int = 3) -> tuple[LimitReading, ...]:
    """Of home: the smallest of each limited quantity, of the `count` nearest quantities."""
    smallest: dict[str, LimitReading] = {}
    for reading in readings(machine, machine.kinematics.home):
        known = smallest.setdefault(reading.quantity, reading)
        if reading.margin < known.margin:
            smallest[reading.quantity] = reading
    return tuple(smallest.values())[:count]


def explained(machine: Machine, pose: Pose, near: Array | None = None) -> str:
    """The reason and the nearest reachable pose; empty where the pose is reachable.

    Takes some 5 ms: for the answer to a question, not for a control tick.
    """
    reason = reach(machine, pose, near).reason
    if not reason:
        return ''
    return f'{reason}; nearest reachable: {pose_in_words(nearest_reachable(machine, pose).pose)}'


def pose_in_words(pose: Pose) -> str:
    """As 'x 14.200  y 0.000  z 41.190 mm  roll 0.00  pitch 0.00  yaw 0.00°'."""
    # + 0.0 turns −0 into 0
    places = zip('xyz', np.round(1e3 * pose.position, 3) + 0.0, strict=True)
    angles = zip(('roll', 'pitch', 'yaw'), np.round(np.degrees(pose.rpy), 2) + 0.0, strict=True)
    return (
        '  '.join(f'{n} {v:.3f}' for n, v in places)
        + ' mm  '
        + '  '.join(f'{n} {v:.2f}' for n, v in angles)
        + '°'
    )
