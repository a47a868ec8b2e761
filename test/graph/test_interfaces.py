"""docs/interfaces.md against the running nodes, in both directions."""

import re
from pathlib import Path

import pytest
from rcl_interfaces.srv import ListParameters
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy

pytestmark = pytest.mark.graph

ROOT = Path(__file__).resolve().parents[2]
NODES = ('trajectory', 'ik', 'pose', 'serial_bridge', 'fake_hardware')
EVERYWHERE = {'/diagnostics', '/rosout', '/parameter_events'}
"""Every node has these; the text above the tables says so."""
THREADS = ('serial_bridge_stop', 'serial_bridge_programs')
"""Nodes in the process of another one, without parameters and diagnostics."""
OPTIONAL = {'/tf'}
"""There where tf2_msgs is installed."""
ROS_PARAMETERS = ('use_sim_time', 'start_type_description_service')
ROS_OWN = ('parameter', 'type_description')


def section(node):
    text = (ROOT / 'docs' / 'interfaces.md').read_text()
    return text.split(f'\n## {node}\n')[1].split('\n## ')[0]


def documented(node):
    """{(kind, name): (type, QoS)} from the tables of one node."""
    row = r'^\| `([\w/]+)` \| (in|out|service) \| (\S+) \|([^|]*)\|'
    found = re.findall(row, section(node), re.MULTILINE)
    return {(kind, name): (message, qos.strip()) for name, kind, message, qos in found}


def running(user, node):
    """The same from the graph."""
    found = {}
    ask = user.node
    for kind, query, endpoints in (
        ('in', ask.get_subscriber_names_and_types_by_node, ask.get_subscriptions_info_by_topic),
        ('out', ask.get_publisher_names_and_types_by_node, ask.get_publishers_info_by_topic),
    ):
        for topic, types in query(node, '/hexapod'):
            if topic in EVERYWHERE | OPTIONAL:
                continue
            (qos,) = {qos_text(e.qos_profile) for e in endpoints(topic) if e.node_name == node}
            found[kind, topic.removeprefix('/hexapod/')] = (types[0], qos)
    for service, types in ask.get_service_names_and_types_by_node(node, '/hexapod'):
        if not any(word in service for word in ROS_OWN):
            found['service', service.removeprefix('/hexapod/')] = (types[0], '')
    return found


def qos_text(profile):
    reliability = 'R' if profile.reliability == ReliabilityPolicy.RELIABLE else 'B'
    durability = 'L' if profile.durability == DurabilityPolicy.TRANSIENT_LOCAL else 'V'
    return f'{reliability} {durability}'


@pytest.mark.parametrize('node', NODES + THREADS)
def test_topics_and_services_are_those_of_the_document(enabled, node):
    names = enabled.node.get_node_names_and_namespaces
    enabled.wait(f'the name of {node}', lambda: (node, '/hexapod') in names(), 10.0)
    enabled.wait(f'node {node}', lambda: running(enabled, node), 10.0)
    assert running(enabled, node) == documented(node)


@pytest.mark.parametrize('node', NODES)
def test_parameters_are_those_of_the_document(enabled, node):
    client = enabled.node.create_client(ListParameters, f'{node}/list_parameters')
    enabled.wait('the parameter service', client.service_is_ready, 10.0)
    future = client.call_async(ListParameters.Request())
    enabled.wait('parameters', future.done, 10.0)
    names = {n for n in future.result().result.names if not n.startswith(ROS_PARAMETERS)}
    tables = section(node).split('| parameter |')[1]
    assert names == set(re.findall(r'^\| `([\w.]+)` \|', tables, re.M))


@pytest.mark.parametrize('node', [n for n in NODES if n != 'fake_hardware'])
def test_diagnostics_use_only_the_keys_of_the_document(enabled, node):
    name = f'hexapod/{node}'
    enabled.wait('diagnostics', lambda: name in enabled.diagnostics, 5.0)
    keys = {pair.key for pair in enabled.diagnostics[name].values}
    listed = set(re.findall(r'`(\w+)`', section(node).split('Diagnostics:')[1]))
    assert keys <= listed
