"""What the fake board plays by itself: a cycle or a table, as the firmware's play.c does.

Pulse counts by channel; times in seconds, in steps of one pulse period.
"""

import enum
import math
from collections.abc import Sequence

from bridge.fake.board_courses import (
    PERIOD,
    Counts,
    Course,
    Cycle,
    Solver,
    Table,
    is_within,
)
from bridge.frames import table_crc
from bridge.protocol import CycleAxis, Program, ProgramPart, Result, TableBegin, TableEnd, TableRow

RAMP = 1.0
APPROACH = 0.5
NEAR_COUNTS = 120
ROUNDING = 1
TABLE_BYTES = 5376
MIN_STEP_MS = 20
AXES = 6
HIGHEST_MHZ = 25_000


class Step(enum.Enum):
    """What one period of a program came to."""

    CHECKING = enum.auto()
    MOVING = enum.auto()
    DONE = enum.auto()
    UNREACHABLE = enum.auto()
    TOO_FAST = enum.auto()


def still_axes() -> list[CycleAxis]:
    """No cycle."""
    return [CycleAxis(axis, 0.0, 0, 0.0) for axis in range(AXES)]


class Programs:
    """What was uploaded, and the one that is being played; `axes` outlives a reset."""

    def __init__(
        self,
        count_ranges: Sequence[tuple[int, int]],
        count_speeds: Sequence[float],
        solve: Solver | None,
        axes: list[CycleAxis],
    ) -> None:
        self._ranges, self._solve = count_ranges, solve
        self._steps = [speed * PERIOD for speed in count_speeds]
        self._axes = axes
        self._rows: list[tuple[int, ...]] = []
        self._wanted = TableBegin(0, MIN_STEP_MS)
        self._is_whole = False
        self._course: Course = Table([(0,)], MIN_STEP_MS, False)
        self._from: Counts = ()
        self._start: Counts = ()
        self._before: Counts = ()
        self._is_loop = self._is_finishing = self._is_checked = False
        self._time = self._ramp = self._approach = 0.0

    @property
    def trouble_ms(self) -> int:
        """When in the program something was wrong."""
        return round(1000 * self._time) & 0xFFFF

    def store(self, command: ProgramPart) -> Result:
        """Keeps a part of a program, or says why not."""
        match command:
            case CycleAxis():
                return self._store_axis(command)
            case TableBegin():
                return self._begin_table(command)
            case TableRow():
                return self._store_row(command)
            case TableEnd():
                return self._end_table(command)

    @property
    def to_start(self) -> Program:
        """What the start button plays: what was uploaded, else the cycle."""
        return Program.TABLE if self._is_whole else Program.CYCLE

    def start_counts(self, program: int) -> tuple[int, ...] | None:
        """Where the program begins; None where there is none, or that is out of range."""
        course = self._course_of(program, True)
        start = None if course is None else course.start()
        if start is None or not self._is_in_range(start):
            return None
        return tuple(round(count) for count in start)

    def begin(self, program: int, is_loop: bool, present: Counts) -> Result:
        """Gets ready to check and play from the present counts on."""
        course = self._course_of(program, is_loop)
        if course is None:
            return Result.NO_PROGRAM
        start = course.start()
        if start is None or not self._is_in_range(start):
            return Result.OUT_OF_RANGE
        if not is_within(present, start, [NEAR_COUNTS] * len(present)):
            return Result.NOT_AT_START
        if isinstance(course, Table) and not course.is_slow_enough(self._steps):
            return Result.TOO_FAST
        if course.duration <= 0:
            return Result.OUT_OF_RANGE
        self._course, self._start, self._from = course, start, present
        self._is_loop, self._is_finishing = is_loop, False
        self._is_checked = isinstance(course, Table)
        self._time = self._ramp = self._approach = 0.0
        return Result.OK

    def finish(self) -> None:
        """Comes to an end smoothly from now on."""
        self._is_finishing = True

    def step(self) -> tuple[Step, Counts]:
        """One period further; the counts to aim at where the step is MOVING or DONE."""
        if not self._is_checked:
            return (Step.DONE, self._from) if self._is_finishing else self._check()
        step, counts = self._move()
        if step in (Step.MOVING, Step.DONE):
            # A fast sine passes through other samples each time than those it was checked by.
            if not is_within(self._before, counts, [most + ROUNDING for most in self._steps]):
                return Step.TOO_FAST, self._from
            self._before = counts
        return step, counts

    def _move(self) -> tuple[Step, Counts]:
        if self._approach == 0.0:
            self._before = self._from
        if self._approach < 1.0:
            return self._go_to_start()
        return self._play_table() if isinstance(self._course, Table) else self._play_cycle()

    def _store_axis(self, axis: CycleAxis) -> Result:
        if self._solve is None:
            return Result.NO_PROGRAM
        is_finite = math.isfinite(axis.amplitude) and math.isfinite(axis.phase)
        if axis.axis >= AXES or not is_finite or axis.frequency_mhz > HIGHEST_MHZ:
            return Result.OUT_OF_RANGE
        self._axes[axis.axis] = axis
        return Result.OK

    def _begin_table(self, begin: TableBegin) -> Result:
        self._is_whole, self._rows, self._wanted = False, [], TableBegin(0, MIN_STEP_MS)
        if begin.rows > TABLE_BYTES // (2 * len(self._ranges)):
            return Result.TOO_LARGE
        if begin.rows < 2 or begin.step_ms < MIN_STEP_MS:
            return Result.BAD_TABLE
        self._wanted = begin
        return Result.OK

    def _store_row(self, row: TableRow) -> Result:
        if self._is_whole or row.index != len(self._rows) or row.index >= self._wanted.rows:
            return Result.BAD_TABLE
        if len(row.counts) != len(self._ranges):
            return Result.WRONG_JOINTS
        if not self._is_in_range(row.counts):
            return Result.OUT_OF_RANGE
        self._rows.append(row.counts)
        return Result.OK

    def _end_table(self, end: TableEnd) -> Result:
        self._is_whole = (
            0 < self._wanted.rows == len(self._rows) and table_crc(self._rows) == end.crc
        )
        return Result.OK if self._is_whole else Result.BAD_TABLE

    def _course_of(self, program: int, is_loop: bool) -> Course | None:
        if program == Program.TABLE and self._is_whole:
            return Table(self._rows, self._wanted.step_ms, is_loop)
        is_moving = any(axis.amplitude and axis.frequency_mhz for axis in self._axes)
        if program == Program.CYCLE and is_moving and self._solve is not None:
            return Cycle(self._axes, self._solve)
        return None

    def _check(self) -> tuple[Step, Counts]:
        """One sample of the cycle a period."""
        counts = self._course.at(self._time, 1.0)
        if counts is None or not self._is_in_range(counts):
            return Step.UNREACHABLE, self._from
        if self._time > 0 and not is_within(self._before, counts, self._steps):
            return Step.TOO_FAST, self._from
        self._before = counts
        self._time += PERIOD
        if self._time > self._course.duration + PERIOD:
            self._is_checked, self._time = True, 0.0
        return Step.CHECKING, self._from

    def _go_to_start(self) -> tuple[Step, Counts]:
        if self._is_finishing:
            return Step.DONE, self._from
        self._approach = min(self._approach + PERIOD / APPROACH, 1.0)
        part = _smooth(self._approach)
        pairs = zip(self._from, self._start, strict=True)
        return Step.MOVING, tuple(a + part * (b - a) for a, b in pairs)

    def _play_cycle(self) -> tuple[Step, Counts]:
        self._time += PERIOD
        if self._time >= self._course.duration:
            self._time -= self._course.duration
            self._is_finishing = self._is_finishing or not self._is_loop
        self._change_ramp()
        counts = self._course.at(self._time, _smooth(self._ramp))
        if counts is None or not self._is_in_range(counts):
            return Step.UNREACHABLE, self._from
        is_over = self._is_finishing and self._ramp <= 0
        return Step.DONE if is_over else Step.MOVING, counts

    def _play_table(self) -> tuple[Step, Counts]:
        self._change_ramp()
        pace, left = _smooth(self._ramp), self._course.duration - self._time
        if not self._is_loop:
            pace = min(pace, math.sqrt(2 * max(left, 0.0) / RAMP))
        self._time += pace * PERIOD
        is_over = self._is_finishing and self._ramp <= 0
        if self._is_loop and self._time >= self._course.duration:
            self._time -= self._course.duration
        if not self._is_loop and self._course.duration - self._time < 0.5 * PERIOD**2 / RAMP:
            self._time, is_over = self._course.duration, True
        counts = self._course.at(self._time, 1.0) or self._from
        return Step.DONE if is_over else Step.MOVING, counts

    def _change_ramp(self) -> None:
        change = -PERIOD / RAMP if self._is_finishing else PERIOD / RAMP
        self._ramp = min(max(self._ramp + change, 0.0), 1.0)

    def _is_in_range(self, counts: Counts) -> bool:
        pairs = zip(counts, self._ranges, strict=True)
        return all(low <= round(count) <= high for count, (low, high) in pairs)


def _smooth(u: float) -> float:
    """3u² − 2u³: from 0 to 1 without a jerk in speed at either end."""
    return u * u * (3.0 - 2.0 * u)
