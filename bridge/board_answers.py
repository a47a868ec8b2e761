"""What a service tells its caller of a command: obeyed, or why not."""

from collections.abc import Callable
from concurrent.futures import Future
from concurrent.futures import TimeoutError as NoAnswer

from bridge.messages import Command, Stop
from manipulator.errors import Refused

ANSWER_WITHIN = 1.0


class BoardAnswers:
    """Asks the board by `request` and waits; `trouble` is what else is wrong with it, or ''.

    A request is done only when machine_state shows it: who is answered may look at once.
    """

    def __init__(
        self, request: Callable[[Command], 'Future[None]'], trouble: Callable[[], str]
    ) -> None:
        self._request, self._trouble = request, trouble

    def ask(self, command: Command, done: str) -> tuple[bool, str]:
        """Whether the board obeyed within a second, and what to say: `done`, or why not."""
        answer = self._request(command)
        try:
            answer.result(ANSWER_WITHIN)
        except Refused as error:
            trouble = self._trouble()
            return False, f'{error}{f": {trouble}" if trouble else ""}'
        except NoAnswer:
            if not isinstance(command, Stop):
                answer.cancel()  # what was said to have failed must not be sent later
            return False, f'no answer within {ANSWER_WITHIN:g} s'
        return True, done
