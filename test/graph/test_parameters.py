"""What `ros2 param describe` says of every node's own parameters."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from rcl_interfaces.msg import ParameterType
from rcl_interfaces.srv import DescribeParameters, ListParameters

from patient_user import PatientUser

pytestmark = pytest.mark.graph
ROOT = Path(__file__).resolve().parents[2]
NODES = ('trajectory', 'ik', 'pose', 'serial_bridge', 'fake_hardware', 'joy_teleop', 'panel')
NAMESPACE = 'described'
FOREIGN = ('use_sim_time', 'start_type_description_service', 'qos_overrides')
"""rclpy's own."""
PORTS = {'fake_hardware': 'link', 'serial_bridge': 'port'}
COMPANIONS = ('serial_bridge_stop',)
"""Nodes that others start for themselves, with no parameters of their own."""


@pytest.fixture(scope='module')
def client():
    with PatientUser(NAMESPACE) as client:
        yield client


@pytest.fixture(scope='module')
def descriptors(client, tmp_path_factory):
    """Every node's descriptors by name, asked of running nodes that all run at once."""
    link = tmp_path_factory.mktemp('port') / 'board'
    started = []
    for executable in NODES:
        words = ['-m', 'hexarm.nodes', executable, '--ros-args']
        words += ['-r', f'__ns:=/{NAMESPACE}/{executable}']
        if executable in PORTS:
            words += ['-p', f'{PORTS[executable]}:={link}']
        started.append(subprocess.Popen([sys.executable, *words], cwd=ROOT, env=os.environ))
    try:
        yield {executable: describe(client, executable) for executable in NODES}
    finally:
        for process in started:
            process.terminate()
        for process in started:
            process.wait(60)


def describe(client, executable):
    def nodes():
        found = client.node.get_node_names_and_namespaces()
        own = [n for n, space in found if space == f'/{NAMESPACE}/{executable}']
        return [name for name in own if name not in COMPANIONS]

    client.wait(f'{executable} in the graph', nodes, 20.0)
    node = f'/{NAMESPACE}/{executable}/{nodes()[0]}'
    listed = call(client, ListParameters, f'{node}/list_parameters').result.names
    names = [name for name in listed if not name.startswith(FOREIGN)]
    request = {'names': names}
    return call(client, DescribeParameters, f'{node}/describe_parameters', **request).descriptors


def call(client, kind, name, **fields):
    service = client.node.create_client(kind, name)
    client.wait(f'service {name}', service.service_is_ready, 10.0)
    answer = client.answer_of(service, kind.Request(**fields), f'an answer of {name}')
    client.node.destroy_client(service)
    return answer


@pytest.mark.parametrize('executable', NODES)
def test_every_parameter_is_described_and_every_number_has_a_range(descriptors, executable):
    described = descriptors[executable]
    assert described
    for one in described:
        assert len(one.description) > 10, one.name
        if one.type == ParameterType.PARAMETER_DOUBLE:
            (span,) = one.floating_point_range
            assert span.from_value < span.to_value, one.name
        if one.type == ParameterType.PARAMETER_INTEGER:
            (span,) = one.integer_range
            assert span.from_value < span.to_value, one.name


UNIT = re.compile(
    r'\b(Hz|seconds?|metres?|m|rad|radians|degrees|volts|bits per second|port number|\d+ s)\b'
)


@pytest.mark.parametrize('executable', NODES)
def test_every_number_is_described_with_its_unit(descriptors, executable):
    numbers = (
        ParameterType.PARAMETER_DOUBLE,
        ParameterType.PARAMETER_INTEGER,
        ParameterType.PARAMETER_DOUBLE_ARRAY,
    )
    for one in descriptors[executable]:
        if one.type in numbers:
            assert UNIT.search(one.description), (one.name, one.description)
