"""serial_bridge and fake_hardware as processes, driven over topics and services."""

import re
import time

import pytest
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool

from hexarm.graph import Executable, Graph
from hexarm.machines import find
from manipulator.nodes.qos import COMMAND, EVERY_WORD, MEASUREMENT
from patient_user import TRIES, WITHOUT_BOARD, PatientBridgeUser

NAMES = [f'crank_{i}' for i in range(1, 7)]
SPACE = 'bridge_rig'


class Rig(PatientBridgeUser):
    """A user of the bridge's own topics and services."""

    def __init__(self):
        super().__init__(SPACE)
        self.joints = []
        self.true_joints = []
        subscribe = self.node.create_subscription
        subscribe(JointState, 'joint_states', self.joints.append, MEASUREMENT)
        subscribe(JointState, 'true_joint_states', self.true_joints.append, MEASUREMENT)
        self._commands = self.node.create_publisher(JointState, 'joint_command', COMMAND)
        self._stops = self.node.create_publisher(Bool, 'emergency_stop', EVERY_WORD)
        self.wait('the bridge', self._is_heard, 10.0)
        self.wait('the board', lambda: len(self.true_joints) > 0, 10.0)

    def _is_heard(self):
        publishers = (self._commands, self._stops)
        return all(publisher.get_subscription_count() == 1 for publisher in publishers)

    def go_back_to_disarmed(self):
        """Whatever the last test left."""
        self.persist(self._switch_off)

    def _switch_off(self):
        self.wait('the board', lambda: self.machine_state.message not in WITHOUT_BOARD)
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

    def stream(self, angle):
        """Commands all joints to `angle`, at 50 Hz, from where they are, until they are there.

        From where they are once more, where this computer stood still: the board holds, or the
        next command was too far from the last one.
        """
        for _ in range(TRIES):
            if self.machine_state.message in (*WITHOUT_BOARD, 'unclaimed'):
                self.make_ready()
            self.persist(lambda: self._stream(angle))
            if abs(self.true_angle() - angle) < 0.02:
                return
        raise AssertionError(f'{self.true_angle():.3f} rad, not {angle:.3f}: {self.summary}')

    def _stream(self, angle):
        self.joints.clear()
        self.wait('the joints', lambda: self.joints)
        start = self.joints[-1].position[0]
        for k in range(1, 26):
            self.command([start + (angle - start) * min(k / 12, 1.0)] * 6)
            self.spin(0.02)

    def true_angle(self):
        self.true_joints.clear()
        self.wait('true joints', lambda: len(self.true_joints) > 2)
        return self.true_joints[-1].position[0]

    def publish_command(self, serialized):
        self._commands.publish(serialized)

    def report(self):
        """The bridge's next diagnostics, by key."""
        self.diagnostics.clear()
        name = f'{SPACE}/serial_bridge'
        self.wait('diagnostics', lambda: name in self.diagnostics)
        status = self.diagnostics[name]
        return {value.key: value.value for value in status.values} | {'message': status.message}

    def refuses(self, text, **command):
        """Asks for what the bridge must not follow until it says why not."""

        def is_refused():
            self.command(**command)
            return text in self.report()['last_refusal']

        self.wait(text, is_refused)

    def set_battery(self, volts):
        value = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=volts)
        assert self._set('battery_v', value).successful

    def inject(self, fault):
        """What the fake board answers to being asked for one."""
        value = ParameterValue(type=ParameterType.PARAMETER_STRING, string_value=fault)
        return self._set('fault', value)

    def _set(self, name, value):
        request = SetParameters.Request(parameters=[Parameter(name=name, value=value)])
        client = self.node.create_client(SetParameters, 'fake_hardware/set_parameters')
        self.wait('parameters', client.service_is_ready)
        return self.answer_of(client, request, 'the parameter').results[0]


@pytest.fixture(scope='package')
def port(tmp_path_factory):
    return tmp_path_factory.mktemp('line') / 'board'


@pytest.fixture(scope='package')
def processes(port, tmp_path_factory):
    hasty = find('robocake').read_text().replace('arm_interval_ms: 150', 'arm_interval_ms: 40')
    hasty = re.sub('setpoint_deadline_ms: .*', 'setpoint_deadline_ms: 1000', hasty)
    machine = tmp_path_factory.mktemp('machine') / 'hasty.yaml'
    machine.write_text(hasty)
    nodes = [
        Executable('fake_hardware', {'link': str(port), 'machine': str(machine)}),
        Executable('serial_bridge', {'port': str(port), 'machine': str(machine)}),
    ]
    with Graph(nodes, SPACE) as graph:
        yield graph
        assert graph.dead() is None


@pytest.fixture(scope='package')
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
    rig.make_ready()
    return rig
