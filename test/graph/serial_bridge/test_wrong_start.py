"""A bridge started with the wrong port, machine or parameter says what is wrong."""

import subprocess
import sys

import pytest

from hexarm.client import Client
from hexarm.graph import Executable, Graph
from hexarm.machines import find

pytestmark = pytest.mark.graph


def state_in(space, word):
    """The machine state of another namespace, once it is `word`."""
    with Client(space) as client:
        client.wait(word, lambda: client.machine_state.message == word, 60.0)
        return client.summary


def test_a_second_bridge_on_the_port_says_that_it_is_in_use(rig, port):
    second = Executable('serial_bridge', {'port': str(port)})
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
        Executable('fake_hardware', {'link': port}),
        Executable('serial_bridge', {'port': port, 'machine': str(path)}),
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
    command = [sys.executable, '-m', 'hexarm.nodes', entry, '--ros-args', '-p', parameter]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 1
    assert said in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
