"""The arm's part of the demonstration: a gamepad overrides a goal, then draws and looks."""

import time
from typing import TYPE_CHECKING

import numpy as np
from geometry_msgs.msg import PointStamped
from sensor_msgs.msg import JointState

from hexarm.demo.arm_report import ArmObservation, Phase
from hexarm.demo.pad import ScriptedPad
from hexarm.graph import Executable
from manipulator.machine import Machine
from manipulator.nodes.messages import joints_of, seconds
from manipulator.nodes.qos import COMMAND, MEASUREMENT

if TYPE_CHECKING:
    from collections.abc import Callable

    from hexarm.client import Client

MACHINE = 'arm_6r_stepper'
SIGHT = 0.3
"""Metres from the tool to the point that it looks at."""
SETTLED = 0.4


def teleop() -> Executable:
    """joy_teleop for the arm's namespace, at three times the speeds of its mapping."""
    return Executable('joy_teleop', {'scale': '3.0'})


def arm_tour(client: 'Client', machine: Machine, say: 'Callable[[str], None]') -> ArmObservation:
    """Drives the arm by a scripted pad; true joint angles are heard all the while."""
    say('the arm: energising its drives, then a gamepad takes it over')
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
        pad.rest(SETTLED)

    say('a goal 0.35 m away; on its way the stick pulls the arm back')
    client.publish_goal(kinematics.home.moved([-0.35, 0.0, 0.0, 0.0, 0.0, 0.0]))
    pad.rest(0.7)
    phase('override', {'seconds': 2.0, 'forward': 1.0})
    pad.next_mode(1)
    say('a square with the orientation held')
    sides = ({'left': -1.0}, {'up': 1.0}, {'left': 1.0}, {'up': -1.0})
    phase('square', *({'seconds': 1.5} | side for side in sides))
    tool = kinematics.forward(joints_of(messages[-1], names)).pose
    point = tool.position + SIGHT * tool.rotation[:, 2]
    look_at(client, point)
    pad.next_mode(-2)
    say('to and fro, looking at one point')
    phase('look', *({'seconds': s, 'forward': f} for s, f in ((1.0, 1), (2.0, -1), (1.0, 1))))
    return ArmObservation(
        times=np.array([seconds(m.header.stamp) for m in messages]),
        joints=np.array([joints_of(m, names) for m in messages]),
        phases=tuple(phases),
        point=point,
    )


def look_at(client: 'Client', point: np.ndarray) -> None:
    """Tells the arm what to look at."""
    publisher = client.node.create_publisher(PointStamped, 'look_at', COMMAND)
    client.wait('a listener', lambda: publisher.get_subscription_count() > 0, 5.0)
    message = PointStamped()
    message.point.x, message.point.y, message.point.z = point.tolist()
    publisher.publish(message)
    client.spin(0.05)
