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

    def get_topic_names_and_types(self):
        return [(name, [TYPE]) for name in self.topics]

    def get_publishers_info_by_topic(self, name):
        return [SimpleNamespace(qos_profile=QoSProfile(depth=1), node_name='pose')]

    def get_subscriptions_info_by_topic(self, name):
        return []

    def count_publishers(self, name):
        return 1

    def create_subscription(self, *_, **__):
        return SimpleNamespace(get_publisher_count=lambda: 1)


def test_it_is_ready_once_it_has_met_every_topic_and_no_more_come():
    graph, bag = Graph(), SimpleNamespace(add_type=lambda name: None)
    recorder = Recorder(graph, TopicSelection('hexapod'), bag)
    ready = []
    for topics in ([], ['machine_state'], ['pose'], ['setpoint'], [], []):
        graph.topics += [f'/hexapod/{name}' for name in topics]
        recorder.update(0.0)
        ready.append(recorder.is_ready(every=True))
    assert ready == [False, False, False, False, True, True]
