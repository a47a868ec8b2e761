"""A user of a real graph, on a computer that does other work as well."""

import contextlib

from hexarm.client import Client
from manipulator.errors import Refused, Stopped, TimedOut

PATIENCE = 60.0
TRIES = 10
SOON = 0.3


class PatientUser(Client):
    """Waits for a minute at least, and asks again where the machine was lost meanwhile.

    A machine holds, and drops its goal, where its computer stands still for longer than the
    deadlines. That is no verdict: what must never happen is judged on the frames.
    """

    losses = 0
    patience = PATIENCE

    def wait(self, what, is_so, seconds=PATIENCE, progress=lambda: None):
        super().wait(what, is_so, max(seconds, self.patience), progress)

    def wait_for_state(self, word):
        self.wait(word, lambda: self.machine_state.message == word)

    def answer_of(self, client, request, what):
        """Asked again every few seconds: a question may be lost just after discovery."""
        for _ in range(TRIES):
            self.patience = 0.0
            try:
                return super().answer_of(client, request, what)
            except TimedOut as error:
                last = error
            finally:
                self.patience = PATIENCE
        raise last

    def end_of(self, process):
        """Exit status and what was printed; what the graph says meanwhile is heard in time."""
        self.wait('its end', lambda: process.poll() is not None, 2 * PATIENCE)
        return process.returncode, process.communicate()[0]

    def wait_while_driven(self, what, is_so):
        """As `wait`, for `persist`: TimedOut at once where the machine is lost meanwhile."""
        before = self.losses
        self.wait(what, lambda: is_so() or self._has_lost(before))
        if not is_so():
            raise TimedOut(f'the machine was lost, waiting for {what} ({self.summary})')

    def wait_driven(self, what, is_so):
        """As `wait`; a machine that is lost meanwhile is made ready again."""
        self.persist(lambda: self.wait_while_driven(what, is_so))

    def _has_lost(self, before):
        return self.losses > before or self.motion('mode') == 'disabled'

    def persist(self, ask):
        """What `ask` returns; asked again where it failed and the machine was lost."""
        for _ in range(TRIES - 1):
            before = self.losses
            try:
                return ask()
            except (Refused, Stopped, TimedOut, AssertionError) as error:
                self.spin(SOON)  # a motion is reported as stopped before its reason is
                if not self._has_lost(before) and not _is_late(error):
                    raise
            self.make_ready()
        return ask()

    def make_ready(self):
        """Enabled and able to move, whatever a stall, or the last test, left."""
        for _ in range(TRIES - 1):
            with contextlib.suppress(Refused, TimedOut):
                return self._make_ready()
        return self._make_ready()

    def _make_ready(self):
        self.wait('a board', lambda: self.machine_state.message not in WITHOUT_BOARD)
        if self.machine_state.message in ('stopped', 'fault'):
            self.trigger('serial_bridge/clear_fault')
        if self._is_off():
            self.enable()
        self.wait('goals', lambda: self._takes_goals() or self._is_off())
        if self._is_off():
            raise TimedOut(f'the machine was lost, being enabled ({self.summary})')

    def _takes_goals(self):
        return self.motion('mode') not in ('', 'disabled')

    def _is_off(self):
        return self.machine_state.message not in SERVOS_ON

    def reach(self, pose):
        self.persist(lambda: self.go_to(pose))

    def reach_home(self):
        self.persist(self.home)

    def _on_machine_state(self, message):
        super()._on_machine_state(message)
        self.losses += self._is_loss(message.message)

    def _is_loss(self, state):
        return state != 'enabled'

    def _on_motion_status(self, message):
        super()._on_motion_status(message)
        self.losses += self.motion('mode') == 'disabled'


class PatientBridgeUser(PatientUser):
    """Of a bridge without a trajectory node; a machine is lost when its board is silent."""

    def enable(self):
        self.switch('serial_bridge/enable')
        self.wait_for_state('enabled')

    def switch(self, service, is_on=True):
        return super().switch(service, is_on)

    def _takes_goals(self):
        return True

    def _is_loss(self, state):
        return state in WITHOUT_BOARD


STALLS = (
    ' s old, at most ',
    'no pose received for ',
    'the control loop stalled for ',
    'machine_state timed out',
    'no answer from the board after ',
    'the machine is holding',
)
"""Reasons of a computer that stood still; the machine may drive again before that is heard."""


def _is_late(error):
    """Nothing came in time, or too late."""
    return isinstance(error, TimedOut) or any(words in str(error) for words in STALLS)


SERVOS_ON = ('enabled', 'holding')
WITHOUT_BOARD = ('unknown', 'disconnected', 'booting')
