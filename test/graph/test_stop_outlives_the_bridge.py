"""A STOP that no board has heard is said by the next bridge; `hexarm up` waits for the clear."""

import signal

import pytest
from std_msgs.msg import Bool

from bridge.board_thread import BoardThread, FakeMachine
from bridge.fake_line import FakeLine
from bridge.messages import Mode
from bridge.servo_config import BoardConfig
from hexarm import machines
from hexarm.graph import Executable, Graph
from manipulator.nodes.qos import EVERY_WORD
from patient_user import PatientUser

pytestmark = pytest.mark.graph

SPACE = 'outlives'


@pytest.fixture
def board(tmp_path):
    config = BoardConfig.from_machine(machines.read('robocake'))
    machine = FakeMachine.from_config(config, boot_s=0.1, hysteresis=0.0)
    thread = BoardThread(machine, FakeLine(tmp_path / 'board'), lambda positions: None)
    thread.machine = machine.board
    thread.start()
    yield thread
    thread.close()


def bridge(tmp_path):
    parameters = {'machine': 'robocake', 'port': str(tmp_path / 'board')}
    return Graph([Executable('bridge', 'serial_bridge', parameters)], SPACE)


def wait_for_state(user, word):
    user.wait(word, lambda: user.machine_state.message == word)


def test_a_stop_that_no_board_heard_is_said_by_the_next_bridge(board, tmp_path):
    with PatientUser(SPACE) as user:
        stops = user.node.create_publisher(Bool, 'emergency_stop', EVERY_WORD)
        with bridge(tmp_path):
            wait_for_state(user, 'disarmed')
            board.do(lambda: board.plug(None))
            wait_for_state(user, 'disconnected')
            user.wait('the bridge', lambda: stops.get_subscription_count() == 1)
            stops.publish(Bool(data=True))
            user.wait('the memory', (tmp_path / 'board.stop').exists)
        line = FakeLine(tmp_path / 'board')
        board.do(lambda: board.plug(line))
        with bridge(tmp_path):
            wait_for_state(user, 'stopped')
            assert board.machine.mode is Mode.STOPPED
            user.trigger('serial_bridge/clear_fault')
            wait_for_state(user, 'disarmed')
            assert not (tmp_path / 'board.stop').exists()


def test_up_waits_until_a_stop_from_before_is_cleared(hexarm, tmp_path):
    port = tmp_path / 'board'
    (tmp_path / 'board.stop').touch()
    fake = {'machine': 'robocake', 'link': str(port)}
    with Graph([Executable('bridge', 'fake_hardware', fake)], SPACE):
        process = hexarm('up', 'hexapod', '--port', str(port), '--namespace', SPACE)
        assert any('clear_fault std_srvs' in line for line in process.stdout)
        with PatientUser(SPACE) as user:
            user.trigger('serial_bridge/clear_fault')
        assert any('and enabled' in line for line in process.stdout)
        process.send_signal(signal.SIGINT)
        assert 'park' in process.stdout.read()
        assert process.wait(60) == 0
