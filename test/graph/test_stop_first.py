"""A STOP waits for nothing: not for a program that is being sent over a bad line, nor a table."""

import random
import time

import pytest
from std_msgs.msg import Bool, String
from std_srvs.srv import SetBool
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from bridge.calibration import Calibration
from bridge.fake.board_thread import BoardThread, FakeMachine
from bridge.protocol import CycleAxis, Play, Stop, TableRow
from bridge.servo_config import BoardConfig
from hexarm import machines
from hexarm.board.kinematics import crank_hexapod
from hexarm.graph import Executable, Graph
from manipulator.errors import TimedOut
from manipulator.nodes.qos import EVERY_WORD, LATCHED
from patient_user import WITHOUT_BOARD, PatientBridgeUser
from tapped_line import Tap, TappedLine

pytestmark = pytest.mark.graph

SPACE = 'stop_first'
NAMES = [f'crank_{i}' for i in range(1, 7)]


class BadLine(TappedLine):
    """Of what the host says while `is_bad`, the board does not hear a share."""

    is_bad, loss = False, 0.5

    def read(self):
        received = super().read()
        is_lost = BadLine.is_bad and random.random() < BadLine.loss
        return b'' if is_lost else received


class User(PatientBridgeUser):
    """Publishes stops, and calls services without waiting for their answers."""

    def __init__(self):
        super().__init__(SPACE)
        self.said = []
        self.stops = self.node.create_publisher(Bool, 'emergency_stop', EVERY_WORD)
        self.tables = self.node.create_publisher(JointTrajectory, 'joint_table', 1)
        self.node.create_subscription(String, 'program_status', self._hear, LATCHED)
        self.plays = self.node.create_client(SetBool, 'serial_bridge/play_cycle')
        self.wait('the bridge', self._is_heard)
        self.wait_for_state('disarmed')

    def _is_heard(self):
        publishers = (self.stops, self.tables)
        has_subscribers = all(publisher.get_subscription_count() == 1 for publisher in publishers)
        return has_subscribers and self.plays.service_is_ready()

    def _hear(self, message):
        self.said.append(message.data)

    def _make_ready(self):
        """A board that hears everything and is not stopped."""
        BadLine.is_bad, BadLine.loss = False, 0.5
        self.wait('a board', lambda: self.machine_state.message not in WITHOUT_BOARD)
        self.trigger('serial_bridge/clear_fault')
        self.wait_for_state('disarmed')

    def play_cycle(self):
        return self.plays.call_async(SetBool.Request(data=True))


@pytest.fixture(scope='module')
def tap():
    return Tap()


@pytest.fixture(scope='module')
def user(tap, tmp_path_factory):
    path = tmp_path_factory.mktemp('line') / 'board'
    config = BoardConfig.from_machine(machines.read('robocake'))
    hexapod = crank_hexapod(machines.load('robocake'), Calibration.from_config(config.servos))
    machine = FakeMachine.from_config(config, boot_s=0.1, hysteresis=0.0, hexapod=hexapod)
    board = BoardThread(machine, BadLine(path, tap), lambda positions: None)
    board.start()
    parameters = {'machine': 'robocake', 'port': str(path)}
    try:
        with Graph([Executable('serial_bridge', parameters)], SPACE), User() as user:
            yield user
    finally:
        board.close()


@pytest.fixture
def calm(user):
    user.make_ready()
    yield user
    BadLine.is_bad = False


def test_a_stop_does_not_wait_for_a_program_on_a_dead_line(calm, tap):
    """Nothing of the program gets through: it would keep the line for a second and more."""

    def stop():
        BadLine.loss = 1.0
        BadLine.is_bad = True
        began = time.monotonic()
        answer = calm.play_cycle()
        calm.wait('the cycle', lambda: tap.frames(CycleAxis, began))
        calm.stops.publish(Bool(data=True))
        calm.wait('STOP', lambda: tap.frames(Stop, began))
        BadLine.is_bad = False
        sent = [type(message) for _, message in tap.frames((CycleAxis, Play, Stop), began)]
        assert {*sent[sent.index(Stop) :]} == {Stop}
        calm.wait('an answer', answer.done)
        assert not answer.result().success
        calm.wait_for_state('stopped')

    calm.persist(stop)


def test_what_a_stop_interrupted_is_not_taken_up_again(calm, tap):
    def stop():
        BadLine.is_bad = True
        answer = calm.play_cycle()
        calm.stops.publish(Bool(data=True))
        calm.wait('an answer', answer.done)
        BadLine.is_bad = False
        calm.wait_for_state('stopped')
        stopped = time.monotonic()
        calm.trigger('serial_bridge/clear_fault')
        calm.spin(0.5)
        assert not tap.frames((CycleAxis, Play), stopped)

    calm.persist(stop)


def test_a_false_right_behind_does_not_take_its_place(calm):
    calm.stops.publish(Bool(data=True))
    for _ in range(20):
        calm.stops.publish(Bool(data=False))
    calm.wait_for_state('stopped')


def test_a_program_does_not_spoil_an_upload(calm, tap):
    rows = [JointTrajectoryPoint(positions=[2.1] * 6) for _ in range(100)]
    for k, row in enumerate(rows):
        row.time_from_start.nanosec = k % 10 * 100_000_000
        row.time_from_start.sec = k // 10

    def upload():
        calm.said.clear()
        began = time.monotonic()
        calm.tables.publish(JointTrajectory(joint_names=NAMES, points=rows))
        calm.wait('rows', lambda: tap.frames(TableRow, began))
        answer = calm.play_cycle()
        calm.wait('an answer', answer.done)
        if calm.said:
            raise TimedOut(f'the upload was over by then: {calm.said}')
        assert answer.result().message == 'another upload is in progress'
        calm.wait(
            'the upload', lambda: 'table of 100 rows, 100 ms apart, is on board' in calm.said
        )

    calm.persist(upload)


def test_a_table_beyond_what_a_board_holds_is_not_even_decoded(calm):
    rows = [JointTrajectoryPoint(positions=[2.1] * 6)] * 2_000
    calm.tables.publish(JointTrajectory(joint_names=NAMES, points=rows))
    calm.wait('a refusal', lambda: any('at most 100000' in text for text in calm.said))


def test_bytes_that_are_no_table_are_refused(calm):
    calm.tables.publish(b'\0\1\0\0\xff')
    calm.wait('a refusal', lambda: any('no JointTrajectory' in text for text in calm.said))
