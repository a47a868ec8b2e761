"""Commands for the board one after the other, each sent when the one before was obeyed."""

from collections.abc import Callable, Sequence
from concurrent.futures import Future

from bridge.messages import Command


class Upload:
    """`on_end` hears '' when all were obeyed, else why one was not; in the link's thread.

    No command is begun once `late` says why it is too late for it.
    """

    def __init__(
        self,
        request: Callable[[Command], 'Future[None]'],
        commands: Sequence[Command],
        on_end: Callable[[str], None],
        late: Callable[[], str] = lambda: '',
    ) -> None:
        self._request, self._on_end, self._late = request, on_end, late
        self._left = iter(commands)

    def begin(self) -> None:
        """Sends the first command."""
        command = next(self._left, None)
        reason = self._late() if command is not None else ''
        if command is None or reason:
            self._on_end(reason)
        else:
            self._request(command).add_done_callback(self._go_on)

    def _go_on(self, done: 'Future[None]') -> None:
        error = done.exception()
        if error is None:
            self.begin()
        else:
            self._on_end(str(error))
