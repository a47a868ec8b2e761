"""What the hexapod's page shows, what its sliders and STOP do, and who may open it."""

import os
import signal
from http.client import HTTPConnection
from urllib.parse import urlsplit

import numpy as np
import pytest
from PIL import Image

from hexarm.panel_process import panel_address
from manipulator.pose import Pose

pytestmark = pytest.mark.graph

PICTURED = Pose.from_xyz_rpy((0.006, -0.004, 0.0455), (0.05, 0.09, -0.03))


def test_sliders_move_the_machine_and_all_pages_show_it(two_pages, machine):
    page, other = two_pages
    thumb = page.page.get_by_role('slider').nth(1)
    thumb.focus()
    for _ in range(30):
        page.page.keyboard.press('ArrowRight')
    machine.client.wait('2 mm along x', lambda: machine.has_moved(0, 0.002), 20.0)
    machine.client.wait('the other page', lambda: page.values() == other.values(), 20.0)
    assert 2.0 <= float(other.values()[1]) <= 3.0


def test_stop_stops_the_machine_and_nothing_resumes(page, machine):
    print(f'STOP: the servos stood {machine.seconds_to_stop(page):.3f} s after the press')


def test_a_node_that_does_not_answer_is_named(page, machine, hexapod_graph):
    machine_process = hexapod_graph.pids()['machine']
    os.kill(machine_process, signal.SIGSTOP)
    try:
        page.page.get_by_role('button', name='Home').click()
        page.page.get_by_text('trajectory/home: no answer within').wait_for()
    finally:
        os.kill(machine_process, signal.SIGCONT)
        machine.client.spin(1.0)  # it takes the machine over anew


def test_other_sites_are_turned_away(panel, two_pages):
    assert [opened(panel, path, 'http://elsewhere.example') for path in ('/', '/joystick')] == [
        403,
        403,
    ]
    assert opened(panel, '/joystick', panel_address(panel)) == 101


def opened(panel, path, origin):
    """What the panel answers to a script of some site that asks for a connection."""
    connection = HTTPConnection(urlsplit(panel_address(panel)).netloc, timeout=10)
    connection.putrequest('GET', path)
    words = {'Upgrade': 'websocket', 'Connection': 'Upgrade', 'Origin': origin}
    words |= {'Sec-WebSocket-Key': 16 * 'a' + 6 * 'A' + '==', 'Sec-WebSocket-Version': '13'}
    for name, value in words.items():
        connection.putheader(name, value)
    connection.endheaders()
    status = connection.getresponse().status
    connection.close()
    return status


def test_topics_are_those_of_the_document(two_pages, user, interfaces):
    user.wait(
        'its subscriptions', lambda: ('in', 'setpoint') in interfaces.running(user, 'panel'), 10.0
    )
    assert interfaces.running(user, 'panel') == interfaces.documented('panel')


def test_the_page_is_worth_a_picture(open_page, panel, machine, tmp_path):
    """The picture of README.md and docs/panel.md, kept where WRITE_SCREENSHOT says."""
    path = os.environ.get('WRITE_SCREENSHOT') or str(tmp_path / 'panel.png')
    shown = open_page(panel, (1280, 760), pixels=1.0)
    machine.client.trigger('trajectory/start_cycle')
    machine.client.spin(3.0)
    machine.client.trigger('trajectory/stop')
    machine.client.wait('rest', lambda: machine.client.motion('mode') == 'hold', 10.0)
    machine.client.go_to(PICTURED)
    close_notes(shown.page)
    machine.client.spin(5.0)
    shown.page.screenshot(path=path)
    shown.page.close()
    colours = np.asarray(Image.open(path).convert('RGB'), dtype=int).reshape(-1, 3)
    red, green, blue = colours.T
    scene = {'green legs': green - red > 40, 'an amber leg': (red - blue > 60) & (green > 120)}
    scene |= {'STOP': (red > 180) & (green < 80), 'the platform': blue - red > 50}
    shares = {what: np.mean(which) for what, which in scene.items()}
    assert all(share > 0.001 for share in shares.values()), shares


def close_notes(page):
    """Browsers without a graphics card are told so by viser, in a corner of the page."""
    for button in page.locator('.mantine-Notification-closeButton').all():
        button.click()
