"""Every error of this package, each with the facts it was raised for as attributes."""

from collections.abc import Sequence


class ManipulatorError(Exception):
    """The parent of all errors that hexarm raises on purpose."""


class InvalidInput(ManipulatorError, ValueError):
    """A value that no machine could use: wrong shape, not finite, not a rotation."""


class ConfigError(ManipulatorError, ValueError):
    """A machine file that cannot be used; `problems` lists everything that is wrong with it."""

    def __init__(self, problems: Sequence[str], source: str = '') -> None:
        self.problems = tuple(problems)
        self.source = source
        head = f'{source}: ' if source else ''
        super().__init__(head + '; '.join(self.problems))


class Unreachable(ManipulatorError, ValueError):
    """A pose that the machine cannot take; `leg` counts from 1, None when it is not one leg's."""

    def __init__(self, message: str, leg: int | None = None) -> None:
        self.leg = leg
        super().__init__(message)


class LimitViolated(Unreachable):
    """A configuration beyond a limit, with the limit's name, the value and the range."""

    def __init__(
        self,
        message: str,
        limit: str,
        value: float,
        bounds: tuple[float, float],
        leg: int | None = None,
    ) -> None:
        super().__init__(message, leg)
        self.limit = limit
        self.value = value
        self.bounds = bounds


class NoSolution(ManipulatorError, ArithmeticError):
    """Forward kinematics that found no pose, or none that can be trusted."""


class Refused(ManipulatorError, ValueError):
    """A motion that is not begun, or a command that does not fit the present mode."""


class Stopped(ManipulatorError):
    """A motion that ended before its goal: by a stop, a newer goal, or a lost link."""


class TimedOut(ManipulatorError, TimeoutError):
    """What was waited for did not come in time."""


class ProtocolError(ManipulatorError, ValueError):
    """Bytes on the serial line that are not a frame of this protocol."""


class LinkError(ManipulatorError, OSError):
    """A serial port that cannot be opened or has gone away."""
