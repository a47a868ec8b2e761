"""What a person's stop button does: brakes where it can, else the emergency stop."""

import time

import pytest
import rclpy
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from std_msgs.msg import Bool
from std_srvs.srv import Trigger

from manipulator.nodes.jog_topics import NO_TWIST, JogTopics
from manipulator.nodes.qos import EVERY_WORD
from manipulator.nodes.stop_button import PATIENCE

pytestmark = pytest.mark.graph

SPACE = 'stop_button'


class Trajectory(Node):
    """Answers to its stop as it is told to."""

    def __init__(self):
        super().__init__('trajectory', namespace=SPACE)
        self.asked, self.succeeds = 0, True
        self.create_service(Trigger, '~/stop', self._stop)
        self.create_service(Trigger, '~/home', self._stop)

    def _stop(self, request, response):
        self.asked += 1
        response.success, response.message = self.succeeds, 'the machine is playing'
        return response


class Rig:
    """A person's node, a bridge that hears stops, and perhaps a trajectory node."""

    def __init__(self):
        rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
        self.person, self.bridge = (Node(name, namespace=SPACE) for name in ('pad', 'bridge'))
        self.stops = []
        self.bridge.create_subscription(Bool, 'emergency_stop', self._hear, EVERY_WORD)
        self.topics = JogTopics(self.person, 'joy')
        self.executors = {node: EventsExecutor() for node in (self.person, self.bridge)}
        for node, executor in self.executors.items():
            executor.add_node(node)
        self.wait(lambda: self.person.count_subscribers(f'/{SPACE}/emergency_stop') == 1)
        self.spin(0.3)

    def _hear(self, message):
        self.stops.append((time.monotonic(), message.data))

    def add_trajectory(self):
        node = Trajectory()
        self.executors[node] = EventsExecutor()
        self.executors[node].add_node(node)
        clients = self.topics._services.values()
        self.wait(lambda: all(client.service_is_ready() for client in clients))
        self.spin(0.3)
        return node

    def freeze(self, node):
        self.executors.pop(node)

    def spin(self, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.topics.drive(NO_TWIST, '', False)
            for executor in self.executors.values():
                executor.spin_once(timeout_sec=0.002)

    def wait(self, is_so):
        end = time.monotonic() + 10.0
        while not is_so():
            assert time.monotonic() < end
            self.spin(0.01)


@pytest.fixture
def rig():
    rig = Rig()
    yield rig
    for node, executor in rig.executors.items():
        executor.shutdown()
        node.destroy_node()
    rclpy.try_shutdown()


def test_it_brakes_where_the_trajectory_node_says_so(rig):
    trajectory = rig.add_trajectory()
    rig.topics.stop()
    rig.wait(lambda: trajectory.asked)
    rig.spin(3 * PATIENCE)
    assert rig.stops == []


def test_a_refusal_becomes_an_emergency_stop(rig):
    rig.add_trajectory().succeeds = False
    rig.topics.stop()
    rig.wait(lambda: rig.stops)
    rig.spin(2 * PATIENCE)
    assert [is_stop for _, is_stop in rig.stops] == [True]


def test_so_does_a_trajectory_node_that_does_not_answer(rig):
    rig.freeze(rig.add_trajectory())
    began = time.monotonic()
    rig.topics.stop()
    rig.topics.stop()
    rig.wait(lambda: rig.stops)
    assert rig.stops[0][0] - began >= PATIENCE
    rig.spin(2 * PATIENCE)
    assert len(rig.stops) == 1


def test_and_one_that_is_not_there_at_once(rig):
    rig.topics.stop()
    rig.wait(lambda: rig.stops)


def test_letting_go_of_home_is_no_emergency(rig):
    trajectory = rig.add_trajectory()
    trajectory.succeeds = False
    rig.topics.home(True)
    rig.topics.home(False)
    rig.wait(lambda: trajectory.asked == 2)
    rig.spin(2 * PATIENCE)
    assert rig.stops == []
