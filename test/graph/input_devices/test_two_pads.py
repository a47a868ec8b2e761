"""Two publishers on `joy`: the shipped joy_teleop process sends nothing, and says why."""

import pytest
from sensor_msgs.msg import Joy

pytestmark = pytest.mark.graph
NAMESPACE = 'two_pads'
LB = 4
AXES = [0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0]
PATIENCE = 60.0


class Pads:
    """A live pad and a frozen one, as two publishers of one node."""

    def __init__(self, listener):
        self.listener = listener
        self.live, self.frozen = (listener.joy_publisher(Joy, 'joy') for _ in range(2))
        self._sent = 0

    def send(self, publisher, x=0.0, is_held=False):
        self._sent += 1
        axes = [*AXES[:7], 0.001 * (self._sent % 2)]
        axes[1] = x
        message = Joy(axes=axes, buttons=[int(is_held and b == LB) for b in range(11)])
        message.header.stamp = self.listener.node.get_clock().now().to_msg()
        publisher.publish(message)
        self.listener.spin(0.01)

    def rest(self):
        self.send(self.live)

    def drive(self):
        self.send(self.live, x=1.0, is_held=True)

    def both(self):
        self.send(self.live)
        self.send(self.frozen, x=1.0, is_held=True)

    def send_until(self, what, send, is_so):
        self.listener.wait(what, lambda: send() or is_so(), PATIENCE)

    def said(self):
        name = f'{NAMESPACE}/joy_teleop'
        status = self.listener.diagnostics.get(name)
        return status.message if status else ''


@pytest.fixture
def pads(running, listening):
    with running('joy_teleop', NAMESPACE), listening(NAMESPACE, 'joy') as listener:
        topic = f'/{NAMESPACE}/cmd_vel/joy'
        listener.wait('a source', lambda: listener.node.count_publishers(topic) > 0, PATIENCE)
        yield Pads(listener)


def test_second_pad_stops_all_twists_until_it_has_gone_and_the_first_was_let_go(pads):
    twists = pads.listener.twists
    for _ in range(20):
        pads.both()
    pads.send_until('a reason', pads.both, lambda: 'more than one publisher' in pads.said())
    assert twists == []
    pads.send_until('the count', pads.both, lambda: '2 publishers on joy' in pads.said())
    assert twists == []
    assert f'/{NAMESPACE}/hexarm' in pads.said()
    for _ in range(200):
        pads.drive()
    assert twists == []
    pads.rest()
    pads.send_until('twists', pads.drive, lambda: twists)
    assert twists[-1][0] == (0.05, 0, 0, 0, 0, 0)
