"""The graph of the serial arm, on stepper drives with encoders, and who jogs and hears it."""

import re
from pathlib import Path

import numpy as np
import pytest
from geometry_msgs.msg import TwistStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from hexarm.graph import Graph, check_alive, machine_graph
from hexarm.machines import load
from manipulator.nodes.messages import joints_of, seconds
from manipulator.nodes.qos import COMMAND
from patient_user import PatientUser

MACHINE = load('arm_6r_stepper')
NAMES = MACHINE.kinematics.joint_names
DT = 0.01
PERIOD = 0.02
STILL = 1e-4
"""Radians (or metres)."""


class Joystick:
    """Twists on cmd_vel/joy while the deadman is held, as joy_teleop publishes them."""

    def __init__(self, user):
        self.user = user
        self.publisher = user.node.create_publisher(TwistStamped, 'cmd_vel/joy', COMMAND)
        self.modes = user.node.create_publisher(String, 'jog_mode', COMMAND)
        for publisher in (self.publisher, self.modes):
            user.wait('a listener', lambda p=publisher: p.get_subscription_count() > 0)

    def mode(self, name):
        self.modes.publish(String(data=name))
        self.user.spin(0.1)

    def send(self, twist=(0, 0, 0, 0, 0, 0), frame=''):
        message = TwistStamped()
        message.header.stamp = self.user.node.get_clock().now().to_msg()
        message.header.frame_id = frame
        v, w = message.twist.linear, message.twist.angular
        v.x, v.y, v.z, w.x, w.y, w.z = map(float, twist)
        self.publisher.publish(message)

    def has_pushed(self, twist, received, metres):
        """Holds the stick for a moment; whether the commands have gone so far by now."""
        self.send(twist)
        self.user.spin(PERIOD)
        return bool(received.messages) and received.way > metres


class Heard:
    """All joint states (or commands) since it began."""

    def __init__(self, user, topic='joint_states'):
        self.messages = []
        self.node = user.node
        self.subscription = user.node.create_subscription(
            JointState, topic, self.messages.append, 1000
        )

    @property
    def joints(self):
        return np.array([joints_of(m, NAMES) for m in self.messages])

    @property
    def stamps(self):
        return np.array([seconds(m.header.stamp) for m in self.messages])

    @property
    def poses(self):
        return [MACHINE.kinematics.forward(q).pose for q in self.joints]

    @property
    def way(self):
        """How far the tool is from where it was first, in metres."""
        ends = [joints_of(self.messages[k], NAMES) for k in (0, -1)]
        first, last = (MACHINE.kinematics.forward(q).pose.position for q in ends)
        return np.linalg.norm(last - first)

    def is_at_rest(self):
        """Whether the last ten agree."""
        last = self.joints[-10:]
        return len(last) == 10 and np.ptp(last, axis=0).max() < STILL

    def check_smooth(self):
        """No step of position or velocity beyond the joints' limits, from tick to tick."""
        limits = MACHINE.motion.joint
        joints, gaps = self.joints, np.diff(self.stamps)
        steps = np.diff(joints, axis=0)
        regular = np.abs(gaps - DT) < 0.4 * DT
        ticks = np.maximum(np.round(gaps / DT), 1.0)[:, None]  # some may not have been heard
        assert (np.abs(steps) <= 1.01 * limits.speed * DT * ticks).all()
        both = regular[1:] & regular[:-1]
        assert (np.abs(np.diff(steps, axis=0))[both] <= 1.01 * limits.acceleration * DT**2).all()

    def done(self):
        self.node.destroy_subscription(self.subscription)


@pytest.fixture(scope='module')
def arm_graph(tmp_path_factory):
    """The arm's five processes; its board waits longer than a busy test machine may stall."""
    folder = tmp_path_factory.mktemp('arm')
    shipped = Path(__file__).resolve().parents[3] / 'config' / 'arm_6r_stepper.yaml'
    patient = re.sub('setpoint_deadline_ms: .*', 'setpoint_deadline_ms: 1000', shipped.read_text())
    (folder / 'arm.yaml').write_text(patient)
    nodes = machine_graph(str(folder / 'arm.yaml'), 'fake', folder / 'board')
    with Graph(nodes, 'arm') as graph:
        yield graph


@pytest.fixture(scope='module')
def user(arm_graph):
    with PatientUser('arm', lambda: check_alive(arm_graph)) as client:
        yield client


@pytest.fixture
def arm(user):
    """The enabled arm at home, in the plain jog mode."""
    user.make_ready()
    user.wait_driven('standing still', lambda: user.motion('mode') == 'hold')
    user.reach_home()
    return user


@pytest.fixture
def joystick(arm):
    made = Joystick(arm)
    made.mode('free')
    yield made
    made.mode('free')
    for publisher in (made.publisher, made.modes):
        arm.node.destroy_publisher(publisher)


@pytest.fixture
def listen(arm):
    """Begins to hear all joints on a topic."""
    begun = []

    def begin(topic='joint_states'):
        begun.append(Heard(arm, topic))
        arm.wait_driven(topic, lambda: begun[-1].messages)
        begun[-1].messages.clear()
        return begun[-1]

    yield begin
    for received in begun:
        received.done()
