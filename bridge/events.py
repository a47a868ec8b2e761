"""What the host's side of the line has to tell: plain values, in the order they happened."""

from dataclasses import dataclass
from typing import TypeAlias

from bridge.messages import Command, Fault, Hello, State


@dataclass(frozen=True)
class Opened:
    """The port is open; the board may be booting."""


@dataclass(frozen=True)
class Connected:
    """The board has announced itself, fits, and has told its state."""

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
    """A command was obeyed."""

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
