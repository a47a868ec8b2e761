"""The pose node with a stand-in for tf2_msgs, which no index of wheels has, and without it.

The stand-in travels as std_msgs/String, with the frames as JSON: it shows that the node finds the
package, publishes on /tf and what; how a real TFMessage is written is tf2_msgs' own affair.
"""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from visualization_msgs.msg import MarkerArray

from hexarm.client import Client

pytestmark = pytest.mark.graph

ROOT = Path(__file__).resolve().parents[2]
HOME = [2.0943951] * 6
STAND_IN = '''
import json
from std_msgs.msg import String


class TFMessage(String):
    """Carries frames as JSON; rclpy's conversion asks for the name of the type it travels as."""

    def __init__(self, transforms=()):
        frames = [
            [t.header.frame_id, t.child_frame_id, t.transform.translation.z] for t in transforms
        ]
        super().__init__(data=json.dumps(frames))


TFMessage.__name__, TFMessage.__module__ = String.__name__, String.__module__
'''


@pytest.fixture
def stand_in(tmp_path):
    (tmp_path / 'tf2_msgs').mkdir()
    (tmp_path / 'tf2_msgs' / '__init__.py').write_text('')
    (tmp_path / 'tf2_msgs' / 'msg.py').write_text(STAND_IN)
    return tmp_path


@pytest.fixture
def pose_node():
    """Starts the pose node with parameters, and modules from a folder; stops it by its pid."""
    started = []

    def start(space, modules=None, **parameters):
        command = [sys.executable, '-m', 'hexarm.nodes', 'pose', '--ros-args']
        command += ['-r', f'__ns:=/{space}']
        for name, value in parameters.items():
            command += ['-p', f'{name}:={value}']
        known = os.environ.get('PYTHONPATH', '')
        path = os.pathsep.join(p for p in (str(modules or ''), str(ROOT), known) if p)
        pipe = subprocess.PIPE
        process = subprocess.Popen(
            command, cwd=ROOT, env=os.environ | {'PYTHONPATH': path}, stderr=pipe, text=True
        )
        started.append(process)
        return process

    yield start
    for process in started:
        process.kill()
        process.wait()


def received(client, topic, kind=String):
    """Publishes joint states until something comes on the topic."""
    messages = []
    client.node.create_subscription(kind, topic, messages.append, 10)
    states = client.node.create_publisher(JointState, 'joint_states', 5)
    names = [f'crank_{i}' for i in range(1, 7)]

    def has_subscribers():
        message = JointState(name=names, position=HOME)
        message.header.stamp = client.node.get_clock().now().to_msg()
        states.publish(message)
        client.spin(0.05)
        return bool(messages)

    client.wait(topic, has_subscribers, 60.0)
    client.node.destroy_publisher(states)
    return messages[-1]


def test_frames_go_out_where_tf2_msgs_is_installed(stand_in, pose_node):
    pose_node('framed', stand_in, frame_prefix='framed/')
    with Client('framed') as client:
        frames = json.loads(received(client, '/tf').data)
    assert [frame[:2] for frame in frames] == [
        ['framed/base', 'framed/platform'],
        ['framed/base', 'framed/work'],
        ['framed/platform', 'framed/pivot'],
    ]
    assert frames[0][2] == pytest.approx(0.04119, abs=1e-4)


def test_without_tf2_msgs_it_works_and_reports_nothing(pose_node, tmp_path):
    gone = 'raise ModuleNotFoundError("No module named tf2_msgs", name="tf2_msgs")\n'
    (tmp_path / 'tf2_msgs.py').write_text(gone)
    node = pose_node('unframed', tmp_path, frame_prefix='left_')
    with Client('unframed') as client:
        assert received(client, 'pose', PoseStamped).header.frame_id == 'base'
        (frame,) = {m.header.frame_id for m in received(client, 'markers', MarkerArray).markers}
        assert client.node.count_publishers('/tf') == 0
    assert frame == 'left_base'
    node.terminate()
    said = node.communicate(timeout=60)[1].splitlines()
    usual = 'machine robocake|clock of its source differs| s old, at most'  # or late
    assert [line for line in said if not re.search(usual, line)] == []


def test_prefix_that_tf2_would_refuse_is_refused(pose_node):
    node = pose_node('refused', frame_prefix='/hexapod/')
    said = node.communicate(timeout=60)[1]
    assert node.returncode == 1
    assert "parameter frame_prefix: '/hexapod/' is not a valid prefix of a frame name" in said
