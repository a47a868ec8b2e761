"""Whether the battery has what the servos need: a dip is not yet an empty battery."""

EXHAUSTED_AFTER_US = 500_000


class Supply:
    """Watches the battery against `minimum_mv`; 0 where none is watched."""

    def __init__(self, minimum_mv: int) -> None:
        self._minimum_mv = minimum_mv
        self._low_since_us: int | None = None
        self._now_us = 0

    @property
    def is_low(self) -> bool:
        """Below what the machine file asks for, now."""
        return self._low_since_us is not None

    @property
    def is_exhausted(self) -> bool:
        """It has been low for half a second."""
        since = self._low_since_us
        return since is not None and self._now_us - since >= EXHAUSTED_AFTER_US

    def watch(self, now_us: int, battery_mv: int) -> None:
        """Looks at the battery, once a period."""
        self._now_us = now_us
        if battery_mv >= self._minimum_mv:
            self._low_since_us = None
        elif self._low_since_us is None:
            self._low_since_us = now_us
