"""Programs over topics and services: uploaded, played by the board alone, ended smoothly."""

import math

import pytest
from builtin_interfaces.msg import Duration
from std_msgs.msg import String
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from hexarm.graph import Executable, Graph, board_process
from manipulator.errors import Refused
from manipulator.nodes.qos import COMMAND, LATCHED
from patient_user import PatientBridgeUser

pytestmark = pytest.mark.graph

NAMES = [f'crank_{i}' for i in (2, 1, 3, 4, 5, 6)]
SPACE = 'programs_rig'


class Rig(PatientBridgeUser):
    """A user of the bridge alone."""

    def __init__(self):
        super().__init__(SPACE)
        self.said = []
        self._tables = self.node.create_publisher(JointTrajectory, 'joint_table', COMMAND)
        self.node.create_subscription(String, 'program_status', self._hear, LATCHED)
        self.wait('the bridge', lambda: self._tables.get_subscription_count() == 1)

    def _hear(self, message):
        self.said.append(message.data)

    def upload(self, table, words):
        self.said.clear()
        self._tables.publish(table)
        self.wait(words, lambda: any(words in text for text in self.said))


def swing(rows=20, step_ms=100):
    points = []
    for k in range(rows):
        angle = math.radians(120 + 4 * math.sin(2 * math.pi * k / rows))
        span = Duration(sec=k * step_ms // 1000, nanosec=k * step_ms % 1000 * 1_000_000)
        points.append(JointTrajectoryPoint(positions=[angle] * 6, time_from_start=span))
    return JointTrajectory(joint_names=NAMES, points=points)


@pytest.fixture(scope='module', params=['fake', 'chip'])
def rig(request, tmp_path_factory):
    link = tmp_path_factory.mktemp('port') / 'board'
    board = Executable('fake_hardware', {'machine': 'robocake', 'link': str(link)})
    if request.param == 'chip':
        request.getfixturevalue('chip_tools')
        (board,) = board_process('robocake', 'simavr', link)
    parameters = {'machine': 'robocake', 'port': str(link), 'board_cycle.amplitude': AMPLITUDE}
    parameters['board_cycle.frequency'] = '[1.0,1.0,1.0,1.0,1.0,1.0]'
    bridge = Executable('serial_bridge', parameters, needs=link)
    with Graph([board, bridge], SPACE), Rig() as rig:
        rig.wait_for_state('disarmed')
        yield rig


AMPLITUDE = '[0.0,0.0,0.002,0.0,0.0,0.03]'


@pytest.fixture
def enabled(rig):
    rig.make_ready()
    return rig


def test_a_table_and_a_cycle_are_played_and_end_enabled(enabled):
    def go():
        enabled.upload(swing(), 'table of 20 rows, 100 ms apart, is on board')
        enabled.switch('serial_bridge/play_table', True)
        enabled.wait_for_state('playing')
        enabled.trigger('serial_bridge/finish_program')
        enabled.wait_for_state('enabled')
        enabled.switch('serial_bridge/play_cycle', False)
        enabled.wait_for_state('playing')
        enabled.wait_for_state('enabled')

    enabled.persist(go)


def test_refusals_report_why(enabled):
    def go():
        enabled.upload(swing(rows=600), 'the table has more rows than the board can hold')
        enabled.upload(JointTrajectory(joint_names=['elbow']), 'joints are elbow, needs')
        with pytest.raises(Refused, match='no such program'):
            enabled.switch('serial_bridge/play_table', True)
        enabled.switch('serial_bridge/enable', False)
        enabled.wait_for_state('disarmed')
        enabled.upload(swing(), 'is on board')
        with pytest.raises(Refused, match='servos are off'):
            enabled.switch('serial_bridge/play_table', True)

    enabled.persist(go)
