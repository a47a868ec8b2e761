"""Servos that are energised one by one may take their time: who enables them waits for it."""

import re

import pytest

from hexarm import client
from hexarm.cli.up import check_alive
from hexarm.client import Client
from hexarm.graph import Graph, machine_graph
from hexarm.machines import find
from manipulator.errors import Refused

pytestmark = pytest.mark.graph

SPACE = 'slow_arming'
PATIENCE = 3.0
"""Seconds; the six servos take twice as long."""


@pytest.fixture(scope='module')
def module_user(tmp_path_factory):
    folder = tmp_path_factory.mktemp('slow')
    slow = re.sub('arm_interval_ms: .*', 'arm_interval_ms: 1000', find('robocake').read_text())
    machine = folder / 'slow.yaml'
    machine.write_text(slow)
    nodes = machine_graph(str(machine), 'fake', folder / 'board')
    with Graph(nodes, SPACE) as graph, Client(SPACE, lambda: check_alive(graph)) as user:
        yield user


@pytest.fixture
def disarmed(module_user, monkeypatch):
    """A user of a machine whose servos are off."""
    away = ('not heard of', 'disconnected', 'booting')
    module_user.wait('a board', lambda: module_user.machine_state.message not in away, 60.0)
    module_user.trigger('serial_bridge/clear_fault')
    module_user.disable()
    module_user.wait('it', lambda: module_user.machine_state.message == 'disarmed', 60.0)
    monkeypatch.setattr(client, 'DRIVEN_WITHIN', PATIENCE)
    return module_user


def test_enabling_goes_on_for_as_long_as_the_bridge_says_that_it_arms(disarmed):
    disarmed.enable()
    assert disarmed.motion('mode') == 'hold'


def test_enabling_ends_with_the_reason_where_the_machine_is_stopped_meanwhile(disarmed):
    spin = disarmed.spin

    def spin_and_stop(seconds):
        spin(seconds)
        if disarmed.machine_state.message == 'arming':
            disarmed.spin = spin
            disarmed.trigger('serial_bridge/stop')

    disarmed.spin = spin_and_stop
    with pytest.raises(Refused, match='machine stopped'):
        disarmed.enable()
