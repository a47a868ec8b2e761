"""The shipped joy_teleop process between Joy messages and twists.

What every trouble of a pad does, test/manipulator/teleop tries; here each way out of the node.
"""

import signal
import time

import pytest
from sensor_msgs.msg import Joy

pytestmark = pytest.mark.graph
NAMESPACE = 'joysticks'
LB, STOP, HOME, CLOSE = 4, 1, 7, 0
PATIENCE = 60.0
LONG_ENOUGH = 0.5
"""Seconds in which a node that still sent twists would have sent a score of them."""


class Pad:
    """Sends Joy as a driver does: all the time, with a thumb that trembles or does not."""

    def __init__(self, listener, publisher):
        self.listener = listener
        self.axes = [0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0]
        self.buttons = [0] * 11
        self.publisher = publisher
        self._sent = 0

    def send(self, tremor=True):
        self._sent += 1
        axes = list(self.axes)
        axes[7] = 0.001 * (self._sent % 2) if tremor else 0.0
        self.publish(axes, self.buttons)

    def publish(self, axes, buttons):
        message = Joy(axes=axes, buttons=buttons)
        message.header.stamp = self.listener.node.get_clock().now().to_msg()
        self.publisher.publish(message)
        self.listener.spin(0.02)

    def send_until(self, what, is_so, tremor=True):
        end = time.monotonic() + PATIENCE
        while not is_so():
            assert time.monotonic() < end, what
            self.send(tremor)

    def send_for(self, seconds, tremor=True):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.send(tremor)

    def rest(self):
        self.axes[:7] = [0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0]
        self.buttons[:] = [0] * 11
        self.send_for(0.1)
        self.listener.spin(0.1)
        self.listener.twists.clear()
        self.listener.asked.clear()

    def drive(self):
        """Holds the deadman and pushes along x until twists come."""
        self.hold_until(lambda: self.last == (0.05, 0, 0, 0, 0, 0), LB, x=1.0)

    def hold_until(self, is_so, *buttons, x=0.0, cross=0.0):
        """Presses and pushes; after a stall of this machine the pad must come to rest first."""
        end = time.monotonic() + PATIENCE
        while not is_so():
            assert time.monotonic() < end, f'buttons {buttons} had no effect'
            self.rest()
            for button in buttons:
                self.buttons[button] = 1
            self.axes[1], self.axes[6] = x, cross
            for _ in range(25):
                self.send()
                if is_so():
                    return

    @property
    def last(self):
        return self.listener.twists[-1][0] if self.listener.twists else None


@pytest.fixture(scope='module')
def connected(running, listening):
    with running('joy_teleop', NAMESPACE) as process, listening(NAMESPACE, 'joy') as listener:
        publisher = listener.joy_publisher(Joy, 'joy')
        pad = Pad(listener, publisher)

        def press_stop():
            pad.buttons[STOP] ^= 1
            return 'stop' in listener.asked

        pad.send_until('the services', press_stop)
        yield listener, publisher, process


@pytest.fixture
def pad(connected):
    listener, publisher, _ = connected
    pad = Pad(listener, publisher)
    ready = 'a publisher of twists'
    topic = f'/{NAMESPACE}/cmd_vel/joy'
    listener.wait(ready, lambda: listener.node.count_publishers(topic) > 0, PATIENCE)
    pad.rest()
    return pad


def assert_one_zero_then_silence(pad):
    """Of all twists that came, the last is the only zero, and nothing follows it."""
    numbers = [twist for twist, _ in pad.listener.twists]
    assert numbers[-1] == (0.0,) * 6
    assert numbers.count((0.0,) * 6) == 1
    before = len(numbers)
    pad.send_for(LONG_ENOUGH, tremor=False)
    assert len(pad.listener.twists) == before


def is_zero(pad):
    return pad.last == (0.0,) * 6


def test_release_sends_one_zero_and_then_nothing(pad):
    pad.drive()
    pad.buttons[LB] = 0
    pad.send_until('the zero', lambda: is_zero(pad))
    assert_one_zero_then_silence(pad)


def test_zero_follows_when_messages_cease(pad):
    pad.drive()
    pad.listener.wait('the zero', lambda: is_zero(pad))
    before = len(pad.listener.twists)
    pad.listener.spin(LONG_ENOUGH)
    assert len(pad.listener.twists) == before
    pad.send_for(LONG_ENOUGH)
    assert len(pad.listener.twists) == before
    name = f'{NAMESPACE}/joy_teleop'
    pad.listener.wait(
        'a warning',
        lambda: (
            'no message for' in pad.listener.diagnostics[name].message
            if name in pad.listener.diagnostics
            else False
        ),
    )
    pad.rest()
    pad.drive()


def test_first_mode_is_known_to_late_listeners_and_the_cross_changes_it(pad):
    pad.listener.wait('the first mode', lambda: pad.listener.modes, PATIENCE)
    pad.hold_until(lambda: 'hold_orientation' in pad.listener.modes, cross=-1.0)


def test_stop_asks_the_trajectory_node_once(pad):
    pad.drive()
    asked = pad.listener.asked
    pad.hold_until(lambda: 'stop' in asked, STOP)
    before = len(asked)
    pad.send_for(LONG_ENOUGH)
    assert len(asked) == before


def test_home_is_asked_while_held_and_stopped_at_release(pad):
    asked = pad.listener.asked
    pad.hold_until(lambda: 'home' in asked, HOME)
    before = asked.count('home')
    pad.send_for(0.2)
    assert asked.count('home') == before
    pad.buttons[HOME] = 0
    pad.send_until('stop', lambda: asked[-1] == 'stop')


def test_gripper_closes_while_button_and_deadman_are_held(pad):
    pad.hold_until(lambda: len(pad.listener.openings) > 3, LB, CLOSE)
    assert pad.listener.openings == sorted(pad.listener.openings, reverse=True)
    assert 0.0 <= pad.listener.openings[-1] < 0.5


def test_a_stop_that_is_refused_becomes_an_emergency_stop(pad):
    pad.listener.obeys = False
    pad.hold_until(lambda: pad.listener.stops, STOP)
    pad.listener.obeys = True
    assert pad.listener.stops[0]


def test_a_second_pad_stops_all_twists_until_it_has_gone_and_the_first_was_released(pad):
    listener = pad.listener
    second = Pad(listener, listener.joy_publisher(Joy, 'joy'))
    second.buttons[LB], second.axes[1] = 1, 1.0

    def both(is_so):
        pad.send()
        second.send()
        return is_so()

    def text():
        status = listener.diagnostics.get(f'{NAMESPACE}/joy_teleop')
        return status.message if status else ''

    for words in ('more than one publisher', '2 publishers on joy'):
        listener.wait(words, lambda w=words: both(lambda: w in text()))
    assert f'/{NAMESPACE}/hexarm' in text()
    pad.buttons[LB], pad.axes[1] = 1, 1.0
    pad.send_for(LONG_ENOUGH)
    assert listener.twists == []
    listener.node.destroy_publisher(second.publisher)
    pad.drive()


def test_unknown_gamepad_is_one_line_and_status_1(refusal):
    status, text = refusal('joy_teleop', gamepad='xbix')
    assert status == 1
    assert "did you mean 'xbox'" in text
    assert len(text.splitlines()) == 1


def test_zero_is_the_last_word_of_a_node_that_is_ended(pad, connected):
    """Keep it last: it ends the shared process."""
    process = connected[2]
    pad.drive()
    process.send_signal(signal.SIGINT)
    pad.send_until('the zero', lambda: is_zero(pad))
    assert process.wait(60) == 0
