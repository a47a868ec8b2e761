"""The plain jog: the twist as commanded, nothing held."""

from dataclasses import dataclass

from manipulator.arrays import Array
from manipulator.pose import Pose


@dataclass(frozen=True)
class Free:
    """At rest and in motion alike."""

    def latched(self, pose: Pose) -> 'Free':
        """Needs no reference."""
        return self

    def step(self, command: Array, measured: Pose, commanded: Array) -> 'tuple[Array, Free]':
        """The command itself."""
        return command, self
