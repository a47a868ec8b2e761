"""A user of a real graph, on a computer that does other work as well."""

import contextlib

from diagnostic_msgs.msg import DiagnosticStatus

from hexarm.client import Client
from manipulator.errors import Refused, Stopped, TimedOut

PATIENCE = 60.0
TRIES = 10


class PatientUser(Client):
    """Waits for a minute at least, and asks again where the machine was lost meanwhile.

    A machine holds, and drops its goal, where its computer stands still for longer than the
    deadlines. That is no verdict: what must never happen is judged on the frames.
    """

    losses = 0
    patience = PATIENCE

    def __init__(self, namespace, interrupt=lambda: None):
        super().__init__(namespace, interrupt)
        self._last_motion = None
        # Every state counts, also one that a newer one has replaced before it was read.
        subscribe = self.node.create_subscription
        subscribe(DiagnosticStatus, 'machine_state', self._note_state, 100)
        subscribe(DiagnosticStatus, 'motion_status', self._note_motion, 100)

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

    def accepts(self, service):
        """Whether a node does what a trigger asks for."""
        try:
            self.trigger(service)
        except Refused:
            return False
        return True

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
                self._hear_more()
                if not self._has_lost(before) and not _is_late(error):
                    raise
            self.make_ready()
        return ask()

    def _hear_more(self):
        """A loss that a process which stands still has not reported yet; reasons come late."""
        heard = self._states_received
        with contextlib.suppress(TimedOut):
            self.wait('states', lambda: self._states_received > heard + 2)

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

    def _note_state(self, message):
        self.losses += self._is_loss(message.message)

    def _is_loss(self, state):
        return state != 'enabled'

    def _note_motion(self, message):
        values = {pair.key: pair.value for pair in message.values}
        motion = values.get('mode'), values.get('reason', '')
        is_loss = motion[0] == 'disabled' or any(words in motion[1] for words in STALLS)
        self.losses += is_loss and motion != self._last_motion
        self._last_motion = motion


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
        return state in (*WITHOUT_BOARD, 'unclaimed')


STALLS = (
    ' s old, at most ',
    'no pose received for ',
    'the control loop stalled for ',
    'machine_state timed out',
    'no answer from the board after ',
    'the machine is holding',
    'no joint command within the deadline',
    'machine enabled, motion idle',  # of a jog whose twists ceased
    'the jog is not accepted',
    'timed out after ',  # in another process
)
"""Reasons of a computer that stood still; the machine may drive again before that is heard."""


def _is_late(error):
    """Nothing came in time, or too late."""
    return isinstance(error, TimedOut) or any(words in str(error) for words in STALLS)


SERVOS_ON = ('enabled', 'holding')
WITHOUT_BOARD = ('unknown', 'disconnected', 'booting')
