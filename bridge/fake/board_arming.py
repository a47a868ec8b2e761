"""Servo after servo gets its first pulse: all at once would pull more than a supply has."""

from bridge.fake.pulse_drive import PulseDrive


class Arming:
    """Energises the channels of `drive`, interval_us apart; times in microseconds."""

    def __init__(self, drive: PulseDrive, interval_us: int) -> None:
        self._drive, self._interval_us = drive, interval_us
        self._park: tuple[int, ...] = ()
        self._next_at_us = 0

    def begin(self, park: tuple[int, ...], now_us: int) -> None:
        """From the next step on, at these counts."""
        self._park, self._next_at_us = park, now_us

    def step(self, now_us: int) -> bool:
        """The next servo when it is its turn; True when the last one has had its time."""
        if now_us < self._next_at_us:
            return False
        if self._drive.is_all_on:
            return True
        channel = self._drive.pulses.index(None)
        self._drive.energise(channel, self._park[channel])
        self._next_at_us = now_us + self._interval_us
        return False
