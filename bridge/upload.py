"""Commands for the board one after the other, each sent when the one before was obeyed."""

from collections.abc import Callable, Sequence
from concurrent.futures import Future

from bridge.messages import Command


class Upload:
    """`on_end` hears '' when all were obeyed, else why one was not; in the link's thread."""

    def __init__(
        self,
        request: Callable[[Command], 'Future[None]'],
        commands: Sequence[Command],
        on_end: Callable[[str], None],
    ) -> None:
        self._request, self._on_end = request, on_end
        self._left = iter(commands)

    def begin(self) -> None:
        """Sends the first command."""
        command = next(self._left, None)
        if command is None:
            self._on_end('')
        else:
            self._request(command).add_done_callback(self._go_on)

    def _go_on(self, done: 'Future[None]') -> None:
        error = done.exception()
        if error is None:
            self.begin()
        else:
            self._on_end(str(error))
