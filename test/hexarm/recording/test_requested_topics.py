"""Which topics a recording joins, and when."""

import re
from pathlib import Path

import pytest

from hexarm.recording.topics import ALL_FOUND_AFTER, COMMANDS, TopicSelection

OF_THE_PAD = {'joy'}
"""What joy_teleop only hears: docs/joystick.md."""
OF_THE_DRIVER = {'driver/joint_states'}
"""What no node of ours publishes, and no user either."""
INTERFACES = Path(__file__).resolve().parents[3] / 'docs' / 'interfaces.md'
USERS = ('panel\n',)
"""Nodes of the document that command a machine, and are none of its own."""
MACHINE = re.compile(r'^\| `([\w/]+)` \| (in|out) \|', re.MULTILINE)


def test_commands_are_what_the_nodes_of_the_document_only_receive():
    sections = re.split(r'^## ', INTERFACES.read_text(), flags=re.MULTILINE)
    of_the_machine = [text for text in sections if not text.startswith(USERS)]
    reported = MACHINE.findall('\n'.join(of_the_machine))
    received, published = ({n for n, way in reported if way == kind} for kind in ('in', 'out'))
    assert received - published - OF_THE_DRIVER | OF_THE_PAD == COMMANDS


@pytest.mark.parametrize('topic', ['/arm/pose', '/arm/serial_bridge/log', '/diagnostics', '/tf'])
def test_streams_and_shared_topics_are_joined_at_once(topic):
    assert TopicSelection('arm').may_join(topic, ['script'], 0.0)


@pytest.mark.parametrize('topic', ['/hexapod/pose', '/arms/pose', '/arm2/pose', '/clock'])
def test_other_machines_are_left_alone(topic):
    assert not TopicSelection('arm').may_join(topic, ['script'], 0.0)


@pytest.mark.parametrize('command', sorted(COMMANDS))
def test_command_is_joined_once_its_publisher_has_been_there_for_long(command):
    selection, topic = TopicSelection('arm'), f'/arm/{command}'
    assert not selection.may_join(topic, ['script'], 10.0)
    assert not selection.may_join(topic, ['script'], 10.0 + ALL_FOUND_AFTER - 0.01)
    assert selection.may_join(topic, ['script'], 10.0 + ALL_FOUND_AFTER)
    assert not selection.may_join(topic, [], 20.0)
    assert not selection.may_join(topic, ['script'], 20.1), 'the next publisher is another one'


def test_goals_of_publishers_that_wait_for_the_machine_are_joined_at_once():
    selection = TopicSelection('arm')
    assert selection.may_join('/arm/goal_pose', ['hexarm', 'panel'], 0.0)
    assert not selection.may_join('/arm/goal_path', ['hexarm', 'script'], 0.0)
    assert not selection.may_join('/arm/emergency_stop', ['hexarm'], 0.0)


def test_commands_are_joined_early_where_that_is_asked_for():
    assert TopicSelection('arm', with_commands=True).may_join('/arm/goal_pose', [], 0.0)
    named = TopicSelection('arm', names=['goal_pose', '/hexapod/pose'])
    assert named.may_join('/arm/goal_pose', [], 0.0)
    assert named.may_join('/hexapod/pose', [], 0.0)
    assert not named.may_join('/arm/pose', ['script'], 0.0)


def test_what_a_recording_is_made_for_is_what_was_named_or_the_machines_own():
    assert TopicSelection('arm').is_own('/arm/pose')
    assert not TopicSelection('arm').is_own('/tf')
    assert not TopicSelection('arm').is_own('/armed/pose')
    assert TopicSelection('arm', ('pose', '/tf')).is_own('/tf')
    assert not TopicSelection('arm', ('pose',)).is_own('/arm/setpoint')
