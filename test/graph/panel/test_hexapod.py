"""The hexapod's page: what it shows, what sliders, joystick and STOP do, and who may open it.

What counts as a hand that is gone, test/hexarm/panel/test_joystick_page.py tries.
"""

import os
import signal
import time
from http.client import HTTPConnection
from urllib.parse import urlsplit

import numpy as np
import pytest
from PIL import Image

from hexarm.graph import Graph, check_alive, machine_graph
from hexarm.panel_process import panel_address, panel_process
from manipulator.pose import Pose
from patient_user import PatientUser

pytestmark = pytest.mark.graph

X = 'x [mm]'
ELSEWHERE = Pose.from_xyz_rpy((-0.002, 0.0, 0.045))
PICTURED = Pose.from_xyz_rpy((0.006, -0.004, 0.0455), (0.05, 0.09, -0.03))

CIRCLE = {
    'cycle.amplitude': '[0.006, 0.006, 0.0, 0.0, 0.0, 0.0]',
    'cycle.phase': '[0.0, 1.5708, 0.0, 0.0, 0.0, 0.0]',
}
"""A cycle on which some servo is always on its way: nothing else would tell when it stops."""

JOG = 0.003
"""Metres that tell a jog from standing still. The reach is 15 mm, so jogs are slow: a busy
computer must not come to its end meanwhile."""


@pytest.fixture(scope='module')
def panel(browser, patient_robocake):
    return panel_process(patient_robocake)


@pytest.fixture(scope='module')
def hexapod_graph(patient_robocake, panel, with_cycle, tmp_path_factory):
    """The hexapod's processes and its panel."""
    link = tmp_path_factory.mktemp('port') / 'board'
    nodes = with_cycle(machine_graph(patient_robocake, 'fake', link), CIRCLE)
    with Graph([*nodes, panel], 'hexapod') as graph:
        yield graph


@pytest.fixture(scope='module')
def user(hexapod_graph):
    with PatientUser('hexapod', lambda: check_alive(hexapod_graph)) as client:
        yield client


@pytest.fixture(scope='module')
def page(open_page, panel, user):
    """The hexapod's panel, open for all tests of this file."""
    user.wait('the panel', lambda: 'hexapod/panel' in user.diagnostics)
    return open_page(panel)


@pytest.fixture
def machine(user, page, seen):
    """The hexapod as seen from outside; at home and able to move."""
    page.show('Drive')
    with seen(user) as hexapod:
        yield hexapod
    if not page.page.is_closed():
        page.let_go()


def test_sliders_move_the_machine_and_follow_the_goals_of_others(page, machine):
    thumb = page.page.get_by_role('slider', name=X)

    def press():
        thumb.focus()  # a page that has heard nothing for a while has disabled it
        for _ in range(30):
            page.page.keyboard.press('ArrowRight')

    machine.asked_until(press, lambda: machine.has_moved(0, 0.002))
    machine.asked_until(lambda: machine.go_to(ELSEWHERE), lambda: abs(page.value(X) + 2.0) < 0.2)


def test_a_pose_is_saved_on_the_page_and_gone_to_again(page, machine):
    page.show('Poses')
    page.page.get_by_placeholder('name').fill('left')
    machine.asked_until(
        lambda: page.press('Save pose'),
        lambda: page.page.get_by_role('button', name='go to left').count() > 0,
    )
    machine.client.spin(0.3)
    saved = machine.poses[-1].position
    machine.asked_until(lambda: machine.go_to(ELSEWHERE), lambda: machine.has_moved(0, -0.001))
    machine.asked_until(
        lambda: page.press('go to left'),
        lambda: np.abs(machine.poses[-1].position - saved).max() < 2e-4,
    )


def test_stop_stops_the_machine_and_nothing_resumes(page, machine):
    print(f'STOP: the servos stood {machine.seconds_to_stop(page):.3f} s after the press')


def test_a_node_that_does_not_answer_is_named(page, machine, hexapod_graph):
    machine_process = hexapod_graph.pids()['machine']
    notice = page.page.get_by_text('Home: no answer within')

    def ask():
        os.kill(machine_process, signal.SIGSTOP)
        try:
            page.press('Home')
            page.may_say(notice)
        finally:
            os.kill(machine_process, signal.SIGCONT)
            machine.client.spin(1.0)  # it takes the machine over anew

    machine.asked_until(ask, lambda: notice.count() > 0)


def test_other_sites_are_rejected(panel, page):
    for path in ('/', '/index.html', '/joystick', '/controls'):
        assert opened(panel, path, 'http://elsewhere.example') == 403
    for path in ('/joystick', '/controls'):
        assert opened(panel, path, panel_address(panel)) == 101


def opened(panel, path, origin):
    """What the panel answers to a script of some site that asks for a connection."""
    connection = HTTPConnection(urlsplit(panel_address(panel)).netloc, timeout=60)
    connection.putrequest('GET', path)
    words = {'Upgrade': 'websocket', 'Connection': 'Upgrade', 'Origin': origin}
    words |= {'Sec-WebSocket-Key': 16 * 'a' + 6 * 'A' + '==', 'Sec-WebSocket-Version': '13'}
    for name, value in words.items():
        connection.putheader(name, value)
    connection.endheaders()
    status = connection.getresponse().status
    connection.close()
    return status


def test_topics_are_those_of_the_document(page, user, interfaces):
    interfaces.assert_documented(user, 'panel')


def test_the_page_is_worth_a_picture(open_page, page, panel, machine, tmp_path):
    """Kept with all pixels, for README.md and docs/panel.md, where WRITE_SCREENSHOT says."""
    kept = os.environ.get('WRITE_SCREENSHOT')
    shown = open_page(panel, (1280, 760), pixels=1.0) if kept else page
    path = kept or str(tmp_path / 'panel.png')

    def draw():
        machine.start_cycle()
        machine.client.spin(3.0)
        machine.client.trigger('trajectory/stop')
        machine.client.wait_while_driven('rest', lambda: machine.client.motion('mode') == 'hold')
        machine.client.go_to(PICTURED)
        machine.client.spin(2.0)

    machine.client.persist(draw)
    shown.page.screenshot(path=path)
    colours = np.asarray(Image.open(path).convert('RGB'), dtype=int).reshape(-1, 3)
    red, green, blue = colours.T
    scene = {'green legs': green - red > 40, 'the platform': blue - red > 50}
    scene |= {'STOP': (red > 180) & (green < 80)}
    if kept:  # few pixels do not show it
        scene |= {'an amber leg': (red - blue > 60) & (green > 120)}
    shares = {what: np.mean(which) for what, which in scene.items()}
    assert all(share > 0.001 for share in shares.values()), shares


def test_release_stops(page, machine):
    machine.jog(page, '#move', (0.0, 0.12), 0, JOG)
    released = time.time()
    page.let_go()
    machine.seconds_to_rest(released)
    await_zero(machine)


def await_zero(machine):
    """That of a panel which stood still comes after the machine has stopped by itself."""

    def is_zero():
        last = machine.twists[-1].twist.linear
        return (last.x, last.y, last.z) == (0.0, 0.0, 0.0)

    machine.client.wait('a twist of zero', is_zero)


def test_closing_the_page_while_jogging_stops(page, machine):
    machine.jog(page, '#move', (-0.12, 0.0), 1, JOG)
    closed = time.time()
    page.page.close()
    machine.seconds_to_rest(closed)
