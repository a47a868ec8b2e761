"""Many boards in one process, although they share the program's variables."""

import gc
import random
import threading

import pytest

from bridge.fake import program
from bridge.fake.board import Board
from bridge.fake.board_settings import BoardSettings
from bridge.frames import encode
from bridge.framing import FrameReader
from bridge.protocol import Arm, Hello, Joint, Known, Mode, ResetCause, Setpoint, State, Stop
from manipulator.errors import InvalidInput

RANGE, SPEED = (1100, 4900), 12_600.0


def settings(joints=6, **changes):
    values = {'arm_interval_us': 20_000, 'boot_us': 0}
    return BoardSettings((RANGE,) * joints, (SPEED,) * joints, **values | changes)


def armed(joints, count):
    board = Board(settings(joints))
    board.step(0.01)
    board.feed(encode(Arm((count,) * joints), 1))
    board.step(0.3)
    return board


def drive(board, joints, seed, steps=300):
    """What a board puts out while it follows random setpoints."""
    rng, found = random.Random(seed), []
    for k in range(steps):
        counts = tuple(rng.randint(*RANGE) for _ in range(joints))
        board.feed(encode(Setpoint(200, counts), 2 + k))
        board.step(0.013)
        found.append((board.pulses, board.take_output()))
    return found


def test_boards_that_take_turns_do_what_each_does_alone():
    alone = [drive(armed(joints, 3000), joints, joints, 100) for joints in (1, 6, 8)]
    boards = [armed(joints, 3000) for joints in (1, 6, 8)]
    rngs = [random.Random(joints) for joints in (1, 6, 8)]
    for k in range(100):
        for i, (board, joints) in enumerate(zip(boards, (1, 6, 8), strict=True)):
            counts = tuple(rngs[i].randint(*RANGE) for _ in range(joints))
            board.feed(encode(Setpoint(200, counts), 2 + k))
            board.step(0.013)
            assert (board.pulses, board.take_output()) == alone[i][k]


def test_boards_in_several_threads_do_what_each_does_alone():
    alone = drive(armed(6, 3000), 6, 5)
    found = {}

    def work(name):
        found[name] = drive(armed(6, 3000), 6, 5)

    threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(found[k] == alone for k in range(4))


def test_a_board_that_is_gone_takes_nothing_of_another_with_it():
    first, second = armed(6, 2000), armed(6, 4000)
    second.step(0.02)
    del second
    gc.collect()
    first.step(0.02)
    assert first.pulses == (2000,) * 6


def test_a_reset_forgets_all_but_the_memory():
    board = armed(6, 3000)
    board.feed(encode(Stop(), 2))
    board.memory = bytes(range(100))
    board.reset(ResetCause.WATCHDOG)
    assert board.pulses == (None,) * 6
    assert board.mode is Mode.DISARMED
    assert board.memory[:100] == bytes(range(100))
    board.step(0.01)
    messages = [frame.message for frame in FrameReader().feed(board.take_output())]
    assert isinstance(messages[0], Hello)
    assert messages[0].reset_cause is ResetCause.WATCHDOG


def test_bytes_during_the_boot_are_lost_and_none_are_sent():
    board = Board(settings(boot_us=300_000))
    board.step(0.299)
    board.feed(encode(Arm((3000,) * 6), 1))
    assert board.take_output() == b''
    board.step(0.301)
    assert board.mode is Mode.DISARMED
    assert board.take_output() != b''


def test_what_its_encoders_read_is_reported_as_measured():
    board = armed(3, 3000)
    board.measure((2990, 70_000, -5))
    board.take_output()
    board.step(0.02)
    (state,) = [f.message for f in FrameReader().feed(board.take_output())]
    assert isinstance(state, State)
    assert state.joints == tuple(Joint(Known.MEASURED, c) for c in (2990, 65_535, 0))


def test_nothing_is_sent_before_the_rest_is_over_and_a_state_right_then():
    board = armed(6, 3000)
    for passed in (0.0, 0.007, 0.019):
        board.step(passed)
        board.take_output()
        board.step(board.rest - 1e-6)
        assert board.take_output() == b''
        board.step(1e-6)
        (state,) = [f.message for f in FrameReader().feed(board.take_output())]
        assert isinstance(state, State)
    board.settings = settings(boot_us=300_000)
    board.reset(ResetCause.WATCHDOG)
    assert board.rest == pytest.approx(0.3)


@pytest.mark.parametrize(('millivolts', 'is_on'), [(6399, False), (6400, True)])
def test_a_battery_is_low_below_its_minimum(millivolts, is_on):
    board = Board(settings(minimum_battery_mv=6400), battery_mv=millivolts)
    board.step(0.05)
    board.feed(encode(Arm((3000,) * 6), 1))
    board.step(0.3)
    assert (board.pulses[0] is not None) == is_on


def test_its_uptime_has_more_than_sixteen_bits():
    board = Board(settings())
    board.step(200.0)
    board.take_output()
    board.step(0.5)
    messages = [frame.message for frame in FrameReader().feed(board.take_output())]
    uptimes = [m.uptime_ms for m in messages if isinstance(m, Hello)]
    assert uptimes[-1] == pytest.approx(200_500, abs=260)


def test_what_nobody_takes_is_dropped():
    board = Board(settings())
    board.step(60.0)
    assert len(board.take_output()) <= 1024
    board.step(0.1)
    messages = [frame.message for frame in FrameReader().feed(board.take_output())]
    assert sum(isinstance(m, State) for m in messages) >= 4


@pytest.mark.parametrize('millivolts', [-1, 0, 7600, 70_000])
def test_any_voltage_can_be_set_and_stays_within_what_can_be_reported(millivolts):
    board = Board(settings(), millivolts)
    assert board.battery_mv == min(max(millivolts, 0), 65_535)


def test_a_memory_that_is_too_large_is_refused():
    with pytest.raises(InvalidInput, match='161 bytes, the board has 160'):
        Board(settings(), memory=bytes(161))


def test_a_library_of_another_version_is_refused(monkeypatch):
    monkeypatch.setattr(program, 'MEMORY_BYTES', 1)
    monkeypatch.setattr(program, 'Wires', program.FlashTable)
    program.program.cache_clear()
    with pytest.raises(program.ProgramMissing, match='another version of hexarm'):
        program.program()
    program.program.cache_clear()
