"""A bridge started with the wrong port, machine or parameter says what is wrong."""

import subprocess
import sys

import pytest
from diagnostic_msgs.msg import DiagnosticStatus

from hexarm.graph import Executable, Graph
from manipulator.nodes.qos import LATCHED

pytestmark = pytest.mark.graph


def test_a_second_bridge_on_the_port_reports_that_it_is_in_use(rig, port):
    second = Executable('serial_bridge', {'port': str(port)})
    received = []
    subscription = rig.node.create_subscription(
        DiagnosticStatus, '/second/machine_state', received.append, LATCHED
    )
    with Graph([second], 'second') as graph:
        rig.wait('its state', lambda: any('in use by another program' in str(m) for m in received))
        assert received[-1].message == 'disconnected'
        assert graph.dead() is None
    rig.node.destroy_subscription(subscription)


@pytest.mark.parametrize(
    ('entry', 'parameter', 'said'),
    [
        ('serial_bridge', 'machine:=robocacke', "did you mean 'robocake'"),
        ('fake_hardware', 'preset:=awful', "preset: 'awful' is not one of"),
    ],
)
def test_what_is_wrong_at_the_start_is_one_line_and_status_1(entry, parameter, said):
    command = [sys.executable, '-m', 'hexarm.nodes', entry, '--ros-args', '-p', parameter]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 1
    assert said in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
