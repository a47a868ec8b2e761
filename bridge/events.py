"""The host's phases, and the events of its session, in order."""

import enum
from dataclasses import dataclass
from typing import TypeAlias

from bridge.protocol import Command, Fault, Hello, State


class Phase(enum.Enum):
    """How far the host has come with the board."""

    CLOSED = 'no port'
    WAITING = 'waiting for HELLO'
    CONNECTING = 'waiting for the first STATE'
    READY = 'ready'
    INCOMPATIBLE = 'another board'


@dataclass(frozen=True)
class Opened:
    """The port is open; the board may be booting."""


@dataclass(frozen=True)
class Connected:
    """The board has sent its HELLO, matches, and has sent its first STATE."""

    hello: Hello


@dataclass(frozen=True)
class Disconnected:
    """No board to talk to, and why."""

    reason: str


@dataclass(frozen=True)
class Incompatible:
    """A board that must not be talked to, and why."""

    reason: str


@dataclass(frozen=True)
class StateReceived:
    """One STATE of a board that is connected."""

    state: State


@dataclass(frozen=True)
class Acknowledged:
    """A command was obeyed, and the session's state shows what came of it."""

    command: Command


@dataclass(frozen=True)
class CommandFailed:
    """A command was not obeyed, and why."""

    command: Command
    reason: str


@dataclass(frozen=True)
class FaultReported:
    """The board refused a frame, or stopped by itself."""

    fault: Fault


Event: TypeAlias = (
    Opened
    | Connected
    | Disconnected
    | Incompatible
    | StateReceived
    | Acknowledged
    | CommandFailed
    | FaultReported
)


def without_passed_states(events: list[Event]) -> list[Event]:
    """Of STATEs that came at once and in a row, the last one of each mode.

    A process that was frozen finds old STATEs in its port: reported one by one, as if they were
    new, they would have the machine driven back to where its joints were long ago.
    """
    kept: list[Event] = []
    for event in events:
        if kept and _is_passed(kept[-1], event):
            kept.pop()
        kept.append(event)
    return kept


def _is_passed(old: Event, new: Event) -> bool:
    match old, new:
        case StateReceived(before), StateReceived(after):
            return before.mode is after.mode
    return False
