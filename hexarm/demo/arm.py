"""The arm's part of the demonstration: a gamepad overrides a goal, then draws and looks.

The gamepad is played by a script, as Joy messages that an Xbox pad would send.
"""

import time
from typing import TYPE_CHECKING

import numpy as np
from geometry_msgs.msg import PointStamped
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import JointState, Joy

from hexarm.demo.arm_report import ArmObservation, Phase
from hexarm.graph import Executable
from manipulator.machine import Machine
from manipulator.nodes.messages import joints_of, seconds
from manipulator.nodes.qos import COMMAND, MEASUREMENT

if TYPE_CHECKING:
    from collections.abc import Callable

    from hexarm.client import Client

PERIOD = 0.02
AXES, BUTTONS = 8, 11
TRIGGERS = (2, 5)
DEADMAN = 4
CROSS = 6
FORWARD, LEFT, UP = 1, 0, 4
"""Axes of the sticks, by what they move in config/joystick_xbox.yaml."""
TREMBLE = 0.01
"""A hand is never still; a pad that sends the same for 0.2 s counts as frozen."""


class ScriptedPad:
    """Publishes while it spins the client; the deadman is held during `drive`."""

    def __init__(self, client: 'Client') -> None:
        self._client = client
        self._count = 0
        self._publisher = client.node.create_publisher(Joy, 'joy', qos_profile_sensor_data)
        client.wait('joy_teleop', lambda: self._publisher.get_subscription_count() > 0, 10.0)
        self.rest(0.2)

    def rest(self, seconds: float) -> None:
        """The pad is not touched."""
        self._play(seconds, {}, is_held=False)

    def drive(self, seconds: float, **sticks: float) -> None:
        """The deadman held, and `forward`, `left`, `up` pushed that far (−1 to 1)."""
        axes = {'forward': FORWARD, 'left': LEFT, 'up': UP}
        self._play(seconds, {axes[name]: value for name, value in sticks.items()}, is_held=True)

    def next_mode(self, presses: int) -> None:
        """Presses the cross to the right, or to the left where `presses` is negative."""
        for _ in range(abs(presses)):
            self._play(0.1, {CROSS: -1.0 if presses > 0 else 1.0}, is_held=False)
            self.rest(0.1)

    def _play(self, seconds: float, pushed: dict[int, float], is_held: bool) -> None:
        for _ in range(round(seconds / PERIOD)):
            self._count += 1
            axes = [1.0 if axis in TRIGGERS else 0.0 for axis in range(AXES)]
            for axis, value in pushed.items():
                axes[axis] = value * (1.0 - TREMBLE * (self._count % 2))
            message = Joy(
                axes=axes, buttons=[int(b == DEADMAN and is_held) for b in range(BUTTONS)]
            )
            message.header.stamp = self._client.node.get_clock().now().to_msg()
            self._publisher.publish(message)
            self._client.spin(PERIOD)


MACHINE = 'arm_6r_stepper'
SIGHT = 0.3
"""Metres from the tool to the point that it looks at."""
REST = 0.4


def teleop() -> Executable:
    """joy_teleop for the arm's namespace, at three times the speeds of its mapping."""
    return Executable('joy_teleop', {'scale': '3.0'})


def arm_tour(client: 'Client', machine: Machine, echo: 'Callable[[str], None]') -> ArmObservation:
    """Drives the arm by a scripted pad; true joint angles are received throughout."""
    echo('the arm: energising its drives, then a gamepad takes over')
    client.enable()
    pad = ScriptedPad(client)
    messages: list[JointState] = []
    client.node.create_subscription(JointState, 'true_joint_states', messages.append, MEASUREMENT)
    kinematics, names = machine.kinematics, machine.kinematics.joint_names
    phases: list[Phase] = []

    def phase(name: str, *pushes: dict[str, float]) -> None:
        begin = time.time()
        for push in pushes:
            pad.drive(**push)
        phases.append(Phase(name, begin, time.time()))
        pad.rest(REST)

    echo('a goal 0.35 m away; before it arrives the stick pulls the arm back')
    client.publish_goal(kinematics.home.moved([-0.35, 0.0, 0.0, 0.0, 0.0, 0.0]))
    pad.rest(0.7)
    phase('override', {'seconds': 2.0, 'forward': 1.0})
    pad.next_mode(1)
    echo('a square with the orientation held')
    sides = ({'left': -1.0}, {'up': 1.0}, {'left': 1.0}, {'up': -1.0})
    phase('square', *({'seconds': 1.5} | side for side in sides))
    tool = kinematics.forward(joints_of(messages[-1], names)).pose
    point = tool.position + SIGHT * tool.rotation[:, 2]
    look_at(client, point)
    pad.next_mode(-2)
    echo('to and fro, looking at one point')
    phase('look', *({'seconds': s, 'forward': f} for s, f in ((1.0, 1), (2.0, -1), (1.0, 1))))
    return ArmObservation(
        times=np.array([seconds(m.header.stamp) for m in messages]),
        joints=np.array([joints_of(m, names) for m in messages]),
        phases=tuple(phases),
        point=point,
    )


def look_at(client: 'Client', point: np.ndarray) -> None:
    """Publishes the point to look at."""
    publisher = client.node.create_publisher(PointStamped, 'look_at', COMMAND)
    client.wait('a subscriber on look_at', lambda: publisher.get_subscription_count() > 0, 5.0)
    message = PointStamped()
    message.point.x, message.point.y, message.point.z = point.tolist()
    publisher.publish(message)
    client.spin(0.05)
