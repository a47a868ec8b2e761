"""Faults on request: what the bridge makes of them, and that nothing moves again unasked."""

import pytest
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from std_msgs.msg import Bool
from std_srvs.srv import SetBool

from hexarm.client import Client
from hexarm.graph import Executable, Graph
from hexarm.machines import find
from manipulator.errors import Refused
from manipulator.nodes.qos import COMMAND

pytestmark = pytest.mark.graph

SPACE = 'faulty'


class User(Client):
    def __init__(self):
        super().__init__(SPACE)
        self.stops = self.node.create_publisher(Bool, 'emergency_stop', COMMAND)
        self.wait('the bridge', lambda: self.stops.get_subscription_count() == 1, 10.0)

    def ask(self, service, is_true=True):
        return self._call(SetBool, service, SetBool.Request(data=is_true))

    def wait_for(self, words):
        self.wait(words, lambda: words in self.summary, 10.0)

    def inject(self, name):
        value = ParameterValue(type=ParameterType.PARAMETER_STRING, string_value=name)
        request = SetParameters.Request(parameters=[Parameter(name='fault', value=value)])
        client = self.node.create_client(SetParameters, 'fake_hardware/set_parameters')
        self.wait('parameters', client.service_is_ready, 10.0)
        future = client.call_async(request)
        self.wait('the fault', future.done, 10.0)
        return future.result().results[0]


@pytest.fixture(scope='module')
def user(tmp_path_factory):
    folder = tmp_path_factory.mktemp('faulty')
    hasty = find('robocake').read_text().replace('arm_interval_ms: 150', 'arm_interval_ms: 20')
    machine, port = folder / 'hasty.yaml', str(folder / 'board')
    machine.write_text(hasty)
    common = {'machine': str(machine)}
    nodes = [
        Executable('bridge', 'fake_hardware', common | {'link': port}),
        Executable('bridge', 'serial_bridge', common | {'port': port}),
    ]
    with Graph(nodes, SPACE) as graph, User() as user:
        yield user
        assert graph.dead() is None


@pytest.fixture
def enabled(user):
    user.wait('a board', lambda: user.machine_state.message in ('disarmed', 'enabled'), 10.0)
    user.ask('serial_bridge/enable')
    user.wait_for('machine enabled')
    return user


@pytest.mark.parametrize(
    ('name', 'said'),
    [
        ('unplug', 'machine disconnected'),
        ('reset', 'machine disarmed'),
        ('version', 'the board speaks protocol 2, this host 1'),
    ],
)
def test_a_board_that_was_away_comes_back_disarmed(enabled, name, said):
    assert enabled.inject(name).successful
    enabled.wait_for(said)
    enabled.wait_for('machine disarmed')


def test_a_board_that_fell_silent_must_be_asked_again(enabled):
    enabled.inject('mute')
    enabled.wait_for('machine disconnected')
    enabled.wait_for('machine unclaimed')
    enabled.ask('serial_bridge/enable')
    enabled.wait_for('machine enabled')


def test_an_empty_battery_stops_until_it_is_cleared(enabled):
    enabled.inject('undervoltage')
    enabled.wait_for('machine fault: the battery is too low')
    enabled.wait('the battery', lambda: is_done(enabled, 'serial_bridge/clear_fault'), 10.0)
    enabled.wait_for('machine enabled')


def is_done(user, service):
    try:
        user.trigger(service)
    except Refused:
        return False
    return True


def test_an_unknown_fault_is_refused_by_name(user):
    result = user.inject('fire')
    assert not result.successful
    assert "'fire' is not one of drop, duplicate" in result.reason


def test_an_open_stop_contact_stops_and_cannot_be_cleared_until_it_is_closed(enabled):
    enabled.ask('fake_hardware/stop_pin', True)
    enabled.wait_for('machine stopped')
    with pytest.raises(Refused, match='clear'):
        enabled.trigger('serial_bridge/clear_fault')
    enabled.ask('fake_hardware/stop_pin', False)
    enabled.spin(0.3)
    assert enabled.machine_state.message == 'stopped'
    enabled.trigger('serial_bridge/clear_fault')
    enabled.wait_for('machine enabled')


def test_a_stop_while_the_board_is_away_latches_and_only_clear_ends_it(enabled):
    enabled.ask('fake_hardware/plug', False)
    enabled.wait_for('machine disconnected')
    enabled.stops.publish(Bool(data=True))
    enabled.spin(0.2)
    enabled.ask('fake_hardware/plug', True)
    enabled.wait_for('machine stopped')
    enabled.stops.publish(Bool(data=False))
    with pytest.raises(Refused, match='clear the stop first'):
        enabled.ask('serial_bridge/enable')
    enabled.trigger('serial_bridge/clear_fault')
    enabled.wait_for('machine disarmed')
