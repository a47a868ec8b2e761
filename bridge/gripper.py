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

    Positions in rad (or m), times monotonic in seconds. It has moved only by commands that were
    admitted; after a silence it begins where the joint is.
    """

    def __init__(self, config: ServosConfig, calibration: Calibration, deadline: float) -> None:
        """The joint that is marked as the gripper, if any; closed is the low end of its range.

        deadline: seconds after which the last command is not followed any more.
        """
        marked = [joint.name for joint in config.joints if joint.is_gripper]
        self._name = marked[0] if marked else ''
        self._index = calibration.names.index(self._name) if marked else 0
        self._closed, self._opened = calibration.range_of(self._index)
        self._speed = SPEED_SHARE * calibration.speed
        self._target: float | None = None
        self._deadline = deadline
        self._position: float | None = None
        self._stepped_at = 0.0
        self._next: tuple[float, float] | None = None

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

        Call `note_admitted` once the command is. `joints` (n,) is where all joints are, in the
        calibration's order; NaN where unknown.
        """
        names, positions = command
        if not self._name or self._name in names:
            return names, positions
        present = math.nan if joints is None else float(joints[self._index])
        position = self._ahead(now, present)
        self._next = position, now
        return [*names, self._name], [*positions, position]

    def note_admitted(self) -> None:
        """The last joined command is followed."""
        if self._next is not None:
            self._position, self._stepped_at = self._next

    def restart(self) -> None:
        """Begins where the joint is, and stays there until the next request."""
        self._target = self._position = self._next = None

    def _ahead(self, now: float, present: float) -> float:
        """The position to command now; Refused while the joint's position is unknown."""
        elapsed = max(now - self._stepped_at, 0.0)
        if self._position is None or elapsed > self._deadline:
            if math.isnan(present):
                raise Refused(f'the position of {self._name} is not known at present')
            return present
        reach = self._speed * min(elapsed, LONGEST_GAP)
        distance = 0.0 if self._target is None else self._target - self._position
        return self._position + min(max(distance, -reach), reach)
