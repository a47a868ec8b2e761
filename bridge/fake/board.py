"""The fake board: bytes in, bytes out, and `step(dt)`; no port and no clock.

What it does with a frame stands in board_modes.py; here it listens, answers and announces itself,
as docs/protocol.md says. The simulated chip has the same three methods.
"""

from bridge.fake.board_modes import PULSE_PERIOD_US, BoardModes
from bridge.fake.board_programs import still_axes
from bridge.fake.board_settings import BoardSettings
from bridge.frames import DELIMITER, Unreadable, code_of, encode
from bridge.framing import FrameReader
from bridge.protocol import (
    NO_JOINT,
    Ack,
    Clear,
    Command,
    Fault,
    FaultCode,
    Hello,
    Joint,
    Known,
    Message,
    Mode,
    ResetCause,
    Result,
    Setpoint,
    State,
    Stop,
    is_newer,
)

HELLO_PERIOD_US = 250_000
HOST_SILENCE_US = 500_000
MAX_OUTPUT_BYTES = 1024
HIGHEST_U16 = 0xFFFF
FIRST_OF_BOARD = 0x81
"""Types from here on are what a board says: from a host they mean nothing."""


class Board:
    """One board on a line; `battery_mv` is what its divider measures now.

    measured: what its encoders read, in counts by channel; None where joints have none.
    is_stop_open: the stop button's contact, which stops while it is open.
    is_start_closed: the start button's, which acts when it closes.
    """

    def __init__(self, settings: BoardSettings, battery_mv: int = 7600) -> None:
        self.settings = settings
        self.battery_mv = battery_mv
        self.measured: tuple[int, ...] | None = None
        self.is_stop_open = False
        self.is_start_closed = False
        self._axes = still_axes()
        self.reset(ResetCause.POWER_ON)

    def reset(self, cause: ResetCause) -> None:
        """Starts again: silent for the boot, then disarmed and knowing nothing."""
        self._now_us = self._next_period_us = 0
        self._cause = cause
        self._reader = FrameReader()
        self._modes = BoardModes(self.settings, self._axes)
        self._output = bytearray()
        self._sent = 0
        self._refused = 0
        self._fault_to_say: Fault | None = None
        self._echo = 0
        self._accepted_at_us: int | None = None
        self._heard_at_us = 0
        self._hello_at_us = self.settings.boot_us
        self._has_said_hello = False
        self._last_command: tuple[type[Command], int, Result] | None = None
        self._was_start_closed = True  # until it was seen open: a stuck contact starts nothing

    @property
    def mode(self) -> Mode:
        """What the board is doing."""
        return self._modes.mode

    @property
    def pulses(self) -> tuple[float | None, ...]:
        """Pulse width in counts by channel, None where no pulse goes out."""
        return self._modes.drive.pulses

    def feed(self, received: bytes) -> None:
        """Bytes from the host; during the boot they are lost."""
        if self._now_us < self.settings.boot_us:
            return
        for frame in self._reader.feed(received):
            match frame.message:
                case Setpoint():
                    self._take_setpoint(frame.message, frame.sequence)
                case Hello() | State() | Ack() | Fault():
                    self._refuse(Fault(FaultCode.UNKNOWN_TYPE, NO_JOINT, code_of(frame.message)))
                case _:
                    self._take_command(frame.message, frame.sequence)
        for unreadable in self._reader.unreadable:
            self._refuse(_fault_of(unreadable))

    def step(self, dt: float) -> None:
        """Lets `dt` seconds pass; deadlines, pulses and STATE come with each pulse period."""
        self._now_us += round(dt * 1e6)
        while self._next_period_us <= self._now_us:
            if self._next_period_us >= self.settings.boot_us:
                self._pass_period(self._next_period_us)
            self._next_period_us += PULSE_PERIOD_US

    def take_output(self) -> bytes:
        """The bytes for the host since the last call."""
        output, self._output = bytes(self._output), bytearray()
        return output

    def _pass_period(self, now_us: int) -> None:
        self._read_buttons(now_us)
        self._fault_to_say = self._modes.pass_period(now_us, self.battery_mv) or self._fault_to_say
        is_host_silent = now_us - self._heard_at_us >= HOST_SILENCE_US
        if now_us >= self._hello_at_us and (is_host_silent or not self._has_said_hello):
            self._has_said_hello = True
            uptime_ms = now_us // 1000 & 0xFFFF_FFFF
            joint_count = len(self.settings.count_ranges)
            hello = Hello(self.settings.version, self._cause, joint_count, uptime_ms)
            self._say(hello, ahead=DELIMITER)  # ends what the boot loader may have said
            self._hello_at_us = now_us + HELLO_PERIOD_US
        if self._fault_to_say is not None:
            self._say(self._fault_to_say)
            self._fault_to_say = None
        self._say(self._state(now_us))

    def _read_buttons(self, now_us: int) -> None:
        if self.is_stop_open and self._modes.mode is not Mode.STOPPED:
            self._modes.stop(now_us)
        is_pressed = self.is_start_closed and not self._was_start_closed
        self._was_start_closed = self.is_start_closed
        if is_pressed and not self.is_stop_open:
            self._modes.press_start(now_us)

    def _take_setpoint(self, setpoint: Setpoint, sequence: int) -> None:
        self._heard_at_us = self._now_us
        if not self._is_new(sequence):
            self._refuse(Fault(FaultCode.STALE, NO_JOINT, sequence))
            return
        fault = self._modes.follow(setpoint, self._now_us)
        if fault is None:
            self._accept(sequence)
            self._last_command = None  # its number may come round: no host repeats it after this
        else:
            self._refuse(fault)

    def _take_command(self, command: Command, sequence: int) -> None:
        self._heard_at_us = self._now_us
        kind = type(command)
        if self._last_command is not None and self._last_command[:2] == (kind, sequence):
            result = self._last_command[2]
        elif self._is_new(sequence):
            result = self._obey(command)
            self._accept(sequence)
            self._last_command = kind, sequence, result
        elif kind is Stop:
            # A late STOP stops all the same: it can only err on the safe side.
            result = self._modes.stop(self._now_us)
        else:
            result = Result.STALE
        if result is not Result.OK:
            self._refused += 1
        self._say(Ack(sequence, result))

    def _obey(self, command: Command) -> Result:
        if self.is_stop_open and isinstance(command, Clear) and self.mode is Mode.STOPPED:
            return Result.STOPPED
        return self._modes.obey(command, self._now_us)

    def _is_new(self, sequence: int) -> bool:
        return self._accepted_at_us is None or is_newer(sequence, self._echo)

    def _accept(self, sequence: int) -> None:
        self._echo = sequence
        self._accepted_at_us = self._now_us

    def _refuse(self, fault: Fault) -> None:
        """Counts; only the newest reason is said, so that bad frames never fill the line."""
        self._refused += 1
        self._fault_to_say = fault

    def _say(self, message: Message, ahead: bytes = b'') -> None:
        self._sent = self._sent + 1 & HIGHEST_U16
        wire = ahead + encode(message, self._sent)
        if len(self._output) + len(wire) <= MAX_OUTPUT_BYTES:
            self._output += wire

    def _state(self, now_us: int) -> State:
        since = self._accepted_at_us
        return State(
            echo=self._echo,
            echo_age_us=HIGHEST_U16 if since is None else _saturated(now_us - since),
            mode=self._modes.mode,
            flags=self._modes.flags,
            fault=self._modes.fault,
            battery_mv=_saturated(self.battery_mv),
            bad_frames=_saturated(self._reader.bad_frames),
            overruns=_saturated(self._reader.overruns),
            refused=_saturated(self._refused),
            joints=self._joints(),
        )

    def _joints(self) -> tuple[Joint, ...]:
        if self.measured is not None:
            return tuple(Joint(Known.MEASURED, count) for count in self.measured)
        return tuple(
            Joint(Known.UNKNOWN, 0) if pulse is None else Joint(Known.COMMANDED, round(pulse))
            for pulse in self.pulses
        )


def _saturated(value: int) -> int:
    return min(max(value, 0), HIGHEST_U16)


def _fault_of(unreadable: Unreadable) -> Fault:
    is_hosts = unreadable.is_known_type and unreadable.type_code < FIRST_OF_BOARD
    code = FaultCode.MALFORMED if is_hosts else FaultCode.UNKNOWN_TYPE
    return Fault(code, NO_JOINT, unreadable.type_code)
