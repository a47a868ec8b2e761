"""What a viewer receives of a machine's messages: topics, definitions, bytes as they came."""

import json
import struct
from unittest.mock import Mock

import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState
from websockets.sync.client import connect

from hexarm.cli.main import main
from hexarm.recording.foxglove_server import FoxgloveServer
from hexarm.recording.sink import Topic
from manipulator.errors import Refused

TYPE = 'sensor_msgs/msg/JointState'
MESSAGE_DATA = 1
PATIENCE = 60.0


@pytest.fixture
def server():
    with FoxgloveServer('hexarm /test', '127.0.0.1', 0) as server:
        yield server


@pytest.fixture
def viewer(server):
    with connect(server.address, subprotocols=['foxglove.sdk.v1']) as viewer:
        yield viewer


def next_of(viewer, operation):
    """The next message with this operation."""
    while True:
        text = viewer.recv(timeout=PATIENCE)
        if isinstance(text, str) and (words := json.loads(text))['op'] == operation:
            return words


def test_a_viewer_receives_the_messages_of_a_topic_as_they_were_published(server, viewer):
    server.add_type(TYPE)
    server.add_topic(Topic('/arm/joint_states', TYPE))
    (channel,) = next_of(viewer, 'advertise')['channels']
    assert (channel['topic'], channel['encoding']) == ('/arm/joint_states', 'cdr')
    assert (channel['schemaName'], channel['schemaEncoding']) == (TYPE, 'ros2msg')
    assert 'float64[] position' in channel['schema']
    wanted = {'op': 'subscribe', 'subscriptions': [{'id': 7, 'channelId': channel['id']}]}
    viewer.send(json.dumps(wanted))
    message = serialize_message(JointState(name=['a'], position=[0.25]))
    received = None
    while received is None:  # the subscription may be later than a message
        server.write('/arm/joint_states', message, 123_000_000_000)
        try:
            received = viewer.recv(timeout=0.2)
        except TimeoutError:
            continue
    operation, subscription, stamp = struct.unpack('<BIQ', received[:13])
    assert (operation, subscription, stamp) == (MESSAGE_DATA, 7, 123_000_000_000)
    assert received[13:] == message
    assert server.counts['/arm/joint_states'] >= 1


def test_a_port_that_is_taken_is_named(server):
    port = int(server.address.rpartition(':')[2])
    with pytest.raises(Refused, match=f'port {port}'):
        FoxgloveServer('second', '127.0.0.1', port)


def test_a_machine_that_does_not_come_is_status_1_with_the_reason(monkeypatch, capsys):
    monkeypatch.setattr('hexarm.recording.session.record', lambda *_: (set(), 7))
    monkeypatch.setattr('hexarm.cli.running.foxglove.StopSignal', lambda: Mock(is_set=False))
    assert main(['foxglove', 'nowhere', '--port', '0']) == 1
    assert 'no machine found in /nowhere on ROS domain 7' in capsys.readouterr().err


@pytest.mark.parametrize('port', ['65536', '-1', 'eight', '9' * 30])
def test_a_number_that_is_no_port_is_refused_in_words(port, capsys):
    with pytest.raises(SystemExit) as refusal:
        main(['foxglove', 'hexapod', f'--port={port}'])
    assert refusal.value.code == 2
    assert f"'{port}': needs a port from 0 to 65535" in capsys.readouterr().err
