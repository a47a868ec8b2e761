"""The board's outputs: one pulse per channel, slewed by one factor for all channels."""

from collections.abc import Sequence


class PulseDrive:
    """Pulse widths in counts by channel; a channel that is off puts out no pulse.

    speeds: the servos' rated speeds in counts per second, per channel.
    """

    def __init__(self, speeds: Sequence[float]) -> None:
        self._speeds = tuple(speeds)
        self._is_on = [False] * len(self._speeds)
        self._pulses = [0.0] * len(self._speeds)
        self._target = [0.0] * len(self._speeds)

    @property
    def pulses(self) -> tuple[float | None, ...]:
        """What goes out now; None where nothing does."""
        pairs = zip(self._pulses, self._is_on, strict=True)
        return tuple(pulse if is_on else None for pulse, is_on in pairs)

    @property
    def counts(self) -> tuple[float, ...]:
        """The widths of all channels, whether they are on or not."""
        return tuple(self._pulses)

    @property
    def is_all_on(self) -> bool:
        """Every channel puts out pulses."""
        return all(self._is_on)

    @property
    def is_slewing(self) -> bool:
        """The pulses are not yet where they were aimed."""
        return self._pulses != self._target

    def energise(self, channel: int, count: int) -> None:
        """The first pulse of a channel; where the servo is before it, nobody knows."""
        self._is_on[channel] = True
        self._pulses[channel] = self._target[channel] = float(count)

    def release(self) -> None:
        """No more pulses on any channel."""
        self._is_on = [False] * len(self._speeds)
        self.halt()

    def aim(self, counts: Sequence[int]) -> None:
        """Where `advance` goes from now on."""
        self._target = [float(count) for count in counts]

    def halt(self) -> None:
        """Stay at what goes out now."""
        self._target = list(self._pulses)

    def advance(self, dt: float) -> None:
        """Moves all pulses along one straight line to the target, no servo above its speed."""
        ways = [b - a for a, b in zip(self._pulses, self._target, strict=True)]
        needed = max(abs(w) / (v * dt) for w, v in zip(ways, self._speeds, strict=True))
        if needed <= 1.0:
            self._pulses = list(self._target)
        else:
            self._pulses = [a + w / needed for a, w in zip(self._pulses, ways, strict=True)]
