"""How long a frame takes to the board and its echo back."""

from collections import deque

from bridge.messages import State, is_newer

AGE_UNKNOWN = 0xFFFF


class RoundTrips:
    """Pairs sent sequences with the echo in STATE; the stay on the board is taken out."""

    def __init__(self) -> None:
        self._sent: deque[tuple[int, float]] = deque(maxlen=64)
        self._seconds: deque[float] = deque(maxlen=512)

    @property
    def seconds(self) -> tuple[float, ...]:
        """The last round trips."""
        return tuple(self._seconds)

    def note_sent(self, sequence: int, now: float) -> None:
        """A frame went out."""
        self._sent.append((sequence, now))

    def note_state(self, state: State, now: float) -> None:
        """A STATE came in: it answers the frame that it echoes and drops all before it."""
        while self._sent and not is_newer(self._sent[0][0], state.echo):
            sequence, sent_at = self._sent.popleft()
            if sequence == state.echo and state.echo_age_us < AGE_UNKNOWN:
                self._seconds.append(max(now - sent_at - 1e-6 * state.echo_age_us, 0.0))

    def forget_sent(self) -> None:
        """Nothing that was sent will be echoed any more."""
        self._sent.clear()
