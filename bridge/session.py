"""The host's side of the line as a state machine: bytes and times in, bytes and events out.

It stays silent until the board's HELLO: bytes sent during a Mega's boot would keep its boot loader
waiting for ever. `now` is monotonic time in seconds, given by the caller.
"""

from dataclasses import dataclass, replace

from bridge import handshake
from bridge.events import (
    Acknowledged,
    CommandFailed,
    Connected,
    Disconnected,
    Event,
    FaultReported,
    Incompatible,
    Opened,
    Phase,
    StateReceived,
)
from bridge.frames import DELIMITER, encode
from bridge.framing import FrameReader
from bridge.handshake import RoundTrips
from bridge.protocol import (
    REASONS,
    Ack,
    Arm,
    Clear,
    Command,
    Disarm,
    Fault,
    Hello,
    Mode,
    Play,
    Result,
    Setpoint,
    State,
    Stop,
    is_newer,
)
from manipulator.deadlines import BOARD_DEADLINE
from manipulator.errors import Refused

RETRY_AFTER = 0.1
"""Seconds without an answer after which a command is sent again."""
MAX_TRIES = 4
"""Of a command, before it fails; a STOP is reported as failed, and repeated."""
MAX_BOOT = 5.0
"""Seconds from the opening of the port to HELLO, after which the board is reported as missing."""
MODE_AFTER: dict[type, Mode] = {Disarm: Mode.DISARMED, Stop: Mode.STOPPED}
"""The board's mode once it has acknowledged a command."""
ACKNOWLEDGED_BY_STATE = (Arm, Clear, Play)
"""Commands whose resulting mode is known from the next STATE only: acknowledged with it."""


@dataclass
class _Pending:
    """An unacknowledged command; every try carries the same sequence."""

    command: Command
    sequence: int
    wire: bytes
    sent_at: float
    tries: int
    is_obeyed: bool = False


class Session:
    """The session of one host with one board of `joint_count` joints.

    A STOP is never given up: it is repeated until the board has stopped, also after the board was
    disconnected or restarted, and until the board has obeyed a CLEAR no setpoint is sent.
    """

    def __init__(self, joint_count: int) -> None:
        self.joint_count = joint_count
        self.phase = Phase.CLOSED
        self.hello: Hello | None = None
        self.state: State | None = None
        self.setpoints_sent = 0
        self.is_stop_requested = False
        self.reader = FrameReader()
        self.round_trips = RoundTrips()
        self._output = bytearray()
        self._sequence = 0
        self._pending: _Pending | None = None
        self._received_at = self._opened_at = self._hello_at = 0.0

    @property
    def accepts_setpoints(self) -> bool:
        """The board would follow a setpoint now, and no command is unacknowledged."""
        return (
            self.phase is Phase.READY
            and self._pending is None
            and not self.is_stop_requested
            and self.state is not None
            and self.state.mode in (Mode.ARMED, Mode.HOLDING)
        )

    def opened(self, now: float) -> list[Event]:
        """The port is open: wait for the board, silently."""
        self.reader = FrameReader()
        self._forget(Phase.WAITING, now)
        return [Opened()]

    def closed(self, reason: str, now: float) -> list[Event]:
        """The port is gone."""
        events = [*self._fail_pending(reason), Disconnected(reason)]
        self._forget(Phase.CLOSED, now)
        return events

    def receive(self, received: bytes, now: float, sent_after: float | None = None) -> list[Event]:
        """Bytes from the board; sent_after: when all before them had been received (None: now)."""
        sent_after = now if sent_after is None else sent_after
        events: list[Event] = []
        for frame in self.reader.feed(received):
            self._received_at = now
            match frame.message:
                case Hello():
                    events += self._shake_hands(frame.message, now, sent_after)
                case State():
                    events += self._note_state(frame.message, now)
                case Ack():
                    events += self._settle(frame.message)
                case Fault() if self.phase is Phase.READY:
                    events.append(FaultReported(frame.message))
        return events

    def tick(self, now: float) -> list[Event]:
        """Repeats an unacknowledged command; detects a silent board."""
        if (
            self.phase in (Phase.CONNECTING, Phase.READY)
            and now - self._received_at > BOARD_DEADLINE
        ):
            events = self.closed(f'no frame from the board for {BOARD_DEADLINE:g} s', now)
            self.phase = Phase.WAITING
            return events
        if self.phase is Phase.WAITING and now - self._opened_at > MAX_BOOT:
            self._opened_at = now
            return [Disconnected(f'the port is open, but no HELLO came for {MAX_BOOT:g} s')]
        pending = self._pending
        if pending is None or pending.is_obeyed or now - pending.sent_at < RETRY_AFTER:
            return []
        is_too_often = pending.tries % MAX_TRIES == 0
        reason = f'no answer from the board after {pending.tries} tries'
        if is_too_often and not isinstance(pending.command, Stop):
            return self._fail_pending(reason)
        pending.tries += 1
        pending.sent_at = now
        self._output += pending.wire
        return [CommandFailed(pending.command, reason)] if is_too_often else []

    def send_setpoint(self, setpoint: Setpoint, now: float) -> None:
        """Newest wins, never repeated; Refused where the board would not follow it."""
        if not self.accepts_setpoints:
            mode = self.state.mode.name.lower() if self.state else self.phase.value
            raise Refused(f'the board accepts no setpoints now: {mode}')
        self._send(setpoint)
        self.round_trips.note_sent(self._sequence, now)
        self.setpoints_sent += 1

    def send_command(self, command: Command, now: float) -> list[Event]:
        """Repeated until acknowledged; it replaces an unacknowledged one.

        Refused where there is no board (a STOP is sent as soon as there is one), or where a STOP
        is still unacknowledged.
        """
        self.is_stop_requested = self.is_stop_requested or isinstance(command, Stop)
        if self.phase is not Phase.READY:
            raise Refused(f'no board is connected: {self.phase.value}')
        pending = self._pending
        if pending is not None and isinstance(pending.command, Stop):
            if isinstance(command, Stop):
                return []
            raise Refused('a STOP is in progress')
        reason = f'{type(command).__name__.upper()} came after it'
        displaced = self._acknowledge_obeyed() or self._fail_pending(reason)
        self._begin(command, now)
        return displaced

    def take_output(self) -> bytes:
        """The bytes for the board since the last call."""
        output, self._output = bytes(self._output), bytearray()
        return output

    def _begin(self, command: Command, now: float) -> None:
        # The leading delimiter ends any partial frame that the board may have received.
        wire = self._send(command, ahead=DELIMITER)
        self._pending = _Pending(command, self._sequence, wire, now, tries=1)

    def _send(self, message: Setpoint | Command, ahead: bytes = b'') -> bytes:
        self._sequence = self._sequence + 1 & 0xFFFF
        wire = ahead + encode(message, self._sequence)
        self._output += wire
        return wire

    def _forget(self, phase: Phase, now: float) -> None:
        self.phase = phase
        self.hello = self.state = self._pending = None
        self._opened_at = self._received_at = now
        self.round_trips.forget_sent()
        self._output.clear()

    def _shake_hands(self, hello: Hello, now: float, sent_after: float) -> list[Event]:
        mismatch = handshake.mismatch(hello, self.joint_count)
        if mismatch:
            failed = self._fail_pending(mismatch)
            is_news = self.phase is not Phase.INCOMPATIBLE
            self._forget(Phase.INCOMPATIBLE, now)
            return [*failed, Incompatible(mismatch)] if is_news else []
        events: list[Event] = []
        has_restarted = self.hello is not None and handshake.has_restarted(
            self.hello, hello, max(sent_after - self._hello_at, 0.0)
        )
        if self.phase is not Phase.READY or has_restarted:
            if has_restarted:
                cause = hello.reset_cause.name or hello.reset_cause
                reason = f'the board has restarted (cause: {cause})'
                events = [*self._fail_pending(reason), Disconnected(reason)]
            self._forget(Phase.CONNECTING, now)
        self.hello, self._hello_at = hello, now
        return events

    def _note_state(self, state: State, now: float) -> list[Event]:
        if self.phase not in (Phase.CONNECTING, Phase.READY) or self.hello is None:
            return []
        if len(state.joints) != self.joint_count:
            return []
        is_first = self.phase is Phase.CONNECTING
        if is_first or is_newer(state.echo, self._sequence):
            # The board may remember an earlier host: go on from there.
            self._sequence = state.echo
        self.round_trips.note_state(state, now)
        self.state = state
        self.phase = Phase.READY
        connected: list[Event] = [Connected(self.hello)] if is_first else []
        obeyed = self._acknowledge_obeyed()
        if self.is_stop_requested and self._pending is None and state.mode is not Mode.STOPPED:
            self._begin(Stop(), now)
        return [*connected, *obeyed, StateReceived(state)]

    def _settle(self, ack: Ack) -> list[Event]:
        pending = self._pending
        if pending is None or pending.is_obeyed or ack.sequence != pending.sequence:
            return []
        if ack.result is not Result.OK:
            return self._fail_pending(REASONS[ack.result])
        if isinstance(pending.command, Clear):
            self.is_stop_requested = False
        if isinstance(pending.command, ACKNOWLEDGED_BY_STATE):
            pending.is_obeyed = True
            return []
        self._pending = None
        mode = MODE_AFTER.get(type(pending.command))
        if mode is not None and self.state is not None:
            # Set before the next STATE shows it: no setpoint may follow.
            self.state = replace(self.state, mode=mode)
        return [Acknowledged(pending.command)]

    def _acknowledge_obeyed(self) -> list[Event]:
        """Acknowledges with a STATE later than the command, so that its effect is visible."""
        pending = self._pending
        if pending is None or not pending.is_obeyed:
            return []
        self._pending = None
        return [Acknowledged(pending.command)]

    def _fail_pending(self, reason: str) -> list[Event]:
        pending, self._pending = self._pending, None
        return [CommandFailed(pending.command, reason)] if pending else []
