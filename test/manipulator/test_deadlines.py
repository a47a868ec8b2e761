"""docs/safety.md lists the deadlines of manipulator/deadlines.py and of the board."""

import re
from pathlib import Path

import pytest

from bridge.protocol import MAX_DEADLINE_MS
from manipulator import deadlines

TEXT = (Path(__file__).parents[2] / 'docs/safety.md').read_text()
ROWS = [
    [cell.strip() for cell in line.strip('|').split('|')]
    for line in TEXT.split('## Hops and deadlines')[1].split('\n## ')[0].splitlines()
    if line.startswith('| ')
]


def deadline(reaction):
    """The seconds in the one row whose reaction begins so."""
    (cell,) = [row[2] for row in ROWS if len(row) == 4 and row[3].startswith(reaction)]
    return float(re.search(r'\d+(\.\d+)?', cell)[0])


@pytest.mark.parametrize(
    ('reaction', 'seconds'),
    [
        ('brakes along the path', deadlines.POSE_PAUSE),
        ('stops publishing setpoints', deadlines.POSE_DEADLINE),
        ('drops every goal, starts again', deadlines.FOLLOWING_PATIENCE),
        ('drops every goal; immediately', deadlines.STATE_DEADLINE),
        ('the same; since a stop was cleared', 1e-3 * MAX_DEADLINE_MS),
        ('*disconnected*', deadlines.BOARD_DEADLINE),
    ],
)
def test_the_table_of_hops_has_the_deadlines_of_the_code(reaction, seconds):
    assert deadline(reaction) == pytest.approx(seconds)


def test_the_period_of_machine_state_is_that_of_the_table():
    (cell,) = [row[2] for row in ROWS if row[0].startswith('`machine_state`')]
    assert f'every {deadlines.STATE_PERIOD:g} s' in cell


def test_each_deadline_leaves_room_for_the_messages_that_it_waits_for():
    assert deadlines.POSE_PAUSE < deadlines.POSE_DEADLINE <= deadlines.MESSAGE_AGE
    assert deadlines.STATE_DEADLINE >= 3 * deadlines.STATE_PERIOD
    assert deadlines.HAND_OVER > deadlines.RELEASE
