"""The arm does not move by a frozen pad that is pressed, beside a live one that nobody touches."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from sensor_msgs.msg import Joy

from manipulator.nodes.qos import COMMAND

pytestmark = [pytest.mark.graph, pytest.mark.real_time]
ROOT = Path(__file__).resolve().parents[3]
DEADMAN, FORWARD = 4, 1


@pytest.fixture
def joy_teleop(arm):
    command = [sys.executable, '-m', 'manipulator', 'joy_teleop', '--ros-args']
    command += ['-r', '__ns:=/arm']
    process = subprocess.Popen(command, cwd=ROOT, env=os.environ)
    yield process
    process.terminate()
    process.wait(10)


@pytest.fixture
def send(arm, joy_teleop):
    """Publishes on one of two publishers of `joy`, with the numbers of a pad."""
    made = [arm.node.create_publisher(Joy, 'joy', COMMAND) for _ in range(2)]
    for publisher in made:
        arm.wait('joy_teleop', lambda p=publisher: p.get_subscription_count() > 0, 20.0)

    def publish(which, is_pressed):
        axes = [0.0, float(is_pressed), 1.0, 0.0, 0.0, 1.0, 0.0, 0.0]
        message = Joy(axes=axes, buttons=[int(is_pressed and b == DEADMAN) for b in range(11)])
        message.header.stamp = arm.node.get_clock().now().to_msg()
        made[which].publish(message)
        arm.spin(0.01)

    yield publish
    for publisher in made:
        arm.node.destroy_publisher(publisher)


def test_frozen_pad_beside_one_at_rest_does_not_move_the_arm(arm, send, listen):
    commands = listen('joint_command')
    for _ in range(150):
        send(0, is_pressed=False)
        send(1, is_pressed=True)
    assert np.ptp(commands.joints, axis=0).max() == 0.0
    assert arm.motion('mode') == 'hold'
