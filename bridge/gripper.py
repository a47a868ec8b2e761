"""The gripper: a joint outside the kinematics, opened and closed by itself."""

import math
from collections.abc import Sequence

from bridge.calibration import Calibration
from bridge.servo_config import ServosConfig
from manipulator.arrays import Array
from manipulator.errors import InvalidInput, Refused

SPEED_SHARE = 0.5
"""The part of the servo's rated speed at which it opens and closes."""
LONGEST_GAP = 0.05
"""Seconds of motion that one step makes up for at most."""


class Gripper:
    """Moves towards the last requested opening; stays where it is until one is requested.

    Positions in rad (or m), times monotonic in seconds.
    """

    def __init__(self, config: ServosConfig, calibration: Calibration) -> None:
        """The joint that is marked as the gripper, if any; closed is the low end of its range."""
        marked = [joint.name for joint in config.joints if joint.is_gripper]
        self._name = marked[0] if marked else ''
        self._index = calibration.names.index(self._name) if marked else 0
        self._closed, self._opened = calibration.range_of(self._index)
        self._speed = SPEED_SHARE * calibration.speed
        self._target: float | None = None
        self._position: float | None = None
        self._stepped_at = 0.0

    def aim(self, opening: float) -> None:
        """From 0 (closed) to 1 (open); InvalidInput for all else, NaN too, or without gripper."""
        if not self._name:
            raise InvalidInput('this machine has no gripper')
        if not 0.0 <= opening <= 1.0:
            raise InvalidInput(f'gripper {opening:g} outside [0, 1] (0 closed, 1 open)')
        self._target = self._closed + opening * (self._opened - self._closed)

    def joined(
        self, command: tuple[Sequence[str], Sequence[float]], now: float, joints: Array | None
    ) -> tuple[Sequence[str], Sequence[float]]:
        """Names and positions of a joint command, with the gripper's where they lack it.

        `joints` (n,) is where all joints are, in the calibration's order; NaN where unknown.
        """
        names, positions = command
        if not self._name or self._name in names:
            return names, positions
        present = math.nan if joints is None else float(joints[self._index])
        return [*names, self._name], [*positions, self.step(now, present)]

    def restart(self) -> None:
        """Begins where the joint is, and stays there until the next request."""
        self._target = self._position = None

    def step(self, now: float, present: float) -> float:
        """The position to command now; Refused while the joint's position is unknown."""
        if self._position is None:
            if math.isnan(present):
                raise Refused(f'the position of {self._name} is not known yet')
            self._position, self._stepped_at = present, now
        reach = self._speed * min(max(now - self._stepped_at, 0.0), LONGEST_GAP)
        distance = 0.0 if self._target is None else self._target - self._position
        self._position += min(max(distance, -reach), reach)
        self._stepped_at = now
        return self._position
