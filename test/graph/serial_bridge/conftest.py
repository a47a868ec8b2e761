"""serial_bridge and fake_hardware as processes, driven over topics and services."""

import time

import pytest
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool
from std_srvs.srv import SetBool

from hexarm.client import Client
from hexarm.graph import Executable, Graph
from hexarm.machines import find
from manipulator.nodes.qos import COMMAND, MEASUREMENT

NAMES = [f'crank_{i}' for i in range(1, 7)]
SPACE = 'bridge_rig'


class Rig(Client):
    """A user of the bridge's own topics and services."""

    def __init__(self):
        super().__init__(SPACE)
        self.joints = []
        self.true_joints = []
        subscribe = self.node.create_subscription
        subscribe(JointState, 'joint_states', self.joints.append, MEASUREMENT)
        subscribe(JointState, 'true_joint_states', self.true_joints.append, MEASUREMENT)
        self._commands = self.node.create_publisher(JointState, 'joint_command', COMMAND)
        self._stops = self.node.create_publisher(Bool, 'emergency_stop', COMMAND)
        self.wait('the bridge', self._is_heard, 10.0)
        self.wait('the board', lambda: len(self.true_joints) > 0, 10.0)

    def _is_heard(self):
        publishers = (self._commands, self._stops)
        return all(publisher.get_subscription_count() == 1 for publisher in publishers)

    def switch(self, service, is_true=True):
        return self._call(SetBool, service, SetBool.Request(data=is_true))

    def wait_for_state(self, word, seconds=10.0):
        self.wait(word, lambda: self.machine_state.message == word, seconds)

    def enable(self):
        self.switch('serial_bridge/enable')
        self.wait_for_state('enabled')

    def go_back_to_disarmed(self):
        """Whatever the last test left."""
        away = ('not heard of', 'disconnected', 'booting')
        self.wait('the board', lambda: self.machine_state.message not in away, 10.0)
        self.trigger('serial_bridge/clear_fault')
        self.switch('serial_bridge/enable', False)
        self.wait_for_state('disarmed')

    def stop(self, is_stop=True):
        self._stops.publish(Bool(data=is_stop))

    def command(self, positions, names=NAMES, clock=0.0, step=0.0):
        """Publishes one command; `clock` is how far the sender's clock is ahead."""
        message = JointState(name=list(names), position=[float(p) for p in positions])
        now = time.time() + clock
        message.header.stamp.sec, message.header.stamp.nanosec = int(now), int(now % 1 * 1e9)
        self._commands.publish(message)

    def stream(self, angle, seconds=0.5):
        """Commands all joints to `angle`, at 50 Hz, from where they are."""
        start = self.joints[-1].position[0]
        ticks = round(seconds / 0.02)
        for k in range(1, ticks + 1):
            self.command([start + (angle - start) * min(2 * k / ticks, 1.0)] * 6)
            self.spin(0.02)

    def true_angle(self):
        self.true_joints.clear()
        self.wait('true joints', lambda: len(self.true_joints) > 2, 5.0)
        return self.true_joints[-1].position[0]

    def report(self):
        """The bridge's next diagnostics, by key."""
        self.diagnostics.clear()
        name = f'{SPACE}/serial_bridge'
        self.wait('diagnostics', lambda: name in self.diagnostics, 5.0)
        status = self.diagnostics[name]
        return {value.key: value.value for value in status.values} | {'message': status.message}

    def refuses(self, said, **command):
        """Waits until the bridge says so of a command that it must not follow."""
        self.command(**command)
        self.wait(said, lambda: said in self.report()['last_refusal'], 5.0)

    def set_battery(self, volts):
        value = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=volts)
        request = SetParameters.Request(parameters=[Parameter(name='battery_v', value=value)])
        client = self.node.create_client(SetParameters, 'fake_hardware/set_parameters')
        self.wait('parameters', client.service_is_ready, 10.0)
        assert self.answer_of(client, request, 'the battery').results[0].successful


@pytest.fixture(scope='module')
def port(tmp_path_factory):
    return tmp_path_factory.mktemp('line') / 'board'


@pytest.fixture(scope='module')
def processes(port, tmp_path_factory):
    hasty = find('robocake').read_text().replace('arm_interval_ms: 150', 'arm_interval_ms: 40')
    machine = tmp_path_factory.mktemp('machine') / 'hasty.yaml'
    machine.write_text(hasty)
    nodes = [
        Executable('bridge', 'fake_hardware', {'link': str(port), 'machine': str(machine)}),
        Executable('bridge', 'serial_bridge', {'port': str(port), 'machine': str(machine)}),
    ]
    with Graph(nodes, SPACE) as graph:
        yield graph
        assert graph.dead() is None


@pytest.fixture(scope='module')
def client(processes):
    with Rig() as rig:
        yield rig


@pytest.fixture
def rig(client):
    """The board connected, disarmed."""
    client.go_back_to_disarmed()
    return client


@pytest.fixture
def enabled(rig):
    """The servos on, at park."""
    rig.enable()
    return rig
