"""The I/O thread on a real pty, with the fake board at the other end."""

import contextlib
import dataclasses
import os
import threading
import time

import pytest

from bridge.events import Connected, Disconnected, StateReceived
from bridge.fake.board_thread import BoardThread, FakeMachine
from bridge.fake.fake_line import FakeLine
from bridge.link import Link, Ticket
from bridge.link_thread import LinkThread, SerialPort
from bridge.protocol import Arm, Clear, Mode, ResetCause, Setpoint, Stop
from bridge.servo_config import BoardConfig
from bridge.session import Session
from hexarm import machines
from manipulator.errors import Refused

ROBOCAKE = BoardConfig.from_machine(machines.read('robocake'))
HASTY = dataclasses.replace(ROBOCAKE.servos, arm_interval_ms=20)
CONFIG = dataclasses.replace(ROBOCAKE, servos=HASTY)
PARK = (3000,) * 6


class Rig:
    """A link thread, the board it talks to, and all that it said."""

    def __init__(self, path):
        self.path = path
        self.events = []
        self.written = []
        self.changed = threading.Condition()
        self.stall = 0.0
        self.machine = FakeMachine.from_config(CONFIG, boot_s=0.1, hysteresis=0.0)
        self.board = BoardThread(self.machine, FakeLine(path), lambda positions: None)
        self.link = Link(Session(6), self._note, lambda ticket, now: self.written.append(ticket))
        self.thread = LinkThread(lambda: SerialPort(str(path), 250_000), self.link)
        self.board.start()
        self.thread.start()

    def _note(self, event, now):
        stall, self.stall = self.stall, 0.0
        time.sleep(stall)
        with self.changed:
            if not isinstance(event, StateReceived):
                self.events.append(event)
            self.changed.notify_all()

    def wait_for(self, condition):
        with self.changed:
            assert self.changed.wait_for(condition, timeout=60.0), self.events

    def wait_for_event(self, kind, count=1):
        self.wait_for(lambda: sum(isinstance(e, kind) for e in self.events) >= count)

    def wait_for_mode(self, mode):
        self.wait_for(lambda: self.is_in(mode))

    def is_in(self, mode):
        state = self.link.session.state
        return state is not None and state.mode is mode

    def counts(self):
        state = self.link.session.state
        return state and tuple(joint.count for joint in state.joints)

    def has_lost(self):
        return any(isinstance(event, Disconnected) for event in self.events)

    def arm(self):
        self.wait_for_event(Connected)
        self.thread.request(Arm(PARK)).result(60.0)
        self.wait_for_mode(Mode.ARMED)

    def put(self, counts):
        ticket = Ticket(Setpoint(200, counts), time.monotonic())
        self.thread.post(lambda: self.link.put_setpoint(ticket))

    def close(self):
        self.thread.close()
        self.board.close()


@pytest.fixture
def rig(tmp_path):
    rig = Rig(tmp_path / 'board')
    yield rig
    rig.close()


@pytest.fixture
def no_board(tmp_path):
    """A link that looks for a port which is not there."""
    events = []
    link = Link(Session(6), lambda event, now: events.append(event))
    thread = LinkThread(lambda: SerialPort(str(tmp_path / 'no'), 250_000), link)
    thread.start()
    yield thread, events
    thread.close()


def test_setpoints_reach_the_servos(rig):
    rig.arm()
    rig.put((3200,) * 6)
    rig.wait_for(lambda: rig.counts() == (3200,) * 6)
    assert [ticket.setpoint.counts for ticket in rig.written] == [(3200,) * 6]
    rig.wait_for_mode(Mode.HOLDING)


def test_stop_is_answered_and_further_stops_too(rig):
    rig.arm()
    futures = [rig.thread.request(Stop()) for _ in range(5)]
    assert [future.result(60.0) for future in futures] == [None] * 5
    rig.wait_for_mode(Mode.STOPPED)
    with pytest.raises(Refused, match='clear the stop first'):
        rig.thread.request(Arm(PARK)).result(60.0)
    rig.thread.request(Clear()).result(60.0)


def test_an_unplugged_board_is_lost_and_found_again_disarmed(rig):
    rig.arm()
    rig.board.do(lambda: rig.board.plug(None))
    rig.wait_for_event(Disconnected)
    assert 'was disconnected' in rig.events[-1].reason
    assert not rig.path.exists()
    with pytest.raises(Refused, match='no board'):
        rig.thread.request(Arm(PARK)).result(60.0)
    line = FakeLine(rig.path)
    rig.board.do(lambda: rig.board.plug(line))
    rig.wait_for_event(Connected, 2)
    assert rig.link.session.state.mode is Mode.DISARMED
    assert rig.machine.board.pulses == (None,) * 6


def test_a_board_that_is_closed_leaves_no_port_behind(rig):
    rig.board.close()
    assert not rig.path.is_symlink()


class Watched:
    """A machine, and how long each of its steps was, in s."""

    def __init__(self, machine):
        self.board, self.servos, self._step = machine.board, machine.servos, machine.step
        self.steps = []

    def step(self, dt, stuck_channel=None):
        self.steps.append(dt)
        self._step(dt, stuck_channel)


def test_a_board_whose_computer_stands_still_lets_no_time_pass_meanwhile(tmp_path):
    machine = Watched(FakeMachine.from_config(CONFIG, boot_s=0.1, hysteresis=0.0))
    board = BoardThread(machine, FakeLine(tmp_path / 'board'), lambda positions: None)
    board.start()
    went_on = threading.Event()
    board.do(lambda: time.sleep(0.2))
    board.do(lambda: board.do(went_on.set))
    assert went_on.wait(60.0)
    board.close()
    assert max(machine.steps) <= 0.05


def test_a_reset_in_motion_ends_disarmed(rig):
    rig.arm()
    rig.put((3200,) * 6)
    rig.board.do(lambda: rig.machine.board.reset(ResetCause.WATCHDOG))
    rig.wait_for_event(Connected, 2)
    rig.put((3200,) * 6)
    assert rig.link.session.state.mode is Mode.DISARMED


def test_a_mute_board_is_lost_though_the_port_is_open(rig):
    rig.arm()
    rig.board.is_mute = True
    rig.wait_for_event(Disconnected)
    assert 'no frame' in rig.events[-1].reason
    rig.board.is_mute = False
    rig.wait_for_event(Connected, 2)


def is_kept_through_a_stall(rig):
    rig.arm()
    rig.put((3100,) * 6)
    rig.wait_for(lambda: rig.counts() == (3100,) * 6 or rig.has_lost())
    rig.stall = 0.7
    rig.wait_for(lambda: rig.is_in(Mode.HOLDING) or rig.has_lost())
    time.sleep(0.1)
    return rig.stall == 0.0 and not rig.has_lost()


def test_a_board_is_not_lost_because_this_thread_was_held_up(tmp_path):
    """A board that is held up itself, with its computer, is lost rightly: again, with another."""
    for attempt in range(5):
        with contextlib.closing(Rig(tmp_path / f'board{attempt}')) as rig:
            if is_kept_through_a_stall(rig):
                return
    pytest.fail('lost each time')


def test_a_missing_port_is_reported_and_looked_for(no_board):
    thread, events = no_board
    with pytest.raises(Refused, match='no board is connected: no port'):
        thread.request(Stop()).result(60.0)
    deadline = time.monotonic() + 60.0
    while len(events) < 3 and time.monotonic() < deadline:
        time.sleep(0.01)
    assert 'does not exist' in events[2].reason


def test_a_device_that_sends_noise_without_end_stalls_nothing(tmp_path):
    line = FakeLine(tmp_path / 'noise')
    is_over = threading.Event()
    noise = b'\0'.join(os.urandom(7) for _ in range(500))

    def shout():
        while not is_over.is_set():
            line.write(noise)

    shouter = threading.Thread(target=shout)
    link = Link(Session(6), lambda event, now: None)
    thread = LinkThread(lambda: SerialPort(str(line.path), 250_000), link)
    shouter.start()
    thread.start()
    try:
        deadline = time.monotonic() + 60.0
        while link.session.reader.bad_frames < 1000 and time.monotonic() < deadline:
            time.sleep(0.01)
        with pytest.raises(Refused, match='waiting for HELLO'):
            thread.request(Stop()).result(60.0)
        assert link.session.reader.bad_frames >= 1000
    finally:
        is_over.set()
        shouter.join()
        thread.close()
        line.close()
