"""What every board does on the line: announces itself, answers, survives garbage."""

import dataclasses
import random

import numpy as np
import pytest

from bridge import cobs
from bridge.frames import checksum, encode
from bridge.framing import FrameReader
from bridge.protocol import (
    MAX_JOINTS,
    NO_JOINT,
    Ack,
    Arm,
    Clear,
    Disarm,
    Fault,
    FaultCode,
    Flag,
    Hello,
    Joint,
    Known,
    Mode,
    ResetCause,
    Result,
    Setpoint,
    State,
    Stop,
)

PARK = (3000, 2900, 3100, 3000, 2900, 3100)
CENTRE = Joint(Known.COMMANDED, 3000)
MOVED = tuple(count + 200 for count in PARK)


def test_silent_while_it_boots_then_announces_itself_disarmed(driver):
    assert driver.run(0.29) == []
    hello, state = driver.run(0.02)
    assert (hello.version, hello.joint_count) == (1, 6)
    assert hello.reset_cause is ResetCause.POWER_ON
    assert state.mode is Mode.DISARMED
    assert {joint.known for joint in state.joints} == {Known.UNKNOWN}
    assert driver.board.pulses == (None,) * 6


def test_it_says_how_long_it_has_been_up(driver):
    """Since its program began, after the boot."""
    uptimes = [hello.uptime_ms for hello in driver.hellos(1.3)]
    assert uptimes == pytest.approx([250 * k for k in range(len(uptimes))], abs=30)


def test_bytes_during_the_boot_are_lost(driver):
    driver.run(0.1)
    driver.send(Arm(PARK))
    assert not [m for m in driver.run(1.0) if isinstance(m, Ack)]
    assert driver.state().mode is Mode.DISARMED


def test_says_hello_again_only_while_the_host_is_silent(driver):
    assert 3 <= len(driver.hellos(1.3)) <= 5
    spoken = []
    for _ in range(10):
        driver.send(Disarm())
        spoken += driver.hellos(0.2)
    assert spoken == []
    assert driver.hellos(1.0)


def test_what_only_a_board_says_is_no_word_of_a_host(driver):
    driver.run(1.0)
    greetings = []
    for _ in range(10):
        driver.send(Ack(1, Result.OK))
        greetings += driver.hellos(0.2)
    assert len(greetings) >= 6


def test_state_comes_fifty_times_a_second_and_echoes_the_last_sequence(armed):
    armed.send(Setpoint(200, MOVED), 1000)
    armed.run(0.005)
    states = [m for m in armed.run(1.0) if isinstance(m, State)]
    assert len(states) == 50
    assert {state.echo for state in states} == {1000}
    ages = [state.echo_age_us for state in states[:3]]
    assert ages == [ages[0], ages[0] + 20_000, ages[0] + 40_000]
    assert states[-1].echo_age_us == 65535


def test_a_repeated_command_is_answered_again_but_not_done_again(armed):
    armed.send(Stop())
    armed.run(0.1)
    cleared = armed.send(Clear())
    armed.run(0.1)
    assert armed.ask(Clear(), cleared) is Result.OK
    armed.send(Stop())
    armed.run(0.1)
    assert armed.ask(Clear(), cleared) is Result.STALE
    assert armed.state().mode is Mode.STOPPED


def test_a_stop_is_obeyed_when_its_sequence_has_come_round_since_the_last_one(armed):
    stopped = armed.send(Stop())
    armed.run(0.1)
    armed.press_start()
    assert armed.state().mode is Mode.ARMED
    for step in (20_000, 40_000, 60_000):
        armed.send(Setpoint(200, PARK), (stopped + step) & 0xFFFF)
        armed.run(0.02)
    assert armed.ask(Stop(), stopped) is Result.OK
    assert armed.state().mode is Mode.STOPPED


def test_a_late_arm_after_disarm_moves_nothing(driver):
    driver.run(0.4)
    driver.send(Disarm(), 10)
    driver.run(0.1)
    assert driver.ask(Arm(PARK), 9) is Result.STALE
    assert driver.board.pulses == (None,) * 6


def test_a_late_stop_stops(armed):
    assert armed.ask(Stop(), armed.sequence - 1) is Result.OK
    assert armed.state().mode is Mode.STOPPED


@pytest.mark.parametrize('step', [0, -1, -100, 0x8000])
def test_a_setpoint_that_is_not_newer_is_refused(armed, step):
    armed.send(Setpoint(200, MOVED))
    armed.run(0.1)
    armed.send(Setpoint(200, PARK), (armed.sequence + step) & 0xFFFF)
    assert [fault.code for fault in armed.faults()] == [FaultCode.STALE]
    assert armed.counts() == MOVED


def test_sequence_numbers_wrap(armed):
    armed.sequence = 20_000
    armed.send(Setpoint(200, PARK))
    armed.sequence = 45_000
    armed.send(Setpoint(200, PARK))
    armed.sequence = 65_534
    for k in range(4):
        armed.send(Setpoint(200, tuple(count + k for count in PARK)))
        armed.run(0.02)
    assert armed.counts() == tuple(count + 3 for count in PARK)
    assert armed.state().refused == 0


def test_unknown_and_malformed_frames_are_refused_and_counted(armed):
    for code, payload, fault in [
        (0x10, b'', 'UNKNOWN_TYPE'),
        (0x01, b'\1', 'MALFORMED'),
        (0x81, b'\1', 'UNKNOWN_TYPE'),
    ]:
        body = bytes([code, 9, 9]) + payload
        armed.board.feed(cobs.encode(body + checksum(body).to_bytes(2, 'little')) + b'\0')
        assert [f.code.name for f in armed.faults()] == [fault]
    assert armed.state().refused == 3
    assert armed.state().mode is Mode.ARMED


@pytest.mark.parametrize(
    ('code', 'lengths'),
    [
        (0x02, (0, 1, 11, 2 * MAX_JOINTS + 2)),  # ARM: two bytes a joint
        (0x03, (1,)),
        (0x04, (1, 2)),
        (0x05, (1,)),
        (0x06, (10, 12)),
        (0x07, (3, 5)),
        (0x08, (2, 3, 2 * MAX_JOINTS + 4)),
        (0x09, (1, 3)),
        (0x0A, (1, 3)),
        (0x0B, (1,)),
    ],
)
def test_a_command_of_another_length_is_refused_by_name_and_not_answered(armed, code, lengths):
    for count, length in enumerate(lengths, start=1):
        body = bytes([code, 9, 9]) + bytes(length)
        armed.board.feed(cobs.encode(body + checksum(body).to_bytes(2, 'little')) + b'\0')
        heard = armed.run(0.04)
        assert Fault(FaultCode.MALFORMED, NO_JOINT, code) in heard
        assert not [m for m in heard if isinstance(m, Ack)]
        assert armed.state().refused == count
    assert armed.state().mode is Mode.ARMED


@pytest.mark.parametrize(
    ('code', 'message'),
    [
        (0x81, Hello(1, ResetCause.POWER_ON, 6, 1500)),
        (0x82, State(0, 0, Mode.ARMED, Flag(0), FaultCode.NONE, 0, 0, 0, 0, (CENTRE,) * 6)),
        (0x83, Ack(1, Result.OK)),
        (0x84, Fault(FaultCode.STALE, NO_JOINT, 17)),
    ],
)
def test_what_only_a_board_says_is_refused_from_a_host_though_it_is_whole(armed, code, message):
    armed.send(message)
    (fault,) = armed.faults()
    assert fault == Fault(FaultCode.UNKNOWN_TYPE, NO_JOINT, code)
    assert (armed.state().refused, armed.state().bad_frames) == (1, 0)


@pytest.mark.parametrize('body', [b'', b'\3', b'\3\5'])
def test_a_frame_without_a_head_is_damaged_though_its_crc_is_right(armed, body):
    armed.board.feed(cobs.encode(body + checksum(body).to_bytes(2, 'little')) + b'\0')
    assert armed.ask(Disarm()) is Result.OK
    assert (armed.state().refused, armed.state().bad_frames) == (0, 1)


def test_frames_of_a_board_are_counted_up(armed):
    armed.send(Stop())
    wire = b''
    for _ in range(40):
        armed.board.step(0.005)
        wire += armed.board.take_output()
    sequences = [frame.sequence for frame in FrameReader().feed(wire)]
    assert len(sequences) >= 10
    assert set(np.diff(sequences)) == {1}


def test_garbage_moves_nothing_and_the_next_frame_works(armed):
    rng = random.Random(7)
    good = encode(Setpoint(200, MOVED), 1)
    for _ in range(3000):
        mutated = bytearray(good)
        mutated[rng.randrange(len(good))] ^= rng.randrange(1, 256)
        armed.board.feed(bytes(mutated) if rng.random() < 0.5 else rng.randbytes(40))
    armed.board.feed(b'\0')
    state = armed.state()
    assert tuple(joint.count for joint in state.joints) == PARK
    assert state.bad_frames > 1000
    armed.send(Setpoint(200, MOVED))
    armed.run(0.1)
    assert armed.counts() == MOVED


def test_a_flood_of_refusals_does_not_fill_the_line(armed):
    for _ in range(500):
        armed.send(Setpoint(200, (0,) * 6))
    messages = armed.run(0.04)
    states = sum(isinstance(m, State) for m in messages)
    assert sum(isinstance(m, Fault) for m in messages) <= states + 1
    assert armed.state().refused == 500


def test_a_restarted_board_is_silent_disarmed_and_says_why(armed):
    armed.reset(ResetCause.WATCHDOG)
    assert armed.board.pulses == (None,) * 6
    assert armed.run(0.29) == []
    hello, state = armed.run(0.02)
    assert hello.reset_cause is ResetCause.WATCHDOG
    assert (state.mode, state.echo, state.refused) == (Mode.DISARMED, 0, 0)


def test_after_a_restart_any_sequence_is_taken(armed):
    armed.sequence = 40_000
    armed.send(Setpoint(200, PARK))
    armed.reset()
    armed.sequence = 5
    assert armed.arm() is Result.OK


def test_a_board_that_gets_another_program_announces_it(driver):
    driver.run(0.4)
    driver.board.settings = dataclasses.replace(driver.board.settings, version=2)
    assert {hello.version for hello in driver.hellos(0.6)} <= {1}
    driver.reset()
    assert {hello.version for hello in driver.hellos(0.6)} == {2}
