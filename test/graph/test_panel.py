"""The panel's page in a real browser, against the whole graph on a fake board."""

import os
import shutil
import time
from dataclasses import replace

import numpy as np
import pytest
from geometry_msgs.msg import PoseStamped, TwistStamped
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from hexarm.graph import Graph, machine_graph
from hexarm.panel_process import panel_address, panel_process
from manipulator.nodes.messages import pose_of, seconds

pytestmark = pytest.mark.graph

sync_api = pytest.importorskip('playwright.sync_api')

CHROMIUM = shutil.which('chromium') or '/usr/bin/chromium'
QUIET = ('background-networking', 'component-update', 'sync', 'default-apps', 'extensions')
FLAGS = [
    '--no-sandbox',
    '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader',
    '--no-first-run',
    *(f'--disable-{name}' for name in QUIET),
]
SMALL = '/?fixedDpr=0.1'
"""Few pixels: a machine without a graphics card draws them all by itself."""

PATIENCE = 60_000
JOG = 0.003
"""Metres that tell a jog from standing still. The reach is 15 mm, so jogs are slow: a busy
computer must not come to its end meanwhile."""

MOVING = 3e-4
"""Radians between two reports of a servo's true angle, 20 ms apart, from which it moves."""

CIRCLE = {
    'cycle.amplitude': '[0.006, 0.006, 0.0, 0.0, 0.0, 0.0]',
    'cycle.phase': '[0.0, 1.5708, 0.0, 0.0, 0.0, 0.0]',
}
"""A cycle on which some servo is always on its way: nothing else would tell when it stops."""


@pytest.fixture(scope='module')
def browser():
    if not os.path.exists(CHROMIUM) and os.environ.get('REQUIRE_ALL') != '1':
        pytest.skip(f'no browser: {CHROMIUM} does not exist')
    with sync_api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield browser
        browser.close()


@pytest.fixture(scope='module')
def panel(patient_robocake):
    return panel_process(patient_robocake)


@pytest.fixture(scope='module')
def hexapod_graph(patient_robocake, panel, tmp_path_factory):
    """The hexapod's processes and its panel."""
    link = tmp_path_factory.mktemp('port') / 'board'
    nodes = machine_graph('hexapod', patient_robocake, 'fake', link)
    nodes = [
        replace(node, parameters=node.parameters | CIRCLE) if node.entry == 'trajectory' else node
        for node in nodes
    ]
    with Graph([*nodes, panel], 'hexapod') as graph:
        yield graph


@pytest.fixture(scope='module')
def two_pages(browser, panel, user):
    """The panel, open twice."""
    user.wait('the panel', lambda: 'hexapod/panel' in user.diagnostics, 30.0)
    pages = [browser.new_page(viewport={'width': 760, 'height': 760}) for _ in range(2)]
    for page in pages:
        page.set_default_timeout(PATIENCE)
        page.goto(panel_address(panel) + SMALL)
        says(page, 'drag to move')
    return pages


@pytest.fixture
def page(two_pages):
    return two_pages[0]


@pytest.fixture
def machine(user, two_pages):
    """What the machine does, heard from outside; at home and able to move."""
    make_ready(user)
    user.wait('standing still', lambda: user.motion('mode') == 'hold', 10.0)
    user.home()
    heard = Heard(user)
    yield heard
    heard.close()
    for page in two_pages:
        page.mouse.up()


def make_ready(user):
    """Enabled, whatever the test before, or a computer that was too busy for the line, left."""
    if user.machine_state.message == 'stopped':
        user.trigger('serial_bridge/clear_fault')
    if user.machine_state.message != 'enabled':
        user.enable()


class Heard:
    """Poses, twists of the panel and true joints, with the time on this computer's clock."""

    def __init__(self, client):
        self.client = client
        self.poses, self.twists, self.joints = [], [], []
        node, qos = client.node, QoSProfile(depth=2000)
        self._subscriptions = [
            node.create_subscription(
                PoseStamped, 'pose', lambda m: self.poses.append(pose_of(m)), qos
            ),
            node.create_subscription(TwistStamped, 'cmd_vel/panel', self.twists.append, qos),
            node.create_subscription(JointState, 'true_joint_states', self.joints.append, qos),
        ]
        client.wait('poses', lambda: self.poses, 10.0)
        self.start = self.poses[-1]

    def close(self):
        for subscription in self._subscriptions:
            self.client.node.destroy_subscription(subscription)

    def way(self):
        """How far the platform has come since the test began, in x, y, z."""
        return self.poses[-1].position - self.start.position

    def has_moved(self, axis, metres):
        return self.way()[axis] * np.sign(metres) > abs(metres)

    def wait_until_moved(self, axis, metres):
        self.client.wait(f'{metres} m along axis {axis}', lambda: self.has_moved(axis, metres), 20)

    def seconds_to_rest(self, since):
        """From a moment (time.time) until the joints stand still for good; waits for that."""
        self.client.spin(1.5)
        times = np.array([seconds(m.header.stamp) for m in self.joints])
        joints = np.array([m.position for m in self.joints])
        steps = np.abs(np.diff(joints, axis=0)).max(axis=1)
        assert steps[times[1:] < since].max() > MOVING, 'it did not move before'
        moving = times[1:][steps > MOVING]
        assert moving[-1] < times[-1] - 0.5, 'it never stood still'
        return moving[-1] - since

    def stays(self, seconds):
        """Asserts that the machine stands still for a while."""
        self.client.spin(0.7)
        before = self.poses[-1].position
        self.client.spin(seconds)
        assert np.abs(self.poses[-1].position - before).max() < 2e-4


def hold(page, pad, right, up):
    """Presses the mouse on a pad of the joystick and pushes it."""
    page.bring_to_front()
    box = page.frame_locator('iframe').locator(pad).bounding_box()
    x, y = box['x'] + box['width'] / 2, box['y'] + box['height'] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + right * box['width'] / 2, y - up * box['height'] / 2)


def jog(page, machine, pad, push, axis, metres):
    """Holds until the platform has moved so far.

    A computer that is too busy to draw the page loses the press, as it should: then press again.
    """
    give_up = time.monotonic() + 40.0
    while time.monotonic() < give_up:
        make_ready(machine.client)
        hold(page, pad, *push)
        machine.client.spin(0.3)
        while not machine.has_moved(axis, metres) and said(page) == 'moving while you hold':
            machine.client.spin(0.1)
        if machine.has_moved(axis, metres):
            return
        page.mouse.up()
    raise AssertionError(f'{said(page)}; it moved by {machine.way()}')


def said(page):
    return page.frame_locator('iframe').locator('#said').inner_text()


def says(page, words):
    page.frame_locator('iframe').get_by_text(words).wait_for()


def test_sliders_move_the_machine_and_all_pages_show_it(two_pages, machine):
    page, other = two_pages
    thumb = page.get_by_role('slider').nth(1)
    thumb.focus()
    for _ in range(30):
        page.keyboard.press('ArrowRight')
    machine.wait_until_moved(0, 0.002)
    machine.client.wait('the other page', lambda: values_of(page) == values_of(other), 20.0)
    assert 2.0 <= float(values_of(other)[1]) <= 3.0


def values_of(page):
    """What stands in the fields beside the sliders: speed, then x, y, z …"""
    return [field.input_value() for field in page.get_by_role('textbox').all()]


def test_release_stops(page, machine):
    jog(page, machine, '#move', (0.0, 0.12), 0, JOG)
    released = time.time()
    page.mouse.up()
    assert machine.seconds_to_rest(released) < 1.0
    assert machine.twists[-1].twist.linear.x == 0.0


def test_a_page_that_stands_still_stops_and_does_not_resume(page, machine):
    jog(page, machine, '#lift', (0.0, 0.12), 2, JOG / 2)
    page.evaluate('() => { const end = Date.now() + 1500; while (Date.now() < end); }')
    says(page, 'press again')
    machine.stays(0.5)
    page.mouse.up()
    jog(page, machine, '#lift', (0.0, -0.12), 2, -JOG / 2)
    page.mouse.up()


def test_two_pages_do_not_fight(two_pages, machine):
    first, second = two_pages
    press_both(first, second, machine)
    machine.client.spin(0.5)
    first.mouse.up()
    machine.stays(0.5)
    assert all(twist.twist.linear.x >= 0.0 for twist in machine.twists), 'the second page moved it'
    second.mouse.up()
    jog(second, machine, '#move', (0.0, -0.12), 0, -JOG / 2)
    second.mouse.up()


def press_both(first, second, machine):
    """The first page moves forward, then the second presses backwards, and is told who has it."""
    for _ in range(8):
        machine.twists.clear()
        jog(first, machine, '#move', (0.0, 0.12), 0, JOG / 3)
        hold(second, '#move', 0.0, -0.12)
        machine.client.spin(0.5)
        if said(second) == 'another page has the joystick':
            return
        second.mouse.up()  # a busy computer had lost the first one's press
        first.mouse.up()
    raise AssertionError(said(second))


def test_stop_stops(page, machine):
    """Within 0.3 s on a quiet computer, see docs/panel.md; a busy one is given more."""
    stop = page.get_by_role('button', name='STOP').bounding_box()
    machine.client.trigger('trajectory/start_cycle')
    machine.client.spin(1.0)
    page.mouse.move(stop['x'] + stop['width'] / 2, stop['y'] + stop['height'] / 2)
    page.mouse.down()
    clicked = time.time()
    page.mouse.up()
    machine.client.wait(
        'the stop', lambda: machine.client.machine_state.message == 'stopped', 10.0
    )
    reported, taken = time.time() - clicked, machine.seconds_to_rest(clicked)
    print(f'STOP: board stopped {reported:.3f} s after the click, servos moved to {taken:.3f} s')
    assert max(taken, reported) < 1.0


@pytest.mark.parametrize('path', ['', '/joystick'])
def test_other_sites_are_turned_away(panel, two_pages, path):
    url = panel_address(panel).replace('http', 'ws') + path
    with pytest.raises(InvalidStatus, match='403'):
        connect(url, origin='http://elsewhere.example')


def test_topics_are_those_of_the_document(two_pages, user, interfaces):
    user.wait(
        'its subscriptions', lambda: ('in', 'setpoint') in interfaces.running(user, 'panel'), 10.0
    )
    assert interfaces.running(user, 'panel') == interfaces.documented('panel')


def test_closing_the_page_while_jogging_stops(two_pages, machine):
    page = two_pages.pop()
    jog(page, machine, '#move', (-0.12, 0.0), 1, JOG)
    closed = time.time()
    page.close()
    assert machine.seconds_to_rest(closed) < 1.5
