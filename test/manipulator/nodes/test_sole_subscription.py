"""Messages of two publishers at once are noticed in the graph, under each executor of rclpy."""

from types import SimpleNamespace

import pytest
from geometry_msgs.msg import TwistStamped
from rclpy.executors import SingleThreadedExecutor
from rclpy.experimental import EventsExecutor
from sensor_msgs.msg import Joy

from manipulator.nodes import subscriptions as sole_subscription
from manipulator.nodes import teleop_topics
from manipulator.nodes.qos import MEASUREMENT
from manipulator.nodes.subscriptions import SoleSubscription
from manipulator.nodes.teleop_topics import TeleopTopics
from manipulator.teleop.arbiter import SOURCES
from manipulator.trajectory.teleop import Teleop


class Clock:
    """A simulated monotonic clock: however slow this computer is, messages come every 40 ms."""

    def __init__(self):
        self.now = 100.0

    def monotonic(self):
        return self.now


@pytest.fixture
def clock(monkeypatch):
    made = Clock()
    monkeypatch.setattr(sole_subscription, 'time', made)
    monkeypatch.setattr(teleop_topics, 'time', made)
    return made


class Sender:
    """A user's publishers, whose messages are awaited one by one."""

    def __init__(self, graph, clock, message_type, topic, is_received):
        self._graph, self._clock, self._topic = graph, clock, topic
        self._message_type, self._is_received = message_type, is_received
        self._node = graph.node('user')

    def publisher(self):
        made = self._node.create_publisher(self._message_type, self._topic, MEASUREMENT)
        self._graph.wait('a listener', lambda: made.get_subscription_count() > 0)
        return made

    def send(self, *publishers):
        for publisher in publishers:
            self._clock.now += 0.04
            before = self._is_received()
            publisher.publish(self._message_type())
            self._graph.wait('the message', lambda n=before: self._is_received() > n)


@pytest.mark.parametrize('executor', [EventsExecutor, SingleThreadedExecutor])
def test_second_publisher_is_trouble_until_a_second_after_its_end(graph_of, clock, executor):
    with graph_of(executor) as graph:
        seen = []
        pads = SoleSubscription(
            graph.node('machine'), Joy, 'joy', lambda m: seen.append(pads.conflict), MEASUREMENT
        )
        user = Sender(graph, clock, Joy, 'joy', lambda: len(seen))
        first = user.publisher()
        user.send(*[first] * 10)
        assert set(seen) == {''}
        second = user.publisher()
        seen.clear()
        user.send(*[first, second] * 10)
        assert set(seen[1:]) == {'more than one publisher sends on /here/joy'}
        user.send(*[first] * 28)
        assert seen[-1] == ''


class IdleSupervisor:
    """A machine that nothing drives."""

    is_measured = False
    executor = SimpleNamespace(is_busy=False, jog=lambda request: None)


@pytest.mark.parametrize('source', SOURCES)
def test_twists_of_two_publishers_move_nothing_until_there_was_silence(graph, clock, source):
    teleop, heard = Teleop(IdleSupervisor(), 0.06), []
    topics = TeleopTopics(graph.node('machine'), teleop)

    def received():
        return topics.report()['twists_refused'] + len(heard)

    original = teleop.receive
    teleop.receive = lambda *args: (original(*args), heard.append(args))
    user = Sender(graph, clock, TwistStamped, source, received)
    first, second = user.publisher(), user.publisher()
    user.send(first, first)
    assert topics.report()['jogged_by'] == source
    user.send(second)
    for _ in range(12):
        assert topics.report()['jogged_by'] == ''
        assert topics.conflict == f'more than one publisher sends on /here/{source}'
        user.send(first, second)
    for _ in range(50):
        user.send(first)
        assert topics.report()['jogged_by'] == ''
    assert 'release first' in topics.report()['last_twist_refusal']
    clock.now += 0.3
    user.send(first)
    assert topics.report()['jogged_by'] == source


def test_the_newest_refusal_of_any_source_is_reported(graph, clock):
    topics = TeleopTopics(graph.node('machine'), Teleop(IdleSupervisor(), 0.06))
    node, sent = graph.node('user'), 0
    for source, frame in (('cmd_vel/joy', 'moon'), ('cmd_vel/joy', 'moon'), ('cmd_vel', 'mars')):
        publisher = node.create_publisher(TwistStamped, source, MEASUREMENT)
        graph.wait('a listener', lambda made=publisher: made.get_subscription_count() > 0)
        message = TwistStamped()
        message.header.frame_id = frame
        clock.now, sent = clock.now + 0.04, sent + 1
        publisher.publish(message)
        graph.wait('a refusal', lambda n=sent: topics.report()['twists_refused'] == n)
    assert 'mars' in topics.report()['last_twist_refusal']
