"""docs/interfaces.md against the running nodes, in both directions."""

import re

import pytest
from rcl_interfaces.srv import ListParameters

pytestmark = pytest.mark.graph

NODES = ('trajectory', 'ik', 'pose', 'serial_bridge', 'fake_hardware')
THREADS = ('serial_bridge_stop',)
"""Nodes beside another one, without parameters and diagnostics."""
ROS_PARAMETERS = ('use_sim_time', 'start_type_description_service')


@pytest.mark.parametrize('node', NODES + THREADS)
def test_topics_and_services_are_those_of_the_document(enabled, node, interfaces):
    interfaces.assert_documented(enabled, node)


@pytest.mark.parametrize('node', NODES)
def test_parameters_are_those_of_the_document(enabled, node, interfaces):
    client = enabled.node.create_client(ListParameters, f'{node}/list_parameters')
    enabled.wait('the parameter service', client.service_is_ready, 10.0)
    answer = enabled.answer_of(client, ListParameters.Request(), 'parameters')
    names = {n for n in answer.result.names if not n.startswith(ROS_PARAMETERS)}
    tables = interfaces.section(node).split('| parameter |')[1]
    assert names == set(re.findall(r'^\| `([\w.]+)` \|', tables, re.M))


@pytest.mark.parametrize('node', [n for n in NODES if n != 'fake_hardware'])
def test_diagnostics_use_only_the_keys_of_the_document(enabled, node, interfaces):
    name = f'hexapod/{node}'
    enabled.wait('diagnostics', lambda: name in enabled.diagnostics, 5.0)
    keys = {pair.key for pair in enabled.diagnostics[name].values}
    listed = set(re.findall(r'`(\w+)`', interfaces.section(node).split('Diagnostics:')[1]))
    assert keys <= listed


def test_diagnostics_name_the_machine(enabled, patient_robocake):
    name = 'hexapod/pose'
    enabled.wait('diagnostics', lambda: name in enabled.diagnostics, 5.0)
    assert enabled.diagnostics[name].hardware_id == patient_robocake
