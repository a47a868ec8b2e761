"""What a joint command must be before it may become a frame."""

import math
from collections.abc import Sequence

import numpy as np

from bridge.calibration import Calibration
from bridge.protocol import Setpoint
from manipulator.arrays import Array
from manipulator.errors import InvalidInput, Refused
from manipulator.formatting import counted
from manipulator.message_filter import NOTABLE_OFFSET, StampFilter

PULSE_PERIOD = 0.02
"""Seconds between two pulses of a servo: no command takes effect sooner."""
LONGEST_GAP = 0.05
"""Seconds of motion, after the last command, that one command may make up for."""
START = 0.005
"""Seconds of motion at full speed within which a first command must be of the joints."""


class Overtaken(Refused):
    """A command of a stream that something has ended, as a stop: its sender cannot know yet."""


class JumpValidator:
    """What every joint command must be: each joint named once, fresh, and no jump.

    No jump: a command must lie within what the joints can turn, at full speed, in the time
    since the last command (at most 0.05 s) and one pulse period of 0.02 s; what that one left
    unused of a gap before it counts as well, for after a stall two come at once. Where there is
    no last command, or its deadline has passed, it must begin where the joints are: within
    0.005 s at full speed.
    """

    def __init__(
        self, names: tuple[str, ...], unit: str, speed: Array | float, deadline: float
    ) -> None:
        """Speeds, one or (n,), in rad/s or m/s as the unit is; how long a command is good, s."""
        self._known, self._unit = names, unit
        self._speeds = np.broadcast_to(np.asarray(speed, dtype=np.float64), (len(names),))
        self._deadline = deadline
        self._stamps = StampFilter(maximum_age=deadline)
        self._names: tuple[str, ...] | None = None
        self._order: list[int] = []
        self._last: Array | None = None
        self._last_at = float('-inf')
        self._unused = 0.0

    @property
    def clock_offset(self) -> float | None:
        """Our clock minus the sender's, in seconds; None before the first stamp."""
        return self._stamps.offset

    @property
    def has_notable_offset(self) -> bool:
        """The sender's clock is off by so much that people should know."""
        offset = self._stamps.offset
        return offset is not None and abs(offset) > NOTABLE_OFFSET

    def restart(self) -> None:
        """The next command must start where the joints are."""
        self._last = None

    def refusal(self, reason: str, receipt: float) -> Refused:
        """Of a command that comes while none are taken: Overtaken where one just was."""
        is_of_stream = receipt - self._last_at <= self._deadline
        return Overtaken(reason) if is_of_stream else Refused(reason)

    def take(
        self,
        target: Array,
        stamp: float | None,
        receipt: float,
        present: Array | None,
        holding_since: float = -math.inf,
    ) -> None:
        """Raises StaleMessage or Refused for a target (n,) that must not be commanded now.

        holding_since: when the machine was found to hold, on the clock of `receipt`: what was
        sent before is refused.
        """
        lateness = self._stamps.admit(stamp, receipt) if stamp is not None else 0.0
        if receipt - lateness < holding_since:
            raise Refused('sent before the machine was known to hold')
        self._refuse_jump(target, receipt, present)
        self._last, self._last_at = target, receipt

    def ordered(self, names: Sequence[str], positions: Sequence[float]) -> Array:
        """Positions (n,) in the order of the names, from any order; InvalidInput else."""
        if len(names) != len(positions):
            there = counted(len(positions), 'position')
            raise InvalidInput(f'{counted(len(names), "joint name")}, but {there}')
        if tuple(names) != self._names:
            self._order = self._order_of(names)
            self._names = tuple(names)
        return np.array(positions, dtype=np.float64)[self._order]

    def _order_of(self, names: Sequence[str]) -> list[int]:
        known = self._known
        unknown = next((name for name in names if name not in known), None)
        if unknown is not None:
            raise InvalidInput(f'unknown joint {unknown[:80]!r} (there are {", ".join(known)})')
        if len(set(names)) < len(names):
            repeated = next(name for name in known if list(names).count(name) > 1)
            raise InvalidInput(f'joint {repeated} is named twice')
        missing = [name for name in known if name not in names]
        if missing:
            raise InvalidInput(f'no position for {", ".join(missing)}')
        return [list(names).index(name) for name in known]

    def _refuse_jump(self, target: Array, receipt: float, present: Array | None) -> None:
        elapsed = receipt - self._last_at
        if self._last is not None and elapsed <= self._deadline:
            start, where = self._last, 'the last command'
            time = PULSE_PERIOD + min(max(elapsed, 0.0) + self._unused, LONGEST_GAP)
        elif present is not None and np.all(np.isfinite(present)):
            start, where, time, elapsed = present, 'the reported position', START, 0.0
        else:
            raise Refused('the positions of the joints are not known at present')
        steps = np.abs(target - start)
        times = steps / self._speeds
        i = int(np.argmax(times))
        allowed = self._speeds[i] * time
        if steps[i] > allowed:
            name, unit = self._known[i], self._unit
            raise Refused(
                f'{name}: {target[i]:.4g} {unit} would jump by {steps[i]:.4g} from {where}, '
                f'at most {allowed:.4g}'
            )
        self._unused = max(elapsed - PULSE_PERIOD - float(times[i]), 0.0)


class CommandValidator(JumpValidator):
    """Turns joint commands into setpoints; what must not move the machine is refused whole."""

    def __init__(self, calibration: Calibration, deadline: float) -> None:
        """The deadline that every setpoint carries, in seconds."""
        super().__init__(calibration.names, calibration.unit, calibration.speed, deadline)
        self._calibration = calibration

    def admit(
        self,
        names: Sequence[str],
        positions: Sequence[float],
        stamp: float | None,
        receipt: float,
        present: Array | None,
        holding_since: float = -math.inf,
    ) -> Setpoint:
        """The setpoint for a command that came at `receipt` (s, monotonic up to an offset).

        `present` is where the joints are (rad or m, in the calibration's order; NaN: unknown).
        stamp None means "now"; holding_since: see `take`. InvalidInput, StaleMessage or Refused
        names what is wrong.
        """
        target = self.ordered(names, positions)
        counts = self._calibration.counts(target)
        self.take(target, stamp, receipt, present, holding_since)
        return Setpoint(round(1e3 * self._deadline), counts)
