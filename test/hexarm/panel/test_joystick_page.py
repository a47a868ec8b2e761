"""The joystick in a real browser, on the panel's server: whatever takes the hand away ends it.

No graph: `hand` asks what the panel's node asks, the stick that is held now.
"""

import re
import time

import numpy as np
import pytest

from hexarm.panel.nodes.web_server import (
    CONTROLS_PATH,
    JOYSTICK_PATH,
    ControlsSocket,
    JoystickSocket,
    start_server,
    stop_server,
)

PATIENCE = 60.0
FORWARD, BACKWARD, UPWARD = (0.0, 0.5), (0.0, -0.5), (0.0, 0.3)
X, Z = 0, 2
HELD, FREE, TAKEN = 'moving while you hold', 'drag to move', 'another page has the joystick'


class Hand:
    """One open page, and a hand on its joystick."""

    def __init__(self, tab, panel):
        self.tab = tab
        self._panel = panel
        self.frame = tab.frame_locator('#joystick')
        self.session = tab.context.new_cdp_session(tab)
        self._has_finger = False

    def says(self, *words):
        """Waits until the line below the joystick says one of them."""
        self.frame.locator('#said').get_by_text(re.compile('|'.join(words))).wait_for()

    def point(self, pad, push=(0.0, 0.0)):
        """On the page, in pixels; `push` is right, up in shares of half a pad."""
        box = self.frame.locator(pad).bounding_box()
        half = np.array([box['width'], box['height']]) / 2
        x, y = np.array([box['x'], box['y']]) + half + half * [push[0], -push[1]]
        return {'x': x, 'y': y}

    def press(self, pad, push):
        """Presses the mouse on a pad and pushes it."""
        self.tab.bring_to_front()
        self.tab.mouse.move(**self.point(pad))
        self.tab.mouse.down()
        self.tab.mouse.move(**self.point(pad, push))

    def let_go(self):
        self.tab.mouse.up()

    def touch(self, kind, *points):
        self._has_finger = bool(points)
        self.session.send('Input.dispatchTouchEvent', {'type': kind, 'touchPoints': points})

    def finger(self, pad, push):
        """Puts a finger on a pad and pushes it."""
        self.touch('touchStart', self.point(pad))
        self.touch('touchMove', self.point(pad, push))

    def lift(self):
        if self._has_finger:
            self.touch('touchEnd')

    def drive(self, press, let_go, axis, sign):
        """Presses until the stick is held; again where this computer was too busy for a press."""
        give_up = time.monotonic() + PATIENCE
        while time.monotonic() < give_up:
            press()
            until = time.monotonic() + 2.0
            while time.monotonic() < until:
                if self._panel.is_held(axis, sign):
                    return
                self.tab.wait_for_timeout(10)
            let_go()
        raise AssertionError('the joystick was never held')

    def freeze(self, ms):
        """The page's thread computes for so long."""
        self.tab.evaluate('(ms) => { const end = Date.now() + ms; while (Date.now() < end); }', ms)


class Panel:
    """The panel's server with nothing but the joystick on its page."""

    def __init__(self, browser, port):
        self._browser = browser
        self._socket = JoystickSocket(lambda: '')
        nobody = ControlsSocket('{"machine": null}', lambda request: None)
        handlers = {JOYSTICK_PATH: self._socket.serve, CONTROLS_PATH: nobody.serve}
        self._server = start_server('127.0.0.1', port, 'joystick', handlers)

    def open_page(self):
        tab = self._browser.new_context(has_touch=True).new_page()
        tab.set_default_timeout(1000 * PATIENCE)
        tab.goto(f'http://127.0.0.1:{self._server.get_port()}/?fixedDpr=0.1')
        hand = Hand(tab, self)
        hand.says(FREE)
        return hand

    def stick(self):
        return self._socket.stick()

    def is_held(self, axis, sign):
        stick = self.stick()
        return stick is not None and stick[axis] * sign > 0.1

    def is_let_go(self):
        """Waits until nothing is held."""
        give_up = time.monotonic() + PATIENCE
        while self.stick() is not None and time.monotonic() < give_up:
            time.sleep(0.01)
        return self.stick() is None

    def stays_let_go(self, seconds=0.7):
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            if self.stick() is not None:
                return False
            time.sleep(0.01)
        return True

    def close(self):
        stop_server(self._server)


@pytest.fixture(scope='module')
def panel(browser, worker):
    panel = Panel(browser, 9500 + worker)
    yield panel
    panel.close()


@pytest.fixture(scope='module')
def pages(panel):
    return [panel.open_page() for _ in range(2)]


@pytest.fixture
def hand(pages):
    """The first page; whatever a test left on it is taken away."""
    yield pages[0]
    for page in pages:
        page.let_go()
    pages[0].lift()


def push(hand, pad, push, axis):
    """Holds the mouse on a pad until the panel knows."""
    hand.drive(lambda: hand.press(pad, push), hand.let_go, axis, np.sign(push[1]))


def finger(hand, pad, push, axis):
    """Holds a finger on a pad until the panel knows."""
    hand.drive(lambda: hand.finger(pad, push), hand.lift, axis, np.sign(push[1]))


def test_release_ends_it(panel, hand):
    push(hand, '#move', FORWARD, X)
    hand.says(HELD, 'press again')  # a page that has stood still since then has lost it
    hand.let_go()
    assert panel.is_let_go()
    hand.says(FREE)


def test_a_window_that_loses_the_focus_ends_it(panel, hand):
    emulation = 'Emulation.setFocusEmulationEnabled'
    hand.session.send(emulation, {'enabled': False})  # as outside of tests
    push(hand, '#move', FORWARD, X)
    another = hand.tab.context.new_page()
    assert panel.is_let_go()
    another.close()
    hand.session.send(emulation, {'enabled': True})


@pytest.mark.parametrize('end', ['touchEnd', 'touchCancel'])
def test_a_touch_that_ends_or_is_taken_away_ends_it(panel, hand, end):
    finger(hand, '#move', FORWARD, X)
    hand.touch(end)
    assert panel.is_let_go()
    hand.says(FREE)


def test_a_page_that_stands_still_ends_it_for_good(panel, hand):
    push(hand, '#lift', UPWARD, Z)
    hand.freeze(800)
    hand.says('press again')
    assert panel.stays_let_go()
    hand.let_go()
    push(hand, '#lift', BACKWARD, Z)


def test_a_new_press_moves_while_a_finger_of_an_ended_one_is_still_down(panel, hand):
    finger(hand, '#lift', UPWARD, Z)
    hand.freeze(800)
    hand.says('press again')
    push(hand, '#move', FORWARD, X)
    assert panel.stick()[Z] == 0.0, 'the old finger moves it'


def test_two_pages_do_not_fight(panel, hand, pages):
    second = pages[1]

    def keeps_it():
        """Whether the first page has it still; not where it stood still meanwhile."""
        hand.let_go()
        second.let_go()
        second.says(FREE)
        push(hand, '#move', FORWARD, X)
        second.press('#move', BACKWARD)
        second.says(TAKEN, HELD)
        return panel.is_held(X, 1)

    assert any(keeps_it() for _ in range(5))
    hand.let_go()
    assert panel.is_let_go()
    assert panel.stays_let_go()
    second.let_go()
    push(second, '#move', BACKWARD, X)


def test_closing_the_page_ends_it(panel, browser):
    page = panel.open_page()
    push(page, '#move', FORWARD, X)
    page.tab.close()
    assert panel.is_let_go()
