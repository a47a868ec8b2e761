"""Whether the joints follow what is commanded, or something between here and them is stuck."""

from collections import deque

import numpy as np

from manipulator.arrays import Array

WINDOW = 0.5
"""Seconds by which the joints may lag behind."""

PATIENCE = 0.3
"""Seconds for which they may be elsewhere."""


class Following:
    """Compares measured joints with all that was commanded within the last half second."""

    def __init__(self, names: tuple[str, ...], tolerance: float, dt: float) -> None:
        """Tolerance in rad (or m); dt is the time between two commands."""
        self._names = names
        self._tolerance = tolerance
        self._commanded: deque[Array] = deque(maxlen=max(round(WINDOW / dt), 1))
        self._strays = 0
        self._allowed_ticks = round(PATIENCE / dt)
        self._astray_for = 0
        self._worst = ''
        self._measured: Array | None = None

    def command(self, joints: Array) -> None:
        """Notes what is commanded at this tick."""
        self._commanded.append(joints)
        self._astray_for += self._strays

    def measure(self, joints: Array) -> None:
        """Notes where the joints are."""
        self._measured = joints
        if not self._commanded:
            return
        away = np.abs(np.array(self._commanded) - joints)
        nearest = int(np.argmin(away.max(axis=1)))
        worst = int(np.argmax(away[nearest]))
        self._strays = int(away[nearest, worst] > self._tolerance)
        self._astray_for *= self._strays
        self._worst = f'{self._names[worst]} is {away[nearest, worst]:.3g} away from its command'

    @property
    def has_arrived(self) -> bool:
        """Whether the joints are where the last command sent them; so they are before any is."""
        if self._measured is None or not self._commanded:
            return True
        return bool(np.abs(self._commanded[-1] - self._measured).max() <= self._tolerance)

    @property
    def trouble(self) -> str:
        """Which joint does not follow, and by how much; '' while all do."""
        return self._worst if self._astray_for > self._allowed_ticks else ''
