"""The panel's page in a real browser, and what sees the machine move, for any machine."""

import contextlib
import time
from dataclasses import replace

import numpy as np
import pytest
from geometry_msgs.msg import PoseStamped, TwistStamped
from playwright.sync_api import Error
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState

from hexarm.panel_process import panel_address
from manipulator.errors import Refused, Stopped
from manipulator.nodes.messages import pose_of, seconds

SMALL = 0.1
"""Share of the pixels: a machine without a graphics card draws them all by itself."""

PATIENCE = 180_000
"""Milliseconds: a page without a graphics card beside a busy graph takes most of a minute."""
GIVE_UP = 600.0
"""Seconds, after which asking again has no use."""
SHORTLY = 15_000
"""Milliseconds for what the page may have disabled; it is then tried again."""
CYCLED = 3e-3
"""Metres from home that tell a cycle from standing still."""
MOVING = 3e-4
"""Radians between two reports of a servo's true angle, 20 ms apart, from which it moves."""

HELD = 'moving while you hold'


def circling(nodes, cycle):
    """The same processes; the trajectory node has other parameters for its cycle."""
    return [
        replace(node, parameters=node.parameters | cycle) if node.name == 'machine' else node
        for node in nodes
    ]


@pytest.fixture(scope='module')
def with_cycle():
    return circling


@pytest.fixture(scope='module')
def open_page(browser):
    """Opens the page of a panel, with few pixels where nobody looks at them."""

    def opened(panel, size=(1000, 760), pixels=SMALL):
        view = {'width': size[0], 'height': size[1]}
        page = browser.new_context(viewport=view, has_touch=True).new_page()
        page.set_default_timeout(PATIENCE)
        page.goto(f'{panel_address(panel)}/?fixedDpr={pixels}')
        found = PanelPage(page)
        found.says('drag to move')
        return found

    return opened


@pytest.fixture(scope='module')
def seen():
    """Makes what sees a machine from outside."""
    return Seen


class PanelPage:
    """One open page, and the hand on it."""

    def __init__(self, page):
        self.page = page
        self.let_go = page.mouse.up
        page.evaluate(
            "addEventListener('pointerdown', (event) => {"
            ' window.pressedAt = performance.timeOrigin + event.timeStamp; }, true)'
        )

    @property
    def said(self):
        """The line below the joystick."""
        return self.page.frame_locator('#joystick').locator('#said').inner_text()

    def says(self, words):
        """Waits until the joystick says so."""
        self.page.frame_locator('#joystick').get_by_text(words).wait_for()

    def show(self, tab):
        """Opens one of the tabs."""
        self.page.get_by_role('tab', name=tab).click()

    def field(self, label):
        """The number beside the slider of this label."""
        return self.page.get_by_role('spinbutton', name=label)

    def value(self, label):
        """What stands in it."""
        return float(self.field(label).input_value() or 'nan')

    def type(self, label, text):
        """Types into it, where the machine takes goals: else the page has it disabled."""
        box = self.field(label)
        with contextlib.suppress(Error):
            box.fill(text, timeout=SHORTLY)
            box.press('Enter')

    def press(self, name):
        """Presses the first button of this name, where the page lets one."""
        with contextlib.suppress(Error):
            self.page.get_by_role('button', name=name).first.click(timeout=SHORTLY)

    def may_say(self, notice):
        """Waits a while for something on the page."""
        with contextlib.suppress(Error):
            notice.wait_for(timeout=SHORTLY)

    def centre(self, pad):
        """Of a pad of the joystick, on the page, and half of its width and height."""
        box = self.page.frame_locator('#joystick').locator(pad).bounding_box()
        right, up = box['width'] / 2, box['height'] / 2
        return np.array([box['x'] + right, box['y'] + up]), np.array([right, up])

    def hold(self, pad, right, up):
        """Presses the mouse on a pad of the joystick and pushes it."""
        self.page.bring_to_front()
        self.page.locator('#panel').evaluate('panel => panel.scrollTo(0, 0)')
        centre, half = self.centre(pad)
        self.page.mouse.move(*centre)
        self.page.mouse.down()
        self.page.mouse.move(*(centre + half * [right, -up]))

    def press_stop(self):
        """Presses STOP and stays on it; when the browser had the press, in s (time.time)."""
        button = self.page.locator('#stop').bounding_box()
        self.page.mouse.move(button['x'] + button['width'] / 2, button['y'] + button['height'] / 2)
        self.page.mouse.down()
        return self.page.evaluate('pressedAt') / 1000


class Seen:
    """What a machine does, with the time on this computer's clock; at home and able to move."""

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

    def __enter__(self):
        self.begin()
        return self

    def __exit__(self, *exception):
        for subscription in self._subscriptions:
            self.client.node.destroy_subscription(subscription)

    def begin(self):
        """Home again; what was heard before is forgotten."""
        self.client.make_ready()
        self.client.wait_driven('rest', lambda: self.client.motion('mode') == 'hold')
        self.client.reach_home()
        self.client.spin(0.3)
        self.twists.clear()
        self.client.wait('poses', lambda: self.poses, 10.0)
        self.start = self.poses[-1]

    def way(self):
        """How far it has come since it began, in x, y, z."""
        return self.poses[-1].position - self.start.position

    def has_moved(self, axis, metres):
        return self.way()[axis] * np.sign(metres) > abs(metres)

    def go_to(self, pose):
        """Asks the machine to; a page that is behind may ask it for something else."""
        with contextlib.suppress(Refused, Stopped):
            self.client.reach(pose)

    def jog(self, page, pad, push, axis, metres):
        """Holds the page's joystick until it has moved so far.

        A computer that is too busy to draw the page loses the press, as it should: then again.
        """
        give_up = time.monotonic() + GIVE_UP
        while time.monotonic() < give_up:
            self.client.make_ready()
            page.hold(pad, *push)
            self.client.spin(0.3)
            while not self.has_moved(axis, metres) and page.said == HELD:
                self.client.spin(0.1)
            if self.has_moved(axis, metres):
                return
            page.let_go()
        raise AssertionError(f'{page.said}; it moved by {self.way()}')

    def seconds_to_rest(self, since):
        """From a moment (time.time) until the joints, which moved, stand still; waits for that."""
        self.client.wait('rest', lambda: self._rests(since))
        times, steps = self._steps()
        return times[steps > MOVING][-1] - since

    def _rests(self, since):
        """Whether nothing has moved in the last half second, all of it after that moment."""
        self.client.spin(0.2)
        times, steps = self._steps()
        is_late = times[-1] > since + 0.5
        return is_late and steps[times > times[-1] - 0.5].max(initial=0.0) <= MOVING

    def _steps(self):
        """When the joints were told, and how far one had moved since they were told before."""
        times = np.array([seconds(m.header.stamp) for m in self.joints])
        joints = np.array([m.position for m in self.joints])
        return times[1:], np.abs(np.diff(joints, axis=0)).max(axis=1)

    def seconds_to_stop(self, page):
        """From a press on STOP of the page until a machine on its cycle stands still."""
        self.client.persist(self._cycle)
        taken = self.seconds_to_rest(page.press_stop())
        self.client.wait_for_state('stopped')
        page.let_go()
        self.client.spin(0.3)  # the release says STOP once more
        return taken

    def asked_until(self, ask, is_so):
        """Asks the page again every few seconds: one that is behind takes it back."""
        end = time.monotonic() + GIVE_UP
        while not is_so():
            assert time.monotonic() < end, f'{self.client.summary}; it moved by {self.way()}'
            self.client.make_ready()
            ask()
            until = time.monotonic() + 5.0
            while not is_so() and time.monotonic() < until:
                self.client.spin(0.1)

    def start_cycle(self):
        """From home, also where it was lost on its way, or a page that is behind moved it."""

        def ask():
            with contextlib.suppress(Refused, Stopped):
                self.client.home()
                self.client.trigger('trajectory/start_cycle')

        self.asked_until(ask, lambda: self.client.motion('mode') == 'cycle')

    def _cycle(self):
        self.begin()
        self.start_cycle()
        self.client.wait('motion', lambda: np.abs(self.way()).max() > CYCLED)
        self.client.spin(1.0)
