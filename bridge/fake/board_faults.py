"""Faults carried out on the fake board, its servos and its line; in the board's thread."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from bridge.fake.board import AnyBoard
from bridge.fake.faults import FaultKind, Faults
from bridge.fake.faulty_bytes import FaultyBytes
from bridge.protocol import PROTOCOL_VERSION, ResetCause


@dataclass
class BoardFaults:
    """Begins and ends what `faults` says; the line's bytes pass through `to_board` and `to_host`.

    plug: pulls the cable (False) and puts it back. A stuck servo is channel 0.
    """

    board: AnyBoard
    faults: Faults
    plug: Callable[[bool], None]
    seed: int = 0
    _to_board: FaultyBytes = field(init=False)
    _to_host: FaultyBytes = field(init=False)
    _battery_mv: int = field(init=False, default=0)

    def __post_init__(self) -> None:
        self._to_board = FaultyBytes(self.seed)
        self._to_host = FaultyBytes(self.seed + 1)

    @property
    def stuck_channel(self) -> int | None:
        """The servo that does not move, if there is one."""
        return 0 if FaultKind.STUCK in self.faults.active else None

    def advance(self, now: float) -> None:
        """Begins and ends what is due at `now` (s, monotonic)."""
        for kind, begins in self.faults.advance(now):
            act = self._acts().get(kind)
            if act is not None:
                act(begins)

    def to_board(self, received: bytes, now: float) -> bytes:
        """What the board gets of the host's bytes."""
        return self._to_board.pass_on(received, self.faults.active, now)

    def to_host(self, output: bytes, now: float) -> bytes:
        """What the host gets of the board's bytes."""
        passed = self._to_host.pass_on(output, self.faults.active, now)
        return b'' if FaultKind.MUTE in self.faults.active else passed

    def _acts(self) -> dict[FaultKind, Callable[[bool], None]]:
        return {
            FaultKind.UNPLUG: lambda begins: self.plug(not begins),
            FaultKind.RESET: self._reset,
            FaultKind.VERSION: self._change_version,
            FaultKind.UNDERVOLTAGE: self._drain,
        }

    def _reset(self, begins: bool) -> None:
        if begins:
            self.board.reset(ResetCause.WATCHDOG)

    def _change_version(self, begins: bool) -> None:
        """Another program on the board, and the right one again."""
        version = PROTOCOL_VERSION + 1 if begins else PROTOCOL_VERSION
        self.board.settings = replace(self.board.settings, version=version)
        self.board.reset(ResetCause.EXTERNAL)

    def _drain(self, begins: bool) -> None:
        if begins:
            self._battery_mv = self.board.battery_mv
            self.board.battery_mv = self.board.settings.minimum_battery_mv // 2
        else:
            self.board.battery_mv = self._battery_mv
