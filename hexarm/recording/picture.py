"""The picture of a recording: commanded, measured, refused, over one axis of time."""

from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hexarm.pictures import style
from hexarm.recording.run_summary import Event, RunSummary, Series
from manipulator.arrays import Array
from manipulator.states import MachineState, MotionResult

COMMANDED, DONE, GOAL, BAD, NOTE = (
    style.LIGHT, style.AXES[0], '#d4a017', style.LIMIT, style.SOFT,
)  # fmt: skip
RESULTS: dict[str, str] = {MotionResult.MOVING: DONE, MotionResult.PLANNING: '#3aa6b9'}
STATES: dict[str, str] = {
    MachineState.ENABLED: '#6a994e',
    MachineState.HOLDING: '#d4a017',
    MachineState.STOPPED: BAD,
    MachineState.FAULT: BAD,
}
AXES = ('x (mm)', 'roll (°)', 'y (mm)', 'pitch (°)', 'z (mm)', 'yaw (°)')
SMALLEST_SPAN = 0.2
"""Of an axis (mm, °): what does not move is not drawn as if it did."""

LISTED = 16
NUMBER_WIDTH = 0.021
"""Of an event's number, as part of the axis of time."""

QUIET = (
    MotionResult.IDLE,
    MotionResult.PLANNING,
    MotionResult.MOVING,
    MotionResult.REACHED,
)


def draw(summary: RunSummary, begin: float, end: float, picture: Path) -> None:
    """Saves the picture of the time from begin to end (s)."""
    part = summary.between(begin, end)
    listed = numbered(part.events)
    lines = min(len(listed), LISTED) + (len(listed) > LISTED)
    height = 12.2 + 0.24 * lines
    style.use()
    figure = plt.figure(figsize=(13, height), dpi=110)
    below = (0.55 + 0.24 * lines) / height
    grid = figure.add_gridspec(
        6, 2, height_ratios=(0.35, 1, 1, 1, 1, 1.5), hspace=0.22, wspace=0.16,
        left=0.065, right=0.985, top=1 - 0.95 / height, bottom=below + 0.42 / height,
    )  # fmt: skip
    strips = [figure.add_subplot(grid[0, column]) for column in (0, 1)]
    panels = [figure.add_subplot(grid[row, column]) for row in range(1, 6) for column in (0, 1)]
    for strip in strips:
        _states(strip, summary.events, begin, end)
    _poses(panels[:6], part)
    _errors(panels[6:8], part)
    _joints(panels[8:], part)
    for axes in (*strips, *panels):
        axes.set_xlim(begin, end)
        axes.tick_params(labelbottom=axes in panels[8:])
    for axes in panels:
        axes.grid(True)
        for _, event in listed:
            axes.axvline(event.time, color=BAD if event.is_bad else NOTE, lw=0.7, alpha=0.55)
    _numbers(strips, listed)
    _words(figure, summary, listed, height)
    style.save(figure, picture)


def numbered(events: tuple[Event, ...]) -> list[tuple[int, Event]]:
    """The events worth a line, with a number each; the same one after another only once."""
    kept: list[Event] = []
    for event in events:
        is_quiet = event.source == 'motion' and event.what in QUIET
        if is_quiet or (kept and _said(kept[-1]) == _said(event)):
            continue
        kept.append(event)
    return list(enumerate(kept, start=1))


def _said(event: Event) -> tuple[str, str, str]:
    return event.source, event.what, event.reason


def _states(axes: Axes, events: tuple[Event, ...], begin: float, end: float) -> None:
    """Two bands: the machine's state, and whether it moves."""
    axes.set(ylim=(0, 1), yticks=(0.28, 0.75), yticklabels=('motion', 'machine'))
    axes.spines[:].set_visible(False)
    axes.tick_params(length=0)
    for y, source in ((0.5, 'machine'), (0.03, 'motion')):
        changes = [e for e in events if e.source == source]
        for event, until in zip(changes, [*(e.time for e in changes[1:]), end], strict=True):
            left, right = max(event.time, begin), min(until, end)
            colour = STATES.get(event.what, BAD if event.is_bad else COMMANDED)
            colour = RESULTS.get(event.what, colour)
            if right > left:
                axes.barh(y, right - left, 0.42, left, align='edge', color=colour, alpha=0.55)
            if right - left > 0.09 * (end - begin):
                axes.text(left, y + 0.2, f' {event.what}', va='center', size=7.5)


def _poses(panels: list[Axes], part: RunSummary) -> None:
    for k, axes in enumerate(panels):
        column = k // 2 if k % 2 == 0 else 3 + k // 2
        scale = 1e3 if column < 3 else np.degrees(1.0)
        commanded, done, goals = (
            Series(s.times, scale * s.values[:, [column]])
            for s in (part.setpoint, part.pose, part.goals)
        )
        _line(axes, commanded, color=COMMANDED, lw=3.2, label='commanded (setpoint)')
        _line(axes, done, color=DONE, lw=1.1, label='measured (pose)')
        axes.set_ylabel(AXES[k])
        _goals(axes, goals)


def _goals(axes: Axes, goals: Series) -> None:
    """Goals as diamonds, at the edge where they lie beyond: many a refused one is far away."""
    low, high = axes.get_ylim()
    spread = max(0.0, SMALLEST_SPAN - (high - low)) / 2 + 0.1 * (high - low)
    low, high = low - spread, high + spread
    axes.set_ylim(low, high)
    inside = np.clip(goals.values, low, high)
    axes.plot(goals.times, inside, 'D', color=GOAL, ms=5, mew=0, clip_on=False, label='goal')


def _errors(panels: list[Axes], part: RunSummary) -> None:
    error = part.pose_error
    for k, (axes, scale, label) in enumerate(
        zip(panels, (1e3, np.degrees(1.0)), ('error (mm)', 'error (°)'), strict=True)
    ):
        values = scale * error.values[:, [k]]
        _line(axes, Series(error.times, values), color=style.AXES[1], lw=1.0)
        largest = float(np.max(values, initial=0.0))
        axes.set(ylabel=label, ylim=(0.0, max(1.08 * largest, SMALLEST_SPAN / 4)))


def _joints(panels: list[Axes], part: RunSummary) -> None:
    is_length = all(name.startswith('leg_') for name in part.joint_names)
    scale, unit = (1e3, 'mm') if is_length else (float(np.degrees(1.0)), '°')
    for k, name in enumerate(part.joint_names):
        look = style.curve(k)
        for axes, series, own in (
            (panels[0], part.joint_command, {'lw': 3.2, 'alpha': 0.3, 'ls': '-'}),
            (panels[0], part.joint_states, {'lw': 1.1, 'label': name}),
            (panels[1], part.joint_error, {'lw': 1.0}),
        ):
            one = Series(series.times, scale * series.values[:, [k]])
            _line(axes, one, **look | own)
    for axes, label in zip(panels, (f'joints ({unit})', f'joint error ({unit})'), strict=True):
        axes.set(xlabel='time since the recording began (s)', ylabel=label)
    if part.joint_names:
        panels[0].legend(ncols=7, frameon=False, loc='lower left', bbox_to_anchor=(-0.01, 0.98),
                         fontsize=8, handlelength=1.2, columnspacing=1.0)  # fmt: skip


def _line(axes: Axes, series: Series, **look: Any) -> None:
    """A line that breaks where nothing was received for long."""
    times, values = broken(series)
    axes.plot(times, values, solid_capstyle='round', **look)


def broken(series: Series) -> tuple[Array, Array]:
    """The series with a NaN in each pause of more than half a second and ten usual steps."""
    steps = np.diff(series.times)
    if not len(steps):
        return series.times, series.values
    gaps = np.flatnonzero(steps > max(0.5, 10 * float(np.median(steps)))) + 1
    return np.insert(series.times, gaps, np.nan), np.insert(series.values, gaps, np.nan, axis=0)


def _numbers(strips: list[Axes], listed: list[tuple[int, Event]]) -> None:
    """The number of each event above its moment, pushed aside where there are many."""
    for axes in strips:
        left, right = axes.get_xlim()
        step = NUMBER_WIDTH * (right - left)
        place = left - step
        for number, event in listed[:LISTED]:
            place = max(event.time, place + step)
            axes.text(
                place, 1.02, str(number), ha='center', va='bottom', size=7.5, weight='bold',
                color=BAD if event.is_bad else NOTE,
            )  # fmt: skip


def _words(
    figure: Figure, summary: RunSummary, listed: list[tuple[int, Event]], height: float
) -> None:
    name = f'/{summary.namespace}: commanded, measured, refused'
    figure.text(0.02, 1 - 0.36 / height, name, size=14, weight='bold')
    handles, labels = figure.axes[2].get_legend_handles_labels()
    figure.legend(handles, labels, ncols=3, frameon=False, loc='upper right')
    lines = [_sentence(number, event) for number, event in listed[:LISTED]]
    if len(listed) > LISTED:
        lines.append(f'… and {len(listed) - LISTED} more: hexarm plot --csv lists all')
    for k, line in enumerate(lines):
        is_bad = k < LISTED and listed[k][1].is_bad
        y = (0.24 * (len(lines) - k) - 0.02) / height
        figure.text(0.02, y, line, color=BAD if is_bad else NOTE, size=8.5)


def _sentence(number: int, event: Event) -> str:
    reason = f': {event.reason}' if event.reason else ''
    times = f' ({event.count} times)' if event.count > 1 else ''
    text = f'{number:>2}  {event.time:.2f} s  {event.source} {event.what}{times}{reason}'
    return text if len(text) <= 170 else text[:169] + '…'
