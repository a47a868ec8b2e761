"""The same page for a serial arm: sliders, joystick, gripper and STOP."""

import re
import time
from pathlib import Path

import pytest
from std_msgs.msg import Float64

from hexarm.graph import Graph, check_alive, machine_graph
from hexarm.panel_process import panel_process
from manipulator.nodes.qos import LATCHED
from patient_user import PatientUser

pytestmark = pytest.mark.graph

SHIPPED = Path(__file__).resolve().parents[3] / 'config' / 'arm_6r.yaml'
Z, GRIPPER = 'z [mm]', 'gripper [%]'

CIRCLE = {
    'cycle.amplitude': '[0.06, 0.06, 0.0, 0.0, 0.0, 0.0]',
    'cycle.phase': '[0.0, 1.5708, 0.0, 0.0, 0.0, 0.0]',
}


@pytest.fixture(scope='module')
def arm_panel(browser, tmp_path_factory):
    """The page of an arm whose board waits longer than a busy test machine may stall."""
    patient = re.sub('setpoint_deadline_ms: .*', 'setpoint_deadline_ms: 1000', SHIPPED.read_text())
    path = tmp_path_factory.mktemp('arm') / 'arm_6r.yaml'
    path.write_text(patient)
    return panel_process(str(path))


@pytest.fixture(scope='module')
def user(arm_panel, with_cycle, tmp_path_factory):
    link = tmp_path_factory.mktemp('port') / 'board'
    nodes = machine_graph(arm_panel.parameters['machine'], 'fake', link)
    with (
        Graph([*with_cycle(nodes, CIRCLE), arm_panel], 'arm') as graph,
        PatientUser('arm', lambda: check_alive(graph)) as client,
    ):
        client.wait('the panel', lambda: 'arm/panel' in client.diagnostics)
        yield client


@pytest.fixture(scope='module')
def page(open_page, arm_panel, user):
    return open_page(arm_panel)


@pytest.fixture
def arm(user, page, seen):
    with seen(user) as seen_arm:
        yield seen_arm
    page.let_go()


def test_a_number_beside_a_slider_moves_the_arm(page, arm):
    height = f'{1e3 * arm.start.position[2] - 20:.1f}'
    arm.asked_until(lambda: page.type(Z, height), lambda: arm.has_moved(2, -0.019))


def test_the_joystick_moves_the_arm_while_it_is_held(page, arm):
    arm.jog(page, '#move', (0.0, 0.3), 0, 0.01)
    released = time.time()
    page.let_go()
    arm.seconds_to_rest(released)


def test_stop_stops_the_arm_and_nothing_resumes(page, arm):
    print(f'STOP: the servos stood {arm.seconds_to_stop(page):.3f} s after the press')


def test_the_gripper_opens_by_its_slider_and_the_slider_follows_others(page, arm):
    closed = opening(arm)
    arm.asked_until(lambda: page.type(GRIPPER, '100'), lambda: opening(arm) > closed + 0.5)
    others = arm.client.node.create_publisher(Float64, 'gripper', LATCHED)
    arm.asked_until(lambda: others.publish(Float64(data=0.0)), lambda: page.value(GRIPPER) == 0)


def opening(arm):
    """Where the gripper really is, rad."""
    last = arm.joints[-1]
    return last.position[last.name.index('gripper')]
