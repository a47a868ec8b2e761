"""The page in a real browser, on a desk and on a phone; the states that it shows are made up."""

import json
import time

import pytest

from hexarm.machines import load
from hexarm.panel.nodes.web_server import (
    CONTROLS_PATH,
    JOYSTICK_PATH,
    ControlsSocket,
    JoystickSocket,
    start_server,
    stop_server,
)
from hexarm.panel.page_state import Controls, machine_text, state_text
from hexarm.panel.view import View

DESK, PHONE = (1280, 760), (390, 844)
TOUCH = 44
"""Pixels that a finger needs."""
LONG = 'leg 5: rod too short by 22.8 mm (58 mm, needs 80.8 mm for this pose), leg 6 as well ' * 3
PATIENCE = 60.0


class Shown:
    """The server of a page without a machine, and what the page asked of it."""

    def __init__(self, port):
        self.machine = load('robocake')
        self.requests = []
        self.socket = ControlsSocket(machine_text(self.machine, 'robocake · /hexapod', True),
                                     self.requests.append)  # fmt: skip
        self.show(machine_state='enabled', mode='hold')
        joystick = JoystickSocket(lambda: '')
        handlers = {JOYSTICK_PATH: joystick.serve, CONTROLS_PATH: self.socket.serve}
        self.server = start_server('127.0.0.1', port, 'page', handlers)

    def show(self, notice='', **known):
        controls = Controls.at(self.machine.kinematics.home)
        self.socket.texts['state'] = state_text(View(**known), controls, notice)

    def wait_for(self, do):
        end = time.monotonic() + PATIENCE
        while not any(request.do == do for request in self.requests):
            assert time.monotonic() < end, f'no {do}'
            time.sleep(0.01)


@pytest.fixture(scope='module')
def shown(worker):
    shown = Shown(9600 + worker)
    yield shown
    stop_server(shown.server)


@pytest.fixture(scope='module')
def open_page(browser, shown):
    def opened(size):
        view = {'width': size[0], 'height': size[1]}
        tab = browser.new_context(viewport=view, has_touch=True).new_page()
        tab.set_default_timeout(1000 * PATIENCE)
        # The machine in 3D is another page's matter: without a graphics card it takes long.
        tab.route('**/index.html*', lambda route: route.fulfill(body='<canvas></canvas>'))
        tab.goto(f'http://127.0.0.1:{shown.server.get_port()}/')
        tab.locator('#state').get_by_text('enabled').wait_for()
        return tab

    return opened


@pytest.fixture(scope='module')
def phone(open_page):
    return open_page(PHONE)


@pytest.fixture(scope='module')
def desk(open_page):
    return open_page(DESK)


@pytest.fixture(params=['phone', 'desk'])
def page(request, browser, shown):
    """Each page once it shows what a test begins with. `browser`: test/conftest.py reads it."""
    page = request.getfixturevalue(request.param)
    shown.show(machine_state='enabled', mode='hold')
    page.locator('#state').get_by_text('enabled').wait_for()
    return page


def test_stop_stands_still_whatever_the_texts_are(page, shown):
    before = page.locator('#stop').bounding_box()
    joystick = page.locator('#joystick').bounding_box()
    shown.show(LONG, machine_state='stopped', machine_reason=LONG)
    page.locator('#state').get_by_text('stopped').wait_for()
    assert page.locator('#stop').bounding_box() == before
    assert page.locator('#joystick').bounding_box() == joystick
    shown.show(machine_state='enabled', mode='hold')
    page.locator('#state').get_by_text('enabled').wait_for()
    assert page.locator('#stop').bounding_box() == before


def test_stop_is_sent_on_press_and_stays_in_reach_when_scrolled(page, shown):
    page.locator('#panel').evaluate('panel => panel.scrollTo(0, panel.scrollHeight)')
    box = page.locator('#stop').bounding_box()
    assert 0 <= box['y'] <= page.viewport_size['height'] - TOUCH
    shown.requests.clear()
    page.mouse.move(box['x'] + box['width'] / 2, box['y'] + box['height'] / 2)
    page.mouse.down()
    shown.wait_for('stop')
    page.mouse.up()
    page.locator('#panel').evaluate('panel => panel.scrollTo(0, 0)')


def test_buttons_without_effect_are_disabled_and_the_next_step_is_offered(page, shown):
    assert page.locator('#drive').get_by_role('button', name='Enable', exact=True).is_disabled()
    shown.show(machine_state='disarmed')
    page.locator('#state').get_by_text('disarmed').wait_for()
    assert page.get_by_role('button', name='Home').is_disabled()
    assert page.get_by_role('spinbutton', name='x [mm]').is_disabled()
    shown.requests.clear()
    page.locator('#next').click()
    shown.wait_for('enable')
    shown.show(machine_state='enabled', mode='hold')
    page.locator('#state').get_by_text('enabled').wait_for()


def test_on_a_phone_the_machine_is_seen_and_fingers_find_everything(phone):
    scene = phone.locator('#scene').bounding_box()
    assert scene['width'] == PHONE[0]
    assert scene['height'] > 0.4 * PHONE[1]
    joystick = phone.locator('#joystick').bounding_box()
    assert joystick['y'] + joystick['height'] <= PHONE[1]
    for tab in phone.get_by_role('tab').all():
        tab.click()
        for target in phone.locator('main button:visible, main select:visible').all():
            assert target.bounding_box()['height'] >= TOUCH - 0.5, target.inner_text()
    assert phone.evaluate('document.documentElement.scrollWidth') <= PHONE[0]
    phone.get_by_role('tab', name='Drive').click()
    phone.locator('#fold').click()
    assert phone.locator('#scene').bounding_box()['height'] > 0.6 * PHONE[1]
    assert phone.locator('#stop').is_visible()
    phone.locator('#fold').click()


def test_a_slider_a_key_and_a_number_ask_for_one_thing_each(desk, shown):
    shown.requests.clear()
    desk.get_by_role('spinbutton', name='z [mm]').fill('47.5')
    desk.keyboard.press('Enter')
    shown.wait_for('goal')
    assert (shown.requests[0].axis, shown.requests[0].value) == (2, pytest.approx(0.0475))
    desk.get_by_role('tab', name='Joints').click()
    shown.requests.clear()
    desk.get_by_role('button', name='crank_2 +').click()
    shown.wait_for('joint')
    assert shown.requests[0].name == 'crank_2'
    desk.get_by_role('tab', name='Drive').click()


def test_the_tab_has_the_machines_name(desk):
    assert desk.title() == 'robocake · /hexapod: enabled'


def test_a_text_of_the_graph_cannot_become_markup(desk, shown):
    shown.show(machine_state='fault', machine_reason='<img src=x onerror="document.title=1">')
    desk.locator('#state').get_by_text('fault').wait_for()
    assert '<img' in desk.locator('#reason').inner_text()
    assert json.dumps(desk.title()) != '"1"'
    shown.show(machine_state='enabled', mode='hold')
