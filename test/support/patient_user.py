"""A user of a real graph, on a computer that does other work as well."""

from hexarm.client import Client, NotReady, Stopped
from manipulator.errors import Refused

PATIENCE = 60.0
TRIES = 10


class PatientUser(Client):
    """Waits for a minute at least, and asks again where the machine was lost meanwhile.

    A machine holds, and drops its goal, where its computer stands still for longer than the
    deadlines. That is no verdict: what must never happen is judged on the frames.
    """

    losses = 0
    patience = PATIENCE

    def wait(self, what, is_so, seconds=PATIENCE, progress=lambda: None):
        super().wait(what, is_so, max(seconds, self.patience), progress)

    def answer_of(self, client, request, what):
        """Asked again every few seconds: a question may be lost just after discovery."""
        for _ in range(TRIES):
            self.patience = 0.0
            try:
                return super().answer_of(client, request, what)
            except NotReady as error:
                last = error
            finally:
                self.patience = PATIENCE
        raise last

    def persist(self, ask):
        """What `ask` returns; asked again where it failed and the machine was lost."""
        for _ in range(TRIES - 1):
            before = self.losses
            try:
                return ask()
            except (Refused, Stopped, NotReady, AssertionError) as error:
                is_lost = self.losses > before or self.motion('mode') == 'disabled'
                if not is_lost and not isinstance(error, NotReady):
                    raise
            self.make_ready()
        return ask()

    def make_ready(self):
        """Enabled and able to move, whatever a stall, or the last test, left."""
        self.wait('a board', lambda: self.machine_state.message not in WITHOUT_BOARD)
        if self.machine_state.message in ('stopped', 'fault'):
            self.trigger('serial_bridge/clear_fault')
        if self.machine_state.message not in ('enabled', 'holding'):
            self.enable()
        self.wait('goals', lambda: self.motion('mode') not in ('', 'disabled'))

    def reach(self, pose):
        self.persist(lambda: self.go_to(pose))

    def reach_home(self):
        self.persist(self.home)

    def _on_machine_state(self, message):
        super()._on_machine_state(message)
        self.losses += message.message != 'enabled'

    def _on_motion_status(self, message):
        super()._on_motion_status(message)
        self.losses += self.motion('mode') == 'disabled'


WITHOUT_BOARD = ('not heard of', 'disconnected', 'booting')
