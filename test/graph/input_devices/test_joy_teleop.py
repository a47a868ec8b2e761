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
        self._publisher = publisher
        self._sent = 0

    def send(self, tremor=True):
        self._sent += 1
        axes = list(self.axes)
        axes[7] = 0.001 * (self._sent % 2) if tremor else 0.0
        self.publish(axes, self.buttons)

    def publish(self, axes, buttons):
        message = Joy(axes=axes, buttons=buttons)
        message.header.stamp = self.listener.node.get_clock().now().to_msg()
        self._publisher.publish(message)
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
        self.axes[:6] = [0.0, 0.0, 1.0, 0.0, 0.0, 1.0]
        self.buttons[:] = [0] * 11
        self.send_for(0.1)
        self.listener.spin(0.1)
        self.listener.twists.clear()

    def drive(self):
        """Holds the deadman and pushes along x until twists come."""
        self.hold_until(lambda: self.last == (0.05, 0, 0, 0, 0, 0), LB, x=1.0)

    def hold_until(self, is_so, *buttons, x=0.0):
        """Presses and pushes; after a stall of this machine the pad must come to rest first."""
        end = time.monotonic() + PATIENCE
        while not is_so():
            assert time.monotonic() < end, f'buttons {buttons} had no effect'
            self.rest()
            for button in buttons:
                self.buttons[button] = 1
            self.axes[1] = x
            for _ in range(25):
                self.send()
                if is_so():
                    return

    @property
    def last(self):
        return self.listener.twists[-1][0] if self.listener.twists else None


@pytest.fixture(scope='module')
def connected(running, listening):
    with running('joy_teleop', NAMESPACE), listening(NAMESPACE, 'joy') as listener:
        publisher = listener.joy_publisher(Joy, 'joy')
        pad = Pad(listener, publisher)

        def press_stop():
            pad.buttons[STOP] ^= 1
            return 'stop' in listener.asked

        pad.send_until('the services', press_stop)
        yield listener, publisher


@pytest.fixture
def pad(connected):
    pad = Pad(*connected)
    listener = pad.listener
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
    pad.axes[6] = -1.0
    pad.send_until('another mode', lambda: pad.listener.modes[-1] == 'hold_orientation')


def test_stop_asks_the_trajectory_node_once(pad):
    pad.drive()
    pad.listener.asked.clear()
    pad.buttons[STOP] = 1
    pad.send_until('stop', lambda: 'stop' in pad.listener.asked)
    pad.send_for(LONG_ENOUGH)
    assert pad.listener.asked == ['stop']
    assert is_zero(pad)


def test_home_is_asked_while_held_and_stopped_at_release(pad):
    pad.listener.asked.clear()
    pad.buttons[HOME] = 1
    pad.send_until('home', lambda: pad.listener.asked)
    pad.send_for(0.2)
    assert pad.listener.asked == ['home']
    pad.buttons[HOME] = 0
    pad.send_until('stop', lambda: len(pad.listener.asked) > 1)
    assert pad.listener.asked == ['home', 'stop']


def test_gripper_closes_while_button_and_deadman_are_held(pad):
    pad.hold_until(lambda: len(pad.listener.openings) > 3, LB, CLOSE)
    assert pad.listener.openings == sorted(pad.listener.openings, reverse=True)
    assert 0.0 <= pad.listener.openings[-1] < 0.5


def test_zero_is_the_last_word_of_a_node_that_is_ended(running, listening):
    namespace = f'{NAMESPACE}_ended'
    with (
        running('joy_teleop', namespace) as process,
        listening(namespace, 'joy') as listener,
    ):
        pad = Pad(listener, listener.joy_publisher(Joy, 'joy'))
        topic = f'/{namespace}/cmd_vel/joy'
        listener.wait('twists', lambda: listener.node.count_publishers(topic), PATIENCE)
        pad.rest()
        pad.drive()
        process.send_signal(signal.SIGINT)
        pad.send_until('the zero', lambda: is_zero(pad))
        assert process.wait(60) == 0


def test_unknown_gamepad_is_one_line_and_status_1(refusal):
    status, said = refusal('joy_teleop', gamepad='xbix')
    assert status == 1
    assert "did you mean 'xbox'" in said
    assert len(said.splitlines()) == 1
