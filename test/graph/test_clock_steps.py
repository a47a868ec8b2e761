"""The system's clock is set by an hour while the platform moves: it goes on moving."""

import os
import shutil
import struct
import subprocess
from pathlib import Path

import pytest
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import JointState

from hexarm.graph import Graph, check_alive, machine_graph
from manipulator.nodes.qos import COMMAND, MEASUREMENT
from patient_user import PatientUser

pytestmark = pytest.mark.graph

SPACE = 'clock_steps'
HOUR = 3600
CYCLING = ('cycle', 'moving')


class User(PatientUser):
    """Counts setpoints, keeps every word that the bridge says; its own clock is never set."""

    def __init__(self, interrupt):
        super().__init__(SPACE, interrupt)
        self.words, self.setpoints, self.heights = [], 0, []
        self.node.create_subscription(PoseStamped, 'setpoint', self._count, COMMAND)
        self.node.create_subscription(JointState, 'true_joint_states', self._see, MEASUREMENT)

    def _count(self, message):
        self.setpoints += 1

    def _see(self, message):
        self.heights.append(message.position[0])

    def _on_machine_state(self, message):
        super()._on_machine_state(message)
        self.words.append(message.message)


class Clock:
    """Sets the clock of all processes that were started with it, ahead of the real one.

    Never behind it: waits that end at a time of the system's clock would end at once, for ever.
    """

    def __init__(self, file):
        self._file = file
        self.set(0)

    def set(self, seconds):
        with self._file.open('r+b' if self._file.exists() else 'wb') as file:
            file.write(struct.pack('=q', seconds))


@pytest.fixture
def clock(tmp_path, monkeypatch):
    compiler = shutil.which('cc')
    if compiler is None and os.environ.get('REQUIRE_ALL') != '1':
        pytest.skip('not installed: cc')
    library = tmp_path / 'clock_step.so'
    source = Path(__file__).with_name('clock_step.c')
    subprocess.run([compiler, '-shared', '-fPIC', '-O', '-o', library, source, '-ldl'], check=True)
    clock = Clock(tmp_path / 'step')
    monkeypatch.setenv('CLOCK_STEP', str(tmp_path / 'step'))
    monkeypatch.setenv('LD_PRELOAD', str(library))
    return clock


@pytest.fixture
def user(clock, patient_robocake, tmp_path, monkeypatch):
    nodes = machine_graph(patient_robocake, 'fake', tmp_path / 'board')
    with Graph(nodes, SPACE) as graph:
        monkeypatch.delenv('LD_PRELOAD')
        with User(lambda: check_alive(graph)) as user:
            yield user


def goes_on(user, clock, step):
    """The platform swings, the clock is set, and nothing but its reading has changed."""
    if user.motion('mode') != 'cycle':
        user.trigger('trajectory/start_cycle')
    user.wait('the cycle', lambda: (user.motion('mode'), user.motion('result')) == CYCLING)
    user.words.clear()
    clock.set(step)
    user.spin(0.5)
    user.setpoints, user.heights = 0, []
    user.wait('setpoints', lambda: user.setpoints > 50)
    assert max(user.heights) - min(user.heights) > 1e-3
    assert set(user.words) <= {'enabled'}
    assert user.motion('mode') == 'cycle'


def test_the_clock_is_set_and_the_platform_goes_on(user, clock):
    """As in test/world, on the nodes' own clocks; again where this computer stood still."""
    user.make_ready()
    for step in (HOUR, 0):
        user.persist(lambda step=step: goes_on(user, clock, step))
