"""The board at the other end of a port that this process uses alone, for one session.

A port that is lost is not opened again, because the position of the servos would be unknown. What
the session finds becomes values of the machine file.
"""

import signal
import threading
import time
from collections.abc import Iterator
from concurrent.futures import TimeoutError as NoAnswer
from contextlib import contextmanager

from bridge.calibration import COUNTS_PER_US
from bridge.events import Disconnected, Event, FaultReported, Incompatible
from bridge.link import Link, Ticket
from bridge.link_thread import LinkThread, SerialPort
from bridge.protocol import Arm, Clear, Command, Disarm, FaultCode, Known, Mode, Setpoint, Stop
from bridge.servo_config import BoardConfig, ServoConfig
from bridge.session import Session
from manipulator.errors import LinkError, Refused
from manipulator.yaml_edit import Place

FIELDS = ('sign', 'centre_us', 'centre_deg', 'centre_mm', 'us_per_deg', 'us_per_mm')


def changed_values(
    before: tuple[ServoConfig, ...], after: tuple[ServoConfig, ...]
) -> dict[Place, str]:
    """Where the machine file changes, and to what."""
    found: dict[Place, str] = {}
    for i, (old, new) in enumerate(zip(before, after, strict=True)):
        place: Place = ('servos', 'joints', i)
        for name in FIELDS:
            if getattr(old, name) != getattr(new, name):
                field = (*place, name)
                found[field] = str(getattr(new, name))
        for end, (was, now) in enumerate(zip(old.pulse_range_us, new.pulse_range_us, strict=True)):
            if was != now:
                bound = (*place, 'pulse_range_us', end)
                found[bound] = str(now)
    return found


def in_words(before: tuple[ServoConfig, ...], after: tuple[ServoConfig, ...]) -> list[str]:
    """One line a value that has changed."""
    lines = []
    for old, new in zip(before, after, strict=True):
        for name in (*FIELDS, 'pulse_range_us'):
            was, now = getattr(old, name), getattr(new, name)
            if was != now:
                lines.append(f'  {old.name} {name}: {_text(was)} → {_text(now)}')
    return lines


def _text(value: object) -> str:
    if isinstance(value, tuple):
        return f'[{", ".join(f"{end:g}" for end in value)}]'
    return f'{value:g}' if isinstance(value, int | float) else str(value)


CONNECT_WITHIN, ARM_WITHIN, ANSWER_WITHIN = 6.0, 10.0, 1.0
LOOK_EVERY = 0.02
TRIES = 3
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class ServoLine:
    """A context manager: connects when it is entered, and takes the power from the servos at exit.

    is_off: afterwards, whether the board has confirmed that. Where nothing was energised
    them, they are left as they were: a board may be holding a platform up.
    """

    def __init__(self, port: str, config: BoardConfig) -> None:
        """LinkError: why the port cannot be used."""
        self.problem = ''
        self.is_off = False
        self.is_in_use = False
        self._is_energised = False
        self._config = config
        self._port: SerialPort | None = _opened(port, config.link.baud)
        self._session = Session(len(config.servos.joints))
        self._is_ready = threading.Event()
        self._link = Link(self._session, self._note)
        self._thread = LinkThread(self._open_once, self._link)

    def __enter__(self) -> 'ServoLine':
        """LinkError where the board does not answer."""
        self._thread.start()
        try:
            self._await_board()
        except BaseException:
            self._thread.close()
            raise
        return self

    def __exit__(self, *exception: object) -> None:
        """Servos off, as far as there is a board to obey; then the port is given back."""
        with _undisturbed():
            self.switch_off()
            self._thread.close()

    def switch_off(self) -> None:
        """Takes the power from the servos; `is_off` is whether the board has confirmed it."""
        until = time.monotonic() + ANSWER_WITHIN
        while self._must_go_off and time.monotonic() < until:
            try:
                self._ask(Disarm())
                self.is_off = True
            except Refused:  # a STOP is in progress, or a frame was lost
                time.sleep(LOOK_EVERY)

    @property
    def mode(self) -> Mode | None:
        """The board's, None where there is none."""
        state = self._session.state
        return None if state is None else state.mode

    @property
    def _must_go_off(self) -> bool:
        return self.is_in_use and not self.is_off and self.mode is not None

    @property
    def has_released(self) -> bool:
        """The servos had power and have it no more."""
        return self._is_energised and self.mode in (Mode.DISARMED, Mode.FAULT)

    @property
    def pulses(self) -> tuple[float, ...]:
        """What the servos get now, in µs by channel; Refused where one gets nothing."""
        state = self._session.state
        if state is None or any(joint.known is Known.UNKNOWN for joint in state.joints):
            raise Refused('a servo gets no pulse')
        return tuple(joint.count / COUNTS_PER_US for joint in state.joints)

    def energise(self, counts: tuple[int, ...]) -> None:
        """Servo by servo, each at its count; where all are on already, they stay where they are.

        Refused with the reason of the board: stopped, a fault, the battery.
        """
        self.is_in_use = True
        self._ask(Arm(counts))
        until = time.monotonic() + ARM_WITHIN
        while self.mode not in (Mode.ARMED, Mode.HOLDING):
            if self.mode is Mode.ARMING:  # takes as long as set in the machine file, and ends
                until = time.monotonic() + ARM_WITHIN
            if self.problem or time.monotonic() > until:
                raise Refused(f'the servos were not energised: {self.problem or "no answer"}')
            time.sleep(LOOK_EVERY)
        self._is_energised = True

    def move(self, counts: tuple[int, ...]) -> None:
        """Be there now."""
        setpoint = Setpoint(self._config.link.setpoint_deadline_ms, counts)
        ticket = Ticket(setpoint, time.monotonic())
        self._thread.post(lambda: self._link.put_setpoint(ticket))

    def stop(self) -> None:
        """At once; repeated until the board has acknowledged it."""
        self._thread.request(Stop())

    def clear(self) -> None:
        """Clears the stop; nothing moves. Refused with the reason."""
        self._ask(Clear())

    def _ask(self, command: Command) -> None:
        """Repeats a failed request: a busy computer may lose an answer."""
        for tries_left in reversed(range(TRIES)):
            try:
                self._thread.request(command).result(ANSWER_WITHIN)
                break
            except NoAnswer as error:
                raise Refused('the board does not answer') from error
            except Refused:
                if not tries_left:
                    raise

    def _await_board(self) -> None:
        if not self._is_ready.wait(CONNECT_WITHIN):
            reason = self.problem or 'the board does not answer: is its firmware on it?'
            raise LinkError(reason)
        if self.mode is None:
            raise LinkError(self.problem or 'no frame comes from the board any more')

    def _open_once(self) -> SerialPort:
        port, self._port = self._port, None
        if port is None:
            raise LinkError(self.problem or 'the port was lost')
        return port

    def _note(self, event: Event, now: float) -> None:
        """In the link's thread."""
        match event:
            case Disconnected(reason) | Incompatible(reason):
                self.problem = self.problem or reason
                self._is_ready.set()
            case FaultReported(fault):
                if fault.code is FaultCode.UNDERVOLTAGE:
                    self.problem = 'the battery is too low'
            case _:
                if self.mode is not None:
                    self._is_ready.set()


def _opened(port: str, baud: int) -> SerialPort:
    try:
        return SerialPort(port, baud)
    except LinkError as error:
        if 'in use' in str(error):
            raise LinkError(f'{error}; end hexarm up, then try again') from error
        raise


@contextmanager
def _undisturbed() -> Iterator[None]:
    """No signal takes the time that the servos need to go off."""
    before = {number: signal.signal(number, signal.SIG_IGN) for number in SIGNALS}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
