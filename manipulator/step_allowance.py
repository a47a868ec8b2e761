"""How far joints may step at once, where messages bunch up but speeds must hold."""

from dataclasses import dataclass


@dataclass
class StepAllowance:
    """Time that steps may take at full speed; all times monotonic, in seconds.

    Time that passes is granted, and each step spends what it takes at full speed. What is not
    spent is kept, `longest` at most: a process that was held up between two messages hears the
    second right after the first. `slack` is granted beyond, for the jitter of the messages.
    """

    slack: float
    longest: float
    _spent_until: float = 0.0

    def restart(self, now: float) -> None:
        """Nothing is kept from before: motion begins here."""
        self._spent_until = now

    def seconds(self, now: float) -> float:
        """What the next step may take."""
        return min(now - self._spent_until, self.longest) + self.slack

    def spend(self, seconds: float, now: float) -> None:
        """A step was made that takes so long at full speed."""
        self._spent_until = max(self._spent_until, now - self.longest) + seconds
