"""Topics between nodes of one process: handed over, and for all others as on any topic."""

import threading

import pytest
from geometry_msgs.msg import PoseStamped
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState

from manipulator.nodes.intra_process import MOST_BYTES, IntraProcess
from manipulator.nodes.qos import MEASUREMENT


class Machine:
    """A process whose nodes share the topic `pose`."""

    def __init__(self, graph, kind=PoseStamped, is_from_thread=False):
        node, process = graph.node('machine'), IntraProcess()
        self.received, self.refused, self.threads = [], [], set()
        process.subscribe_unfiltered(
            node, kind, 'pose', self._take, self.refused.append, MEASUREMENT
        )
        self.publisher = process.publisher(node, kind, 'pose', MEASUREMENT, is_from_thread)

    def _take(self, message):
        self.received.append(message)
        self.threads.add(threading.get_ident())


def stamped(second, kind=PoseStamped):
    message = kind()
    message.header.stamp.sec = second
    return message


def second(message):
    return message.header.stamp.sec


def test_message_is_handed_over_as_it_is_and_not_published_while_nobody_else_subscribes(graph):
    machine, message = Machine(graph), stamped(1)
    machine.publisher._publisher.publish = None
    machine.publisher.publish(message)
    assert machine.received[0] is message


@pytest.mark.parametrize('kind', [PoseStamped, JointState])
def test_another_process_receives_what_is_handed_over_and_nobody_receives_it_twice(graph, kind):
    machine, user, others = Machine(graph, kind), graph.node('user'), []
    user.create_subscription(kind, 'pose', others.append, MEASUREMENT)
    outside = user.create_publisher(kind, 'pose', MEASUREMENT)
    counts = machine.publisher._publisher, outside
    graph.wait('discovery', lambda: all(p.get_subscription_count() == 2 for p in counts))
    for k in range(1, 21):
        machine.publisher.publish(stamped(k, kind))
        graph.wait('the message', lambda k=k: others and second(others[-1]) == k)
    outside.publish(stamped(21, kind))
    graph.wait('the last message', lambda: second(machine.received[-1]) == 21)
    assert [second(message) for message in machine.received] == list(range(1, 22))


def test_others_receive_as_many_bytes_as_from_any_publisher(graph):
    machine, user, others = Machine(graph, JointState), graph.node('user'), []
    user.create_subscription(JointState, 'pose', others.append, MEASUREMENT, raw=True)
    outside = graph.node('else').create_publisher(JointState, 'pose', MEASUREMENT)
    counts = machine.publisher._publisher, outside
    graph.wait('discovery', lambda: all(p.get_subscription_count() == 2 for p in counts))
    message = JointState(name=['crank_1', 'crank_2'], position=[0.0, 1.0], effort=[0.0])
    for publisher in (machine.publisher, outside):
        before = len(others)
        publisher.publish(message)
        graph.wait('the message', lambda before=before: len(others) > before)
    assert len(others[0]) == len(others[1])


@pytest.mark.parametrize(
    ('sent', 'reason'),
    [(b'\0\1\0\0no pose', '11 bytes that are no PoseStamped'), (b'\0' * 99_999, f'{MOST_BYTES}')],
)
def test_bytes_that_are_no_such_message_are_refused(graph, sent, reason):
    machine, user = Machine(graph), graph.node('user')
    publisher = user.create_publisher(PoseStamped, 'pose', MEASUREMENT)
    graph.wait('discovery', lambda: publisher.get_subscription_count() == 1)
    publisher.publish(sent)
    graph.wait('the refusal', lambda: machine.refused)
    assert reason in str(machine.refused[0])
    publisher.publish(serialize_message(stamped(1)))
    graph.wait('the next message', lambda: machine.received)


def test_messages_of_another_thread_are_taken_in_the_executors_and_of_too_many_the_newest(graph):
    machine = Machine(graph, is_from_thread=True)

    def publish():
        for k in range(100):
            machine.publisher.publish(stamped(k))

    thread = threading.Thread(target=publish)
    thread.start()
    thread.join()
    graph.wait('the messages', lambda: machine.received)
    newest = range(100 - MEASUREMENT.depth, 100)
    assert [second(message) for message in machine.received] == list(newest)
    assert machine.threads == {threading.get_ident()}
