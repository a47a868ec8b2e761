"""A recording as tables of comma-separated values."""

import csv
from collections.abc import Iterable, Sequence
from pathlib import Path

from hexarm.recording.story import POSE_COLUMNS, Series, Story


def write(story: Story, folder: Path) -> list[Path]:
    """One file a table into the folder, which is made; OSError where that cannot be done."""
    folder.mkdir(parents=True, exist_ok=True)
    joints = story.joint_names
    tables = {
        'setpoint': (POSE_COLUMNS, story.setpoint),
        'pose': (POSE_COLUMNS, story.pose),
        'goals': (POSE_COLUMNS, story.goals),
        'pose_error': (('distance_m', 'angle_rad'), story.pose_error),
        'joint_command': (joints, story.joint_command),
        'joint_states': (joints, story.joint_states),
    }
    written = [
        _table(folder / f'{name}.csv', ('time_s', *columns), _rows(series))
        for name, (columns, series) in tables.items()
    ]
    events = ((f'{e.time:.4f}', e.source, e.what, e.count, e.reason) for e in story.events)
    heads = ('time_s', 'source', 'what', 'count', 'reason')
    return [*written, _table(folder / 'events.csv', heads, events)]


def _rows(series: Series) -> Iterable[Sequence[object]]:
    for time, values in zip(series.times, series.values, strict=True):
        yield (f'{time:.4f}', *(f'{value:.9g}' for value in values))


def _table(path: Path, heads: Sequence[str], rows: Iterable[Sequence[object]]) -> Path:
    with path.open('w', newline='', encoding='utf-8') as file:
        writer = csv.writer(file)
        writer.writerow(heads)
        writer.writerows(rows)
    return path
