from concurrent.futures import Future

import numpy as np
import pytest

from bridge.calibration import Calibration
from bridge.frames import table_crc
from bridge.programs import Upload, count_table
from bridge.protocol import Disarm, Stop, TableBegin, TableEnd, TableRow
from bridge.servo_config import BoardConfig
from hexarm import machines
from manipulator.errors import InvalidInput, Refused

CALIBRATION = Calibration.from_config(BoardConfig.from_machine(machines.read('robocake')).servos)
TIMES = np.arange(4) * 0.05
POSITIONS = np.radians(120.0 + np.arange(24).reshape(4, 6))


class Line:
    """Answers when it is told to."""

    def __init__(self):
        self.sent, self.ends = [], []

    def request(self, command):
        future = Future()
        self.sent.append((command, future))
        return future


def test_each_command_waits_for_the_answer_to_the_one_before():
    line = Line()
    commands = [Stop(), Disarm(), Stop()]
    Upload(line.request, commands, line.ends.append).begin()
    for k in range(3):
        assert [command for command, _ in line.sent] == commands[: k + 1]
        assert line.ends == []
        line.sent[-1][1].set_result(None)
    assert line.ends == ['']


def test_a_refusal_ends_it_and_reports_why():
    line = Line()
    Upload(line.request, [Stop(), Disarm()], line.ends.append).begin()
    line.sent[0][1].set_exception(Refused('no board'))
    assert len(line.sent) == 1
    assert line.ends == ['no board']


def test_what_is_too_late_is_not_begun():
    line, reasons = Line(), iter(['', 'too late'])
    Upload(line.request, [Stop(), Disarm()], line.ends.append, lambda: next(reasons)).begin()
    line.sent[0][1].set_result(None)
    assert len(line.sent) == 1
    assert line.ends == ['too late']


def test_what_is_done_is_done_however_late():
    line, reasons = Line(), iter([''])
    Upload(line.request, [Stop()], line.ends.append, lambda: next(reasons)).begin()
    line.sent[0][1].set_result(None)
    assert line.ends == ['']


def test_a_table_is_begun_sent_row_by_row_and_sealed_with_a_crc_over_the_whole():
    table = count_table(TIMES, POSITIONS, CALIBRATION)
    begin, *rows, end = table.upload
    assert begin == TableBegin(4, 50)
    assert rows == [TableRow(k, CALIBRATION.counts(POSITIONS[k])) for k in range(4)]
    assert end == TableEnd(table_crc([row.counts for row in rows]))


@pytest.mark.parametrize(
    ('times', 'positions', 'words'),
    [
        (TIMES[:1], POSITIONS[:1], 'at least 2'),
        (np.array([0, 0.05, 0.1, 0.2]), POSITIONS, 'differ'),
        (TIMES / 10, POSITIONS, '5 ms is outside'),
        (-TIMES, POSITIONS, 'outside'),
        (TIMES, POSITIONS * 3, 'row 0: crank_1'),
        (TIMES, POSITIONS * np.nan, 'not finite'),
        (TIMES * np.nan, POSITIONS, 'differ'),
    ],
)
def test_a_table_that_cannot_be_played_is_refused(times, positions, words):
    with pytest.raises(InvalidInput, match=words):
        count_table(times, positions, CALIBRATION)
