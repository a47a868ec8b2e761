"""What a person's stop button does: brakes where it can, else the emergency stop.

In simulated time, with a stand-in for the trajectory node's services.
"""

from unittest.mock import MagicMock

import pytest
from rclpy.task import Future
from std_srvs.srv import Trigger

from manipulator.deadlines import RELEASE
from manipulator.nodes.devices import jog_topics
from manipulator.nodes.devices import jog_topics as stop_button
from manipulator.nodes.devices.jog_topics import NO_TWIST, JogTopics

TICK = 0.02


class Service:
    """A service of the trajectory node; `succeeds` None does not answer."""

    def __init__(self):
        self.is_there, self.succeeds, self.asked = True, True, 0

    def service_is_ready(self):
        return self.is_there

    def call_async(self, request):
        self.asked += 1
        future = Future()
        if self.succeeds is not None:
            answer = Trigger.Response(success=self.succeeds, message='the machine is playing')
            future.set_result(answer)
        return future


class Person:
    """A node with its person's hand on it: what it asks and publishes, tick by tick."""

    def __init__(self, monkeypatch):
        self._now = 100.0
        for module in (jog_topics, stop_button):
            monkeypatch.setattr(module, 'time', MagicMock(monotonic=lambda: self._now))
        self.trajectory, self.publishers = Service(), {}
        node = MagicMock()
        node.create_client.return_value = self.trajectory
        node.create_publisher.side_effect = self._publisher
        self.topics = JogTopics(node, 'joy')

    def _publisher(self, kind, topic, qos):
        return self.publishers.setdefault(topic, MagicMock())

    @property
    def stops(self):
        """What was published on emergency_stop."""
        published = self.publishers['emergency_stop'].publish.call_args_list
        return [call.args[0].data for call in published]

    def ticks(self, seconds):
        for _ in range(round(seconds / TICK)):
            self._now += TICK
            self.topics.drive(NO_TWIST, '', False)


@pytest.fixture
def person(monkeypatch):
    return Person(monkeypatch)


def test_it_brakes_where_the_trajectory_node_reports_that(person):
    person.topics.stop()
    person.ticks(3 * RELEASE)
    assert person.trajectory.asked == 1
    assert person.stops == []


def test_a_refusal_becomes_an_emergency_stop_at_once(person):
    person.trajectory.succeeds = False
    person.topics.stop()
    assert person.stops == [True]
    person.ticks(3 * RELEASE)
    assert person.stops == [True]


def test_so_does_a_trajectory_node_that_does_not_answer_in_time_however_often_it_is_asked(person):
    person.trajectory.succeeds = None
    person.topics.stop()
    person.topics.stop()
    person.ticks(RELEASE - TICK)
    assert person.stops == []
    person.ticks(2 * TICK)
    assert person.stops == [True]
    person.ticks(3 * RELEASE)
    assert person.stops == [True]


def test_and_one_that_is_not_there_at_once(person):
    person.trajectory.is_there = False
    person.topics.stop()
    assert person.stops == [True]


def test_a_node_that_ends_before_it_is_answered_stops_at_once(person):
    person.trajectory.succeeds = None
    person.topics.stop()
    person.topics.close()
    assert person.stops == [True]


def test_letting_go_of_home_is_no_emergency(person):
    person.trajectory.succeeds = False
    person.topics.home(True)
    person.topics.home(False)
    assert person.trajectory.asked == 2
    person.ticks(3 * RELEASE)
    assert person.stops == []
