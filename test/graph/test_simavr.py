"""`hexarm up` with a simulated board: the program here or on a simulated chip, servos or loads."""

import pytest

pytestmark = [pytest.mark.graph, pytest.mark.usefixtures('chip_tools')]
NODES = {'fake': 'hexarm.nodes fake_hardware', 'simavr': 'firmware.simulator.node'}


@pytest.mark.parametrize(
    ('port', 'plant'), [('simavr', 'servo'), ('simavr', 'mujoco'), ('fake', 'mujoco')]
)
def test_the_graph_enables_parks_and_leaves_no_board_behind(
    hexarm_up, ends_parked, processes_left, port, plant
):
    words = ('hexapod', '--port', port, '--plant', plant)
    process, _ = hexarm_up(*words, until=f'is up on {port} and enabled')
    (board,) = [pid for pid, words in processes_left().items() if NODES[port] in words]
    ends_parked(process)
    assert board not in processes_left()


def test_a_device_has_no_plant_to_choose(hexarm):
    process = hexarm('up', 'hexapod', '--port', '/dev/null', '--plant', 'mujoco')
    assert process.wait(60) == 2
    assert '--plant mujoco: for port fake or simavr; /dev/null moves' in process.stdout.read()
