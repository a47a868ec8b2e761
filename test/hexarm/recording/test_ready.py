"""When the recorder says that it records."""

from types import SimpleNamespace

import pytest

pytest.importorskip('rclpy')

from rclpy.qos import QoSProfile

from hexarm.recording.session import Recorder
from hexarm.recording.topics import TopicSelection

TYPE = 'std_msgs/msg/String'


class Graph:
    """A node's view of a graph whose topics are discovered one after another."""

    def __init__(self):
        self.topics = []
        self.unmet = set()

    def get_topic_names_and_types(self):
        return [(name, [TYPE]) for name in self.topics]

    def get_publishers_info_by_topic(self, name):
        return [SimpleNamespace(qos_profile=QoSProfile(depth=1), node_name='pose')]

    def get_subscriptions_info_by_topic(self, name):
        return []

    def count_publishers(self, name):
        return int(name not in self.unmet)

    def create_subscription(self, kind, name, *_, **__):
        return SimpleNamespace(get_publisher_count=lambda: self.count_publishers(name))


def recorder_in(graph, **options):
    bag = SimpleNamespace(add_type=lambda name: None)
    return Recorder(graph, TopicSelection('hexapod', **options), bag)


def test_it_is_ready_once_it_has_met_every_topic_and_no_more_come():
    graph = Graph()
    recorder = recorder_in(graph)
    ready = []
    for topics in ([], ['machine_state'], ['pose'], ['setpoint'], [], []):
        graph.topics += [f'/hexapod/{name}' for name in topics]
        recorder.update(0.0)
        ready.append(recorder.is_ready(every=True))
    assert ready == [False, False, False, False, True, True]


def test_a_topic_known_by_its_subscriber_alone_is_waited_for():
    graph = Graph()
    recorder = recorder_in(graph, with_commands=True)
    graph.topics = ['/hexapod/setpoint', '/hexapod/motion_status', '/hexapod/goal_pose']
    graph.unmet = {'/hexapod/motion_status', '/hexapod/goal_pose'}
    recorder.update(0.0)
    recorder.update(0.25)
    assert not recorder.is_ready(every=True)
    assert recorder.is_ready(every=False)
    graph.unmet = {'/hexapod/goal_pose'}
    assert recorder.is_ready(every=True)
