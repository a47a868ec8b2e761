"""Tables for the board to play, and commands that are sent one after the other."""

from collections.abc import Callable, Sequence
from concurrent.futures import Future
from dataclasses import dataclass

import numpy as np

from bridge.calibration import Calibration
from bridge.frames import table_crc
from bridge.protocol import Command, TableBegin, TableEnd, TableRow
from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.formatting import counted

EQUAL = 1e-3
"""Seconds by which time steps may differ."""
MIN_STEP_MS, MAX_STEP_MS = 20, 65_535


@dataclass(frozen=True)
class CountTable:
    """Rows of pulse counts by channel, step_ms apart."""

    rows: tuple[tuple[int, ...], ...]
    step_ms: int

    @property
    def upload(self) -> tuple[Command, ...]:
        """The commands that bring it onto a board, in order."""
        rows = (TableRow(index, counts) for index, counts in enumerate(self.rows))
        begin = TableBegin(len(self.rows), self.step_ms)
        return begin, *rows, TableEnd(table_crc(self.rows))


def count_table(times: Array, positions: Array, calibration: Calibration) -> CountTable:
    """Positions (rows, joints) at `times` (rows,) in seconds as counts.

    InvalidInput where the time steps differ, or a row is beyond what a servo can reach.
    """
    if len(times) < 2:
        raise InvalidInput(f'{counted(len(times), "row")}, a table has at least 2')
    steps = np.diff(times)
    if not (np.abs(steps - steps.mean()) <= EQUAL).all():
        raise InvalidInput(f'time steps from {steps.min():.4g} to {steps.max():.4g} s differ')
    step_ms = round(1e3 * float(steps.mean()))
    if not MIN_STEP_MS <= step_ms <= MAX_STEP_MS:
        raise InvalidInput(f'a time step of {step_ms} ms is outside [20, 65535] ms')
    rows = []
    for k, row in enumerate(positions):
        try:
            rows.append(calibration.counts(row))
        except InvalidInput as error:
            raise InvalidInput(f'row {k}: {error}') from error
    return CountTable(tuple(rows), step_ms)


class Upload:
    """`on_end` receives '' when all were obeyed, else the reason; in the link's thread.

    No command is begun once `late` returns a reason.
    """

    def __init__(
        self,
        request: Callable[[Command], 'Future[None]'],
        commands: Sequence[Command],
        on_end: Callable[[str], None],
        late: Callable[[], str] = lambda: '',
    ) -> None:
        self._request, self._on_end, self._late = request, on_end, late
        self._left = iter(commands)

    def begin(self) -> None:
        """Sends the first command."""
        command = next(self._left, None)
        reason = self._late() if command is not None else ''
        if command is None or reason:
            self._on_end(reason)
        else:
            self._request(command).add_done_callback(self._go_on)

    def _go_on(self, done: 'Future[None]') -> None:
        error = done.exception()
        if error is None:
            self.begin()
        else:
            self._on_end(str(error))
