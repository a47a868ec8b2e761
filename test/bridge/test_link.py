"""What a link writes, in which order, and whom it tells: in simulated time, with a fake board."""

from dataclasses import dataclass, field

import pytest

from bridge.events import Acknowledged, Connected, Disconnected, StateReceived
from bridge.fake.board import Board
from bridge.fake.board_settings import BoardSettings
from bridge.framing import FrameReader
from bridge.link import LOOK_AGAIN_AFTER, SPACING, TICK, Link, Ticket
from bridge.protocol import Arm, Clear, Disarm, Mode, ResetCause, Setpoint, Stop
from bridge.session import Session
from manipulator.errors import Refused

PARK = (3000,) * 6
SETTINGS = BoardSettings(
    ((1100, 4900),) * 6, (12_600.0,) * 6, boot_us=100_000, arm_interval_us=20_000
)
STEP = 0.005


@dataclass
class Rig:
    """A link and its board; `log` is all that was written and told, in order."""

    board: Board = field(default_factory=lambda: Board(SETTINGS))
    now: float = 100.0
    log: list = field(default_factory=list)
    room: int = 10_000

    def __post_init__(self):
        self._reader = FrameReader()
        self.link = Link(Session(6), self._note, lambda ticket, now: self.log.append(ticket))
        self.link.opened(self.now)

    def _note(self, event, now):
        self.log.append(event)

    def pass_time(self, seconds):
        """The board goes on, and no machine subscribes."""
        for _ in range(round(seconds / STEP)):
            self.now += STEP
            self.board.step(STEP)

    def turn(self):
        """As the thread does, on a port that takes `room` bytes a turn."""
        output = self.link.turn(self.board.take_output(), self.now)
        written, rest = output[: self.room], output[self.room :]
        self.log += [frame.message for frame in self._reader.feed(written)]
        self.board.feed(written)
        self.link.written(rest, self.now)

    def run(self, seconds):
        for _ in range(round(seconds / STEP)):
            self.pass_time(STEP)
            self.turn()

    def arm(self):
        self.run(0.3)
        asked = self.link.request(Arm(PARK))
        self.run(0.5)
        assert asked.done()
        self.log.clear()

    def put(self, count, age=0.0):
        self.link.put_setpoint(Ticket(Setpoint(200, (count,) * 6), self.now - age))

    def logged(self, *kinds):
        return [entry for entry in self.log if isinstance(entry, kinds)]

    @property
    def counts(self):
        """Of the setpoints that were written."""
        return [message.counts[0] for message in self.logged(Setpoint)]

    @property
    def modes(self):
        return [event.state.mode for event in self.logged(StateReceived)]


@pytest.fixture
def rig():
    rig = Rig()
    rig.arm()
    return rig


def test_the_newest_setpoint_is_written_and_its_ticket_reported(rig):
    for count in range(3000, 3100):
        rig.put(count)
    rig.turn()
    assert rig.counts == [3099]
    assert [ticket.setpoint.counts[0] for ticket in rig.logged(Ticket)] == [3099]


def test_setpoints_are_spaced_and_the_last_one_is_written(rig):
    rig.put(3001)
    rig.turn()
    rig.put(3002)
    assert 0.0 < rig.link.due_in(rig.now) <= SPACING
    rig.turn()
    assert rig.counts == [3001]
    rig.now += SPACING
    assert rig.link.due_in(rig.now) == 0.0
    rig.turn()
    assert rig.counts == [3001, 3002]


@pytest.mark.parametrize(('age', 'written'), [(0.199, [3300]), (0.201, [])])
def test_a_setpoint_that_waited_for_longer_than_its_deadline_is_forgotten(rig, age, written):
    rig.put(3300, age)
    rig.turn()
    assert rig.counts == written
    rig.run(0.1)
    assert rig.counts == written


def test_a_setpoint_while_disarmed_is_not_kept_for_later():
    rig = Rig()
    rig.run(0.3)
    rig.put(3300)
    rig.arm()
    rig.run(0.2)
    assert rig.counts == []


def test_a_stop_goes_before_the_setpoint_that_waits_and_lets_none_follow(rig):
    rig.put(3300)
    rig.link.request(Stop())
    rig.turn()
    rig.put(3301)
    rig.run(0.1)
    assert rig.logged(Setpoint, Stop) == [Stop()]


def test_a_setpoint_waits_while_the_port_has_not_taken_the_last_one(rig):
    rig.put(3001)
    rig.room = 3
    rig.turn()
    assert rig.link.is_behind
    rig.put(3002)
    rig.now += SPACING
    rig.room = 0
    rig.turn()
    rig.put(3003)
    rig.room = 10_000
    rig.turn()
    assert rig.counts == [3001]
    rig.turn()
    assert rig.counts == [3001, 3003]


@pytest.mark.parametrize('command', [Stop(), Arm(PARK), Clear(), Disarm()])
def test_a_frame_is_written_first_then_the_answer_reported_then_the_future_done(rig, command):
    asked = rig.link.request(command)
    asked.add_done_callback(lambda done: rig.log.append('answered'))
    rig.run(0.1)
    order = [e for e in rig.log if e == command or isinstance(e, Acknowledged) or e == 'answered']
    assert order == [command, Acknowledged(command), 'answered']


def test_of_the_same_command_asked_twice_at_once_the_later_one_is_obeyed(rig):
    first, second = rig.link.request(Arm(PARK)), rig.link.request(Arm(PARK))
    rig.turn()
    assert 'came after it' in str(first.exception(0.0))
    assert not second.done()
    rig.run(0.1)
    assert second.result(0.0) is None


def test_further_stops_are_answered_with_the_first(rig):
    asked = [rig.link.request(Stop()) for _ in range(5)]
    rig.run(0.1)
    assert [future.result(0.0) for future in asked] == [None] * 5
    assert len(rig.logged(Stop)) == 1


def test_a_request_that_was_withdrawn_is_not_sent(rig):
    rig.link.request(Disarm()).cancel()
    rig.run(0.1)
    assert rig.logged(Disarm) == []


def test_what_piled_up_while_nobody_listened_is_reported_as_its_last(rig):
    rig.put(3100)
    rig.turn()
    rig.log.clear()
    rig.pass_time(0.7)
    rig.turn()
    assert rig.modes == [Mode.ARMED, Mode.HOLDING]
    assert rig.logged(StateReceived)[-1].state.joints[0].count == 3100


def test_a_board_is_not_silent_because_nobody_listened(rig):
    rig.pass_time(0.7)
    rig.link.turn(b'', rig.now)  # held up after it had found nothing to read
    rig.link.written(b'', rig.now)
    rig.turn()
    assert rig.logged(Disconnected) == []


def test_a_board_that_is_silent_is_lost(rig):
    for _ in range(12):
        rig.now += TICK
        rig.turn()
    assert 'no frame from the board for 0.5 s' in rig.logged(Disconnected)[0].reason


def test_at_first_the_port_is_to_be_opened_and_nothing_is_read():
    link = Link(Session(6), lambda event, now: None)
    assert link.wants_port(0.0)
    assert not link.is_listening(0.0)
    assert link.turn(b'', 0.0) == b''


def test_a_lost_port_is_looked_for_again_and_its_board_comes_back_disarmed(rig):
    rig.put(3200)
    asked = rig.link.request(Disarm())
    rig.link.turn(b'', rig.now)
    rig.link.lost('the port was disconnected', rig.now)
    assert str(asked.exception(0.0)) == 'the port was disconnected'
    assert rig.logged(Ticket, Disconnected) == [Disconnected('the port was disconnected')]
    assert not rig.link.wants_port(rig.now)
    assert rig.link.due_in(rig.now) == LOOK_AGAIN_AFTER
    rig.now += LOOK_AGAIN_AFTER
    assert rig.link.wants_port(rig.now)
    rig.board.reset(ResetCause.EXTERNAL)
    rig.link.opened(rig.now)
    rig.run(0.3)
    assert len(rig.logged(Connected)) == 1
    assert rig.modes[-1] is Mode.DISARMED
    assert rig.board.pulses == (None,) * 6


def test_without_a_port_requests_are_refused_and_a_stop_is_sent_as_soon_as_there_is_one(rig):
    rig.link.lost('the port was disconnected', rig.now)
    asked = rig.link.request(Stop())
    rig.run(0.1)
    with pytest.raises(Refused, match='no board is connected: no port'):
        asked.result(0.0)
    assert rig.logged(Stop) == []
    rig.link.opened(rig.now)
    rig.run(1.5)
    assert rig.board.mode is Mode.STOPPED


def test_no_more_is_read_than_a_line_carries():
    link = Link(Session(6), lambda event, now: None, bytes_per_second=1000.0)
    link.opened(0.0)
    assert link.is_listening(0.0)
    link.turn(bytes(100), 0.0)
    assert not link.is_listening(0.099)
    assert link.is_listening(0.1)
    assert link.due_in(0.0) == TICK
    assert link.due_in(0.08) == pytest.approx(0.02)


@pytest.mark.parametrize('seconds', [0.6, 2.0, 10.0])
def test_hellos_that_piled_up_while_nobody_listened_are_no_restart(seconds):
    rig = Rig()
    rig.run(3.0)
    rig.pass_time(seconds)
    rig.run(3.0)
    assert len(rig.logged(Connected)) == 1
    assert rig.logged(Disconnected) == []


@pytest.mark.parametrize('seconds', [0.6, 2.0, 10.0])
def test_a_restart_while_nobody_listened_is_noticed(seconds):
    rig = Rig()
    rig.run(1.5)
    rig.pass_time(seconds / 2)
    rig.board.reset(ResetCause.WATCHDOG)
    rig.pass_time(seconds / 2)
    rig.run(1.0)
    assert 'has restarted' in rig.logged(Disconnected)[0].reason
    assert len(rig.logged(Connected)) == 2
