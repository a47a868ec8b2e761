"""Saved poses on topics and in their file, with a stand-in for the node."""

from unittest.mock import MagicMock

import pytest
from rclpy.serialization import serialize_message
from std_msgs.msg import String
from std_srvs.srv import Trigger

from hexarm import machines
from manipulator.nodes import saved_pose_topics
from manipulator.nodes.saved_pose_topics import SavedPoseTopics


class Taught:
    """The topics of a machine: what is sent to them, and what they published."""

    def __init__(self, path):
        self.machine, self.path = machines.load('robocake'), path
        self.publishers, self.callbacks, node = {}, {}, MagicMock()
        node.create_publisher.side_effect = lambda kind, topic, qos: self.publishers.setdefault(
            topic, MagicMock()
        )
        node.create_subscription.side_effect = lambda kind, topic, callback, qos, raw: (
            self.callbacks.update({topic: callback})
        )
        node.create_service.side_effect = lambda kind, name, callback: self.callbacks.update(
            {name: callback}
        )
        self.topics = SavedPoseTopics(node, self.machine, path)

    def stands(self):
        home = self.machine.kinematics.home
        self.topics.note(home, self.machine.kinematics.inverse(home))

    def send(self, topic, name):
        self.callbacks[topic](serialize_message(String(data=name)))
        return self.published('saved_pose_status')

    def published(self, topic):
        return self.publishers[topic].publish.call_args.args[0].data


@pytest.fixture
def taught(tmp_path, monkeypatch):
    """On a clock that stands still: a pose counts for half a second."""
    monkeypatch.setattr(saved_pose_topics, 'time', MagicMock(monotonic=lambda: 100.0))
    return Taught(tmp_path / 'new' / 'robocake.poses.yaml')


def test_a_pose_is_in_the_file_and_published(taught):
    assert taught.published('saved_pose_status') == ''
    taught.stands()
    assert taught.send('save_pose', 'up') == 'up: saved'
    assert taught.send('save_pose', 'up') == 'up: replaced'
    assert taught.send('save_pose', '') == 'pose_1: saved'
    assert taught.path.read_text() == taught.published('saved_poses')
    assert list(taught.path.parent.iterdir()) == [taught.path]
    assert taught.send('delete_pose', 'up') == 'up: deleted'
    assert 'up:' not in taught.published('saved_poses')


def test_the_service_names_the_pose_that_it_saved(taught):
    response = taught.callbacks['~/save'](None, Trigger.Response())
    assert not response.success
    assert 'not all joints are known' in response.message
    taught.stands()
    response = taught.callbacks['~/save'](None, Trigger.Response())
    assert (response.success, response.message) == (True, 'pose_1: saved')


def test_a_pose_that_is_not_measured_any_more_is_not_saved(taught, monkeypatch):
    taught.stands()
    monkeypatch.setattr(saved_pose_topics, 'time', MagicMock(monotonic=lambda: 101.0))
    assert 'refused: no pose' in taught.send('save_pose', 'up')


def test_an_edited_file_is_read_again_and_a_bad_one_is_not_overwritten(taught):
    taught.stands()
    taught.send('save_pose', 'up')
    good = taught.path.read_text()
    bad = good.replace('xyz_mm', 'xyz_m')
    taught.path.write_text(bad)
    assert 'xyz_m: unknown key' in taught.topics.watch()
    assert 'unknown key' in taught.send('save_pose', 'down')
    assert taught.path.read_text() == bad
    taught.path.write_text(good.replace('up:', 'upwards:'))
    assert taught.topics.watch() == ''
    assert 'upwards:' in taught.published('saved_poses')


def test_a_name_of_a_megabyte_and_a_file_that_cannot_be_written_are_refused(taught):
    taught.stands()
    assert 'refused: 1000' in taught.send('save_pose', 'x' * 1_000_000)
    taught.path.parent.write_text('a file where the folder should be')
    assert 'cannot be' in taught.send('save_pose', 'up')
