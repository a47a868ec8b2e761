"""The page in a real browser, on a desk and on a phone; the states that it shows are made up.

Pictures of every tab are left in build/pages, for people to look at.
"""

import json
import time
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest

from hexarm.machines import find, load
from hexarm.panel.nodes.web_server import (
    CONTROLS_PATH,
    JOYSTICK_PATH,
    ControlsSocket,
    JoystickSocket,
    start_server,
    stop_server,
)
from hexarm.panel.page_state import Controls, machine_text, nodes_text, state_text
from hexarm.panel.scene import Scene
from hexarm.panel.view import NodeReport, Stance, View

DESK, PHONE = (1280, 760), (390, 844)
TOUCH = 44
"""Pixels that a finger needs."""
LONG = 'leg 5: rod too short by 22.8 mm (58 mm, needs 80.8 mm for this pose), leg 6 as well ' * 3
PATIENCE = 60.0
SIZES = {'desk': DESK, 'phone': PHONE}
PICTURES = Path(__file__).resolve().parents[3] / 'build' / 'pages'
TABS = ('Drive', 'Joints', 'Poses', 'Plots', 'Nodes', 'View')
TOOLS = 'tools: [{name: laser, xyz_mm: [0, 0, 20]}, {name: probe, xyz_mm: [0, 10, 20]}]\n'
LEGIBLE = 4.5
"""Contrast of text that WCAG 2 (AA) asks for; of controls that are disabled none."""
TARGETS = """(selector) => [...document.querySelectorAll(selector)]
  .filter((element) => element.offsetHeight && element.type !== 'checkbox')
  .map((element) => [[element.offsetWidth, element.offsetHeight],
                     element.ariaLabel || element.id || element.textContent])"""
"""Sizes and names of what is touched; a checkbox is its label's."""
CONTRASTS = """() => {
  const channel = (v) => v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
  const numbers = (text) => text.match(/[\\d.]+/g).map(Number);
  const light = ([r, g, b]) =>
    0.2126 * channel(r / 255) + 0.7152 * channel(g / 255) + 0.0722 * channel(b / 255);
  const behind = (element) => {
    for (; element; element = element.parentElement) {
      const colour = numbers(getComputedStyle(element).backgroundColor);
      if (colour.length < 4 || colour[3] > 0.99) return colour;
    }
    return [13, 17, 23];
  };
  const found = [];
  for (const element of document.querySelectorAll('body *')) {
    const is_text = (node) => node.nodeType === 3 && node.data.trim();
    const is_shown = element.offsetHeight && !element.disabled;
    if (!is_shown || ![...element.childNodes].some(is_text)) continue;
    const a = light(numbers(getComputedStyle(element).color)), b = light(behind(element));
    const contrast = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    found.push([contrast, element.textContent.trim().slice(0, 40)]);
  }
  return found;
}"""


class Shown:
    """The server of a page without a machine, and what the page asked of it."""

    def __init__(self, port, machine):
        self.machine = load(machine)
        self.requests = []
        words = machine_text(self.machine, f'{Path(machine).stem} · /hexapod', has_gripper=True)
        self.socket = ControlsSocket(words, self.requests.append)
        self.show(**self.usual())
        joystick = JoystickSocket(lambda: '')
        handlers = {JOYSTICK_PATH: joystick.serve, CONTROLS_PATH: self.socket.serve}
        self.server = start_server('127.0.0.1', port, 'page', handlers)

    def usual(self):
        home = self.machine.kinematics.home
        stance = Stance(home, self.machine.kinematics.inverse(home), 0.3)
        values = {'mode': 'hold', 'last_refusal': LONG, 'tool': 'probe'}
        nodes = (NodeReport('trajectory', 0, 'running', values, 0.1),)
        return {
            'machine_state': 'enabled', 'mode': 'hold', 'measured': stance, 'commanded': stance,
            'saved': {'above_cup': None, 'a' * 40: None}, 'nodes': nodes,
        }  # fmt: skip

    def show(self, notice='', **known):
        controls = Controls.at(self.machine.kinematics.home)
        view = View(frames=self.machine.frames, **known)
        self.socket.texts['state'] = state_text(view, controls, notice)
        self.socket.texts['nodes'] = nodes_text(view.nodes)

    def wait_for(self, do):
        end = time.monotonic() + PATIENCE
        while not any(request.do == do for request in self.requests):
            assert time.monotonic() < end, f'no {do}'
            time.sleep(0.01)


@pytest.fixture(scope='module')
def shown(worker, tmp_path_factory):
    path = tmp_path_factory.mktemp('page') / 'equipped.yaml'
    path.write_text(find('robocake').read_text() + TOOLS)
    shown = Shown(9600 + worker, str(path))
    yield shown
    stop_server(shown.server)


@pytest.fixture(scope='module')
def open_page(browser, shown):
    def opened(size):
        view = {'width': size[0], 'height': size[1]}
        tab = browser.new_context(viewport=view, has_touch=True).new_page()
        tab.set_default_timeout(1000 * PATIENCE)
        # The machine in 3D is another page's matter: without a graphics card it takes long.
        tab.route(
            '**/index.html*',
            lambda route: route.fulfill(body='<canvas>', content_type='text/html'),
        )
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
    shown.show(**shown.usual())
    page.locator('#state').get_by_text('enabled').wait_for()
    return page


def test_stop_stands_still_whatever_the_texts_are(page, shown):
    before = page.locator('#stop').bounding_box()
    joystick = page.locator('#joystick').bounding_box()
    shown.show(LONG, machine_state='stopped', machine_reason=LONG)
    page.locator('#state').get_by_text('stopped').wait_for()
    assert page.locator('#stop').bounding_box() == before
    assert page.locator('#joystick').bounding_box() == joystick
    shown.show(**shown.usual())
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


def test_a_question_without_an_answer_is_asked_again(desk, shown):
    shown.socket.texts['state'] = ''
    desk.locator('#state').get_by_text('no connection').wait_for()
    shown.show(**shown.usual())
    desk.locator('#state').get_by_text('enabled').wait_for()


def test_buttons_without_effect_are_disabled_and_the_next_step_is_offered(page, shown):
    assert page.locator('#drive').get_by_role('button', name='Enable', exact=True).is_disabled()
    shown.show(machine_state='disarmed')
    page.locator('#state').get_by_text('disarmed').wait_for()
    assert page.get_by_role('button', name='Home').is_disabled()
    assert page.get_by_role('spinbutton', name='x [mm]').is_disabled()
    shown.requests.clear()
    page.locator('#next').click()
    shown.wait_for('enable')
    shown.show(**shown.usual())
    page.locator('#state').get_by_text('enabled').wait_for()


def test_fingers_find_everything_in_every_tab(page):
    for frame in page.frames:
        if frame.url.endswith('joystick.html'):
            assert all(min(size) >= TOUCH for size, _ in frame.evaluate(TARGETS, '.pad, .slit'))
    for tab in TABS:
        page.get_by_role('tab', name=tab).click()
        for size, text in page.evaluate(TARGETS, 'main button, main select, main input, .check'):
            assert min(size) >= TOUCH, f'{tab}: {text}'
    width = page.viewport_size['width']
    assert page.evaluate('document.documentElement.scrollWidth') <= width
    page.get_by_role('tab', name='Drive').click()


def test_the_machine_is_seen_beside_everything(page):
    scene, window = page.locator('#scene').bounding_box(), page.viewport_size
    assert scene['width'] * scene['height'] > 0.4 * window['width'] * window['height']
    joystick = page.locator('#joystick').bounding_box()
    assert joystick['y'] + joystick['height'] <= window['height']


def test_the_panel_of_a_phone_folds_down_to_stop(phone):
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
    assert desk.title() == 'equipped · /hexapod: enabled'


def test_a_text_of_the_graph_cannot_become_markup(desk, shown):
    shown.show(machine_state='fault', machine_reason='<img src=x onerror="document.title=1">')
    desk.locator('#state').get_by_text('fault').wait_for()
    assert '<img' in desk.locator('#reason').inner_text()
    assert json.dumps(desk.title()) != '"1"'
    shown.show(**shown.usual())


@pytest.mark.parametrize('device', SIZES)
def test_every_tab_is_legible_and_its_picture_is_kept(browser, device, request, shown):
    page = request.getfixturevalue(device)
    shown.show(LONG, **shown.usual())
    page.locator('#state').get_by_text('enabled').wait_for()
    PICTURES.mkdir(parents=True, exist_ok=True)
    for tab in TABS:
        page.get_by_role('tab', name=tab).click()
        if tab == 'Nodes':
            page.locator('#nodes table').wait_for()
        page.screenshot(path=PICTURES / f'{device}-{tab.lower()}.png')
        panel = page.locator('#panel')
        width, whole = panel.evaluate('panel => [panel.clientWidth, panel.scrollWidth]')
        assert whole <= width, f'{tab}: cut off at the right'
        for frame in page.frames:
            for contrast, text in frame.evaluate(CONTRASTS):
                assert contrast > LEGIBLE, f'{tab}: {text!r} has a contrast of {contrast:.1f}'
    page.get_by_role('tab', name='Drive').click()


def test_a_tool_is_chosen_by_name_and_the_one_in_force_is_shown(page, shown):
    tool = page.locator('#tool')
    assert tool.locator('option').all_inner_texts() == ['none', 'laser', 'probe']
    page.wait_for_function("document.getElementById('tool').value === 'probe'")
    shown.requests.clear()
    tool.select_option('laser')
    shown.wait_for('tool')
    assert shown.requests[0].name == 'laser'
    page.wait_for_function("document.getElementById('tool').value === 'probe'")  # is not taken up


def test_an_old_refusal_fades_and_a_new_one_does_not(page, shown):
    shown.show('Home: refused once', **shown.usual())
    reason = page.locator('#reason')
    reason.get_by_text('refused once').wait_for()
    assert 'old' not in (reason.get_attribute('class') or '')
    page.evaluate('reasonAt -= OLD_MS')
    page.wait_for_function("document.getElementById('reason').classList.contains('old')")
    shown.show('Home: refused again', **shown.usual())
    reason.get_by_text('refused again').wait_for()
    assert 'old' not in (reason.get_attribute('class') or '')


@pytest.mark.long
@pytest.mark.parametrize('device', SIZES)
def test_an_arm_is_in_view_beside_its_controls(device, browser, worker):
    shown = Shown(9700 + worker, 'arm_6r')
    scene = Scene(shown.server, shown.machine, has_gripper=True)
    width, height = SIZES[device]
    page = browser.new_context(viewport={'width': width, 'height': height}).new_page()
    page.set_default_timeout(3000 * PATIENCE)
    path = PICTURES / f'{device}-arm.png'
    try:
        page.goto(f'http://127.0.0.1:{shown.server.get_port()}/?fixedDpr=0.5')
        end = time.monotonic() + 10 * PATIENCE
        while not is_in_view(page, path):
            assert time.monotonic() < end, f'no arm, or not all of it: {path}'
            scene.show(View(**shown.usual()))
    finally:
        page.context.close()
        stop_server(shown.server)


def is_in_view(page, path):
    """Whether the arm is drawn on the scene, large and whole; its picture is kept."""
    greens = green_points(page, path)
    if not greens.size:
        return False
    box = page.locator('#scene').bounding_box()
    low, high = greens.min(axis=0), greens.max(axis=0)
    ends = np.array([box['y'] + box['height'], box['x'] + box['width']])
    is_whole = (low > 5).all() and (high < ends - 5).all()
    return is_whole and high[0] - low[0] > 0.25 * box['height']


def green_points(page, path):
    """Rows and columns (n, 2) of the scene's picture where joints with room to spare are drawn."""
    path.parent.mkdir(parents=True, exist_ok=True)
    page.screenshot(path=path)
    box = page.locator('#scene').bounding_box()
    right, down = int(box['x'] + box['width']), int(box['y'] + box['height'])
    red, green, blue = np.moveaxis(matplotlib.image.imread(path)[:down, :right, :3], -1, 0)
    return np.argwhere((green > red + 0.2) & (green > blue + 0.05) & (blue > red))
