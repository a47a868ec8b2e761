"""A process's end of a link: the message filter with the process's time."""

from manipulator.message_filter import MessageFilter
from world.timeline import EPOCH


class FilteredCallback:
    """Keeps every refusal, as (time, reason)."""

    def __init__(self, process, accept, refuse=lambda stamp, error: None):
        self.refusals = []
        self._process, self._accept, self._refuse = process, accept, refuse
        self._filter = MessageFilter(EPOCH)

    def __call__(self, stamp, *value):
        now = self._process.now
        error = self._filter.take(stamp, lambda: self._accept(stamp, *value), now)
        if error is not None:
            self._report(stamp, error)

    def refuse(self, stamp, error):
        """What was accepted, but not in the end."""
        self._filter.refuse(error)
        self._report(stamp, error)

    @property
    def age(self):
        return self._filter.age(self._process.now)

    @property
    def lateness(self):
        return self._filter.lateness

    def _report(self, stamp, error):
        self.refusals.append((self._process.now, self._filter.last_refusal))
        self._refuse(stamp, error)
