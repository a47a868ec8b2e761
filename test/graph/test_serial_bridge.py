"""serial_bridge and fake_hardware as processes, driven over topics and services."""

import math
import subprocess
import sys
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
from manipulator.errors import Refused
from manipulator.nodes.qos import COMMAND, MEASUREMENT

pytestmark = pytest.mark.graph

NAMES = [f'crank_{i}' for i in range(1, 7)]
PARK = math.radians(120)
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


def test_unknown_joints_are_not_published_and_commands_move_nothing(rig):
    rig.joints.clear()
    before = rig.true_angle()
    rig.refuses('disarmed', positions=[PARK + 0.05] * 6)
    assert rig.joints == []
    assert rig.true_angle() == before


def test_enabling_arms_servo_by_servo_to_park(rig):
    rig.joints.clear()
    rig.enable()
    rig.wait('all joints', lambda: rig.joints and len(rig.joints[-1].name) == 6, 5.0)
    counts = [len(message.name) for message in rig.joints]
    assert counts == sorted(counts)
    assert set(counts) == {1, 2, 3, 4, 5, 6}
    assert rig.joints[-1].position == pytest.approx([PARK] * 6, abs=1e-3)
    assert list(rig.joints[-1].velocity) == [0.0] * 6
    assert len(rig.joints[-1].effort) == 6


def test_commands_move_the_servos_and_silence_holds_them(enabled):
    enabled.stream(PARK + 0.2)
    enabled.wait_for_state('holding')
    assert enabled.true_angle() == pytest.approx(PARK + 0.2, abs=0.02)
    enabled.stream(PARK + 0.1)
    assert enabled.machine_state.message == 'enabled'
    report = enabled.report()
    assert float(report['setpoint_to_frame_p50_ms']) > 0
    assert float(report['round_trip_p50_ms']) > 0
    assert int(report['frames_sent']) >= 50


BAD_COMMANDS = [
    ({'positions': [PARK] * 6, 'names': [*NAMES[:5], 'crank_9']}, "unknown joint 'crank_9'"),
    ({'positions': [PARK] * 5, 'names': NAMES[:5]}, 'no position for crank_6'),
    ({'positions': [PARK] * 6, 'names': ['crank_1'] * 6}, 'crank_1 stands twice'),
    ({'positions': [PARK] * 5 + [math.nan]}, 'crank_6: nan is not finite'),
    ({'positions': [PARK, PARK, 4.0, PARK, PARK, PARK]}, 'crank_3: 4 rad outside'),
    ({'positions': [PARK + 0.5] * 6}, 'crank_1: 2.594 rad would jump by 0.45'),
    ({'positions': [], 'names': []}, 'no position for crank_1, crank_2'),
    ({'positions': [PARK] * 10_000, 'names': ['crank_2'] * 10_000}, 'bytes, at most 10000'),
]


def test_a_bad_command_is_named_and_the_next_good_one_works(enabled):
    enabled.stream(PARK + 0.05, 0.2)
    for command, said in BAD_COMMANDS:
        enabled.refuses(said, **command)
        enabled.stream(PARK + 0.05, 0.1)
        assert enabled.machine_state.message == 'enabled', said
    enabled.stream(PARK + 0.1)
    assert enabled.true_angle() == pytest.approx(PARK + 0.1, abs=0.02)


def test_a_sender_with_another_clock_is_followed_and_reported(enabled):
    for k in range(20):
        enabled.command([PARK + 0.005 * k] * 6, clock=3600.0)
        enabled.spin(0.02)
    report = enabled.report()
    assert float(report['joint_command_clock_offset_s']) == pytest.approx(-3600, abs=2)
    assert enabled.true_angle() == pytest.approx(PARK + 0.095, abs=0.02)


def test_emergency_stop_latches_until_it_is_cleared(enabled):
    enabled.stop(False)
    enabled.stream(PARK + 0.1)
    assert enabled.machine_state.message == 'enabled'
    enabled.stop()
    enabled.wait_for_state('stopped')
    before = enabled.true_angle()
    enabled.refuses('stopped', positions=[PARK + 0.15] * 6)
    with pytest.raises(Refused, match='clear the stop first'):
        enabled.switch('serial_bridge/enable')
    enabled.trigger('serial_bridge/clear_fault')
    enabled.wait_for_state('enabled')
    assert enabled.true_angle() == before
    enabled.stream(PARK)
    assert enabled.true_angle() == pytest.approx(PARK, abs=0.02)


def test_disabling_ends_all_pulses(enabled):
    enabled.switch('serial_bridge/enable', False)
    enabled.wait_for_state('disarmed')
    enabled.spin(0.1)
    enabled.joints.clear()
    enabled.spin(0.2)
    assert enabled.joints == []


def test_an_unplugged_board_comes_back_disarmed(enabled, port):
    enabled.switch('fake_hardware/plug', False)
    enabled.wait_for_state('disconnected')
    with pytest.raises(Refused, match='no board'):
        enabled.switch('serial_bridge/enable')
    assert not port.exists()
    enabled.switch('fake_hardware/plug')
    enabled.wait_for_state('disarmed')
    before = enabled.true_angle()
    enabled.command([PARK + 0.1] * 6)
    enabled.spin(0.3)
    assert enabled.true_angle() == before
    enabled.enable()


def test_a_mute_board_is_disconnected_and_must_be_enabled_again(enabled):
    enabled.switch('fake_hardware/mute')
    enabled.wait_for_state('disconnected')
    enabled.switch('fake_hardware/mute', False)
    enabled.wait_for_state('unclaimed')
    enabled.refuses('call ~/enable', positions=[PARK] * 6)
    before = enabled.true_angle()
    enabled.enable()
    assert enabled.true_angle() == before


def test_a_reset_ends_disarmed(enabled):
    enabled.stream(PARK + 0.1)
    enabled.trigger('fake_hardware/reset')
    enabled.wait_for_state('disarmed')
    before = enabled.true_angle()
    enabled.command([PARK + 0.1] * 6)
    enabled.spin(0.3)
    assert enabled.true_angle() == before


def test_a_low_battery_is_a_fault_that_must_be_cleared(enabled):
    enabled.set_battery(5.0)
    enabled.wait_for_state('fault')
    with pytest.raises(Refused, match='battery is too low'):
        enabled.trigger('serial_bridge/clear_fault')
    enabled.set_battery(7.6)
    enabled.wait('a good battery', lambda: enabled.report()['battery_v'] == '7.6', 5.0)
    enabled.trigger('serial_bridge/clear_fault')
    enabled.wait_for_state('enabled')


def test_a_second_publisher_of_commands_is_said(rig):
    other = rig.node.create_publisher(JointState, 'joint_command', COMMAND)
    crowd = '2 publishers on joint_command'
    rig.wait('the complaint', lambda: crowd in rig.report()['message'], 10.0)
    rig.node.destroy_publisher(other)
    rig.wait('peace', lambda: crowd not in rig.report()['message'], 10.0)


def state_in(space, word):
    """The machine state of another namespace, once it is `word`."""
    with Client(space) as client:
        client.wait(word, lambda: client.machine_state.message == word, 10.0)
        return client.summary


def test_a_second_bridge_on_the_port_says_that_it_is_in_use(rig, port):
    second = Executable('bridge', 'serial_bridge', {'port': str(port)})
    with Graph([second], 'second') as graph:
        assert 'in use by another program' in state_in('second', 'disconnected')
        assert graph.dead() is None


def test_a_board_with_another_joint_count_is_a_fault(tmp_path):
    text = find('robocake').read_text()
    five = [line for line in text.splitlines() if 'name: crank_6' not in line]
    path = tmp_path / 'five.yaml'
    path.write_text('\n'.join(five).replace(', 120.0]', ']'))
    port = str(tmp_path / 'board')
    nodes = [
        Executable('bridge', 'fake_hardware', {'link': port}),
        Executable('bridge', 'serial_bridge', {'port': port, 'machine': str(path)}),
    ]
    with Graph(nodes, 'five'):
        assert 'the board has 6 joints, the machine 5' in state_in('five', 'fault')


@pytest.mark.parametrize(
    ('entry', 'parameter', 'said'),
    [
        ('serial_bridge', 'machine:=robocacke', "did you mean 'robocake'"),
        ('serial_bridge', 'baud:=-5', 'baud'),
        ('fake_hardware', 'preset:=awful', "preset: 'awful' is not one of"),
        ('fake_hardware', 'link:=/', 'not overwritten'),
    ],
)
def test_what_is_wrong_at_the_start_is_one_line_and_status_1(entry, parameter, said):
    command = [sys.executable, '-m', 'bridge', entry, '--ros-args', '-p', parameter]
    done = subprocess.run(command, capture_output=True, text=True, timeout=20, check=False)
    assert done.returncode == 1
    assert said in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
