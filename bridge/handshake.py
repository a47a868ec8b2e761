"""The handshake, HELLO and STATE: mismatch, restart, and how long a frame takes."""

from collections import deque

from bridge.protocol import PROTOCOL_VERSION, Hello, State, is_newer
from manipulator.formatting import counted

UPTIME_SLACK_MS = 250
"""By which a board's clock may lag besides half of the elapsed time."""
SHORTEST_ADVANCE_MS = 125
"""Of a board's clock between two HELLOs of one run: half of their period."""
LONGEST_STALL_MS = 2**26
"""19 hours: lead of a board's clock over ours, which halts while the computer sleeps."""
LONGEST_LAG_MS = 2**30
"""12 days, a quarter of the clock: a lag beyond it could as well be a lead."""


def mismatch(hello: Hello, joint_count: int) -> str:
    """Why a board must not be talked to, '' where it fits a machine of `joint_count` joints."""
    if hello.version != PROTOCOL_VERSION:
        return f'the board has protocol {hello.version}, this host {PROTOCOL_VERSION}'
    if hello.joint_count != joint_count:
        return f'the board has {counted(hello.joint_count, "joint")}, the machine {joint_count}'
    return ''


def has_restarted(before: Hello, hello: Hello, elapsed: float) -> bool:
    """Whether the board's clock (it wraps at 49.7 days) ran less than half as long as ours.

    elapsed: seconds that passed between the two HELLOs at least; a HELLO that waited in the port
    to be read was sent earlier than it was received. A board's resonator is off by a
    percent, and a simulated board may stall: neither counts. Two HELLOs of one run are 250 ms
    apart on that clock, so less is a restart as well.
    """
    advance = hello.uptime_ms - before.uptime_ms & 0xFFFF_FFFF
    lag = (round(1000 * elapsed) - advance + 2**31 & 0xFFFF_FFFF) - 2**31
    most = min(500 * elapsed + UPTIME_SLACK_MS, LONGEST_LAG_MS)
    return advance < SHORTEST_ADVANCE_MS or not -LONGEST_STALL_MS < lag <= most


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
