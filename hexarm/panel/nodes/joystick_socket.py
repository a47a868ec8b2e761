"""The joystick's connections: one for each open page, beats in, answers out.

Runs in the web server's thread; the node asks from its own.
"""

import itertools
import threading
import time
from collections.abc import Callable

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed

from hexarm.panel.joystick import Joystick
from hexarm.panel.joystick_words import answer, heard
from manipulator.arrays import Array
from manipulator.errors import InvalidInput


class JoystickSocket:
    """Beats of all pages into one `Joystick`."""

    def __init__(self, may_move: Callable[[], str]) -> None:
        self._joystick = Joystick()
        self._lock = threading.Lock()
        self._pages = itertools.count()
        self._may_move = may_move

    async def serve(self, connection: ServerConnection) -> None:
        """One page, from its first word until it is gone."""
        page = next(self._pages)
        try:
            async for text in connection:
                await connection.send(self._answer(page, text))
        except InvalidInput as error:
            await connection.close(1008, str(error)[:100])
        except ConnectionClosed:
            pass
        finally:
            with self._lock:
                self._joystick.leave(page)

    def stick(self) -> Array | None:
        """What is held now (6,), None while nothing is."""
        with self._lock:
            return self._joystick.stick(time.monotonic())

    def stop(self) -> None:
        """Whoever holds must let go first."""
        with self._lock:
            self._joystick.stop()

    def _answer(self, page: int, text: str | bytes) -> str:
        words = heard(text)
        now = time.monotonic()
        with self._lock:
            if isinstance(words, int):
                self._joystick.release(page, words)
            else:
                self._joystick.hear(page, words, now)
            holder, reason = self._joystick.holder(now), self._joystick.reason(page)
        has_it = holder == page
        return answer(now, has_it, holder is not None and not has_it,
                      reason or (self._may_move() if has_it else ''))  # fmt: skip
