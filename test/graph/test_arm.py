"""The whole graph of the serial arm, on stepper drives with encoders, seen from outside."""

import re
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import numpy as np
import pytest
from geometry_msgs.msg import PointStamped, PoseStamped, TwistStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, String

from hexarm.client import Client
from hexarm.graph import Graph, machine_graph
from hexarm.machines import load
from hexarm.up import check_alive
from manipulator.errors import Refused
from manipulator.nodes.messages import joints_of, seconds
from manipulator.nodes.qos import COMMAND, MEASUREMENT

pytestmark = pytest.mark.graph

MACHINE = load('arm_6r_stepper')
HOME = MACHINE.kinematics.home
NAMES = MACHINE.kinematics.joint_names
DT = 0.01
PERIOD = 0.02


@pytest.fixture(scope='module')
def arm_graph(tmp_path_factory):
    """The arm's five processes; its board waits longer than a busy test machine may stall."""
    folder = tmp_path_factory.mktemp('arm')
    shipped = Path(__file__).resolve().parents[2] / 'config' / 'arm_6r_stepper.yaml'
    patient = re.sub('setpoint_deadline_ms: .*', 'setpoint_deadline_ms: 1000', shipped.read_text())
    (folder / 'arm.yaml').write_text(patient)
    nodes = machine_graph('arm', str(folder / 'arm.yaml'), 'fake', folder / 'board')
    with Graph(nodes, 'arm') as graph:
        yield graph


@pytest.fixture(scope='module')
def user(arm_graph):
    with Client('arm', lambda: check_alive(arm_graph)) as client:
        client.enable()
        yield client


@pytest.fixture
def arm(user):
    """The enabled arm at home, in the plain jog mode."""
    user.wait('standing still', lambda: user.motion('mode') == 'hold', 5.0)
    user.home()
    return user


class Joystick:
    """Twists on cmd_vel/joy while the deadman is held, as joy_teleop publishes them."""

    def __init__(self, user):
        self.user = user
        self.publisher = user.node.create_publisher(TwistStamped, 'cmd_vel/joy', COMMAND)
        self.modes = user.node.create_publisher(String, 'jog_mode', COMMAND)
        self.points = user.node.create_publisher(PointStamped, 'look_at', COMMAND)
        for publisher in (self.publisher, self.modes, self.points):
            user.wait('a listener', lambda p=publisher: p.get_subscription_count() > 0, 10.0)

    def mode(self, name, point=None):
        if point is not None:
            message = PointStamped()
            message.point.x, message.point.y, message.point.z = map(float, point)
            self.points.publish(message)
        self.modes.publish(String(data=name))
        self.user.spin(0.1)

    def send(self, twist=(0, 0, 0, 0, 0, 0), frame=''):
        message = TwistStamped()
        message.header.stamp = self.user.node.get_clock().now().to_msg()
        message.header.frame_id = frame
        v, w = message.twist.linear, message.twist.angular
        v.x, v.y, v.z, w.x, w.y, w.z = map(float, twist)
        self.publisher.publish(message)

    def hold(self, twist, duration):
        end = time.monotonic() + duration
        while time.monotonic() < end:
            self.send(twist)
            self.user.spin(PERIOD)


class Heard:
    """All joint states (or commands) since it began."""

    def __init__(self, user, topic='joint_states'):
        self.messages = []
        self.node = user.node
        self.subscription = user.node.create_subscription(
            JointState, topic, self.messages.append, MEASUREMENT
        )
        user.wait(topic, lambda: bool(self.messages), 5.0)
        self.messages.clear()

    @property
    def joints(self):
        return np.array([joints_of(m, NAMES) for m in self.messages])

    @property
    def stamps(self):
        return np.array([seconds(m.header.stamp) for m in self.messages])

    @property
    def poses(self):
        return [MACHINE.kinematics.forward(q).pose for q in self.joints]

    def done(self):
        self.node.destroy_subscription(self.subscription)


@pytest.fixture
def joystick(arm):
    made = Joystick(arm)
    made.mode('free')
    yield made
    made.mode('free')
    for publisher in (made.publisher, made.modes, made.points):
        arm.node.destroy_publisher(publisher)


def check_held(what, errors, bound, unit):
    """At the end and at every moment on the way; the figures are printed."""
    end, rms, worst = errors[-1], np.sqrt(np.mean(np.square(errors))), max(errors)
    figures = ', '.join(f'{v:.3f}{unit}' for v in (end, rms, worst))
    print(f'{what}: error at the end, rms, max {figures}')
    assert worst < bound, figures


def check_smooth(heard):
    """No step of position or velocity beyond the joints' limits, tick by tick."""
    limits = MACHINE.motion.joint
    joints, gaps = heard.joints, np.diff(heard.stamps)
    steps = np.diff(joints, axis=0)
    regular = np.abs(gaps - DT) < 0.4 * DT
    assert regular.mean() > 0.5
    assert (np.abs(steps[regular]) <= 1.01 * limits.speed * DT).all()
    both = regular[1:] & regular[:-1]
    assert (np.abs(np.diff(steps, axis=0))[both] <= 1.01 * limits.acceleration * DT**2).all()


def test_goal_is_reached_and_the_encoders_say_so(arm):
    goal = HOME.moved([0.1, -0.05, 0.05, 0.0, 0.2, 0.1])
    heard = Heard(arm)
    arm.go_to(goal)
    arm.spin(0.2)
    error = heard.poses[-1].twist_to(goal)
    assert np.abs(error[:3]).max() < 5e-4
    assert np.abs(error[3:]).max() < np.radians(0.05)


def test_goal_out_of_reach_is_refused_in_words(arm):
    with pytest.raises(Refused, match='reach is'):
        arm.go_to(HOME.moved([1.0, 0, 0, 0, 0, 0]))


def test_cycle_swings_until_it_is_stopped(arm):
    heard = Heard(arm)
    arm.trigger('trajectory/start_cycle')
    arm.wait('cycling', lambda: arm.motion('mode') == 'cycle', 5.0)
    arm.spin(2.5)
    assert np.ptp([pose.position[0] for pose in heard.poses]) > 0.004
    arm.trigger('trajectory/stop')
    arm.wait('stopping', lambda: arm.motion('result') == 'stopped', 5.0)


def test_held_orientation_stays_within_a_tenth_of_a_degree_over_a_metre(arm, joystick):
    joystick.mode('hold_orientation')
    heard = Heard(arm)
    for vx in (0.2, -0.2, 0.2):
        joystick.hold([vx, 0, 0, 0, 0, 0], 1.5 if vx > 0 else 3.0)
    poses = heard.poses
    way = np.linalg.norm(np.diff([p.position for p in poses], axis=0), axis=1).sum()
    assert way > 0.9
    turned = [np.degrees(np.linalg.norm(poses[0].twist_to(pose)[3:])) for pose in poses]
    check_held('orientation', turned, 0.1, '°')


def test_turning_holds_the_tool_point_within_half_a_millimetre(arm, joystick):
    joystick.mode('turn_base_z')
    heard = Heard(arm)
    for wz in (0.5, -0.5):
        joystick.hold([0, 0, 0, 0, 0, wz], 1.5)
    poses = heard.poses
    assert max(np.linalg.norm(poses[0].twist_to(p)[3:]) for p in poses) > 0.5
    shifts = [1e3 * np.linalg.norm(poses[0].twist_to(p)[:3]) for p in poses]
    check_held('tool point', shifts, 0.5, ' mm')


def test_look_at_keeps_pointing_at_one_point_while_moving(arm, joystick):
    point = HOME.position + 0.3 * HOME.rotation[:, 2]
    joystick.mode('look_at', point)
    heard = Heard(arm)
    joystick.hold([0.1, 0, 0, 0, 0, 0], 1.5)
    joystick.send()
    missed = [np.linalg.norm(np.cross(p.rotation[:, 2], point - p.position)) for p in heard.poses]
    check_held('sight', [1e3 * m for m in missed], 0.5, ' mm')
    assert heard.poses[-1].position[0] - heard.poses[0].position[0] > 0.1


def test_release_stops_within_a_third_of_a_second(arm, joystick):
    commands = Heard(arm, 'joint_command')
    joystick.hold([0.2, 0, 0, 0, 0, 0], 1.0)
    assert arm.motion('mode') == 'jog'
    joystick.send()
    released = time.time()
    arm.spin(1.0)
    moving = np.abs(np.diff(commands.joints, axis=0)).max(axis=1) > 0
    assert commands.stamps[1:][moving][-1] - released < 0.35
    assert (arm.motion('mode'), arm.motion('result')) == ('hold', 'idle')
    check_smooth(commands)


def test_joystick_overrides_a_goal_in_motion_smoothly_and_the_goal_does_not_resume(arm, joystick):
    commands = Heard(arm, 'joint_command')
    stamp = arm.publish_goal(HOME.moved([0.25, 0, 0, 0, 0, 0]))
    arm.wait('moving', lambda: arm.motion('mode') == 'move', 5.0)
    arm.spin(0.5)
    statuses = []
    end = time.monotonic() + 1.0
    while time.monotonic() < end:
        joystick.send([0, 0, 0.1, 0, 0, 0])
        arm.spin(PERIOD)
        statuses.append((arm.motion('goal_stamp'), arm.motion('result'), arm.motion('mode')))
    assert (f'{stamp:.9f}', 'moving', 'move') in statuses
    assert statuses[-1][1:] == ('moving', 'jog')
    with pytest.raises(Refused, match='cmd_vel/joy has the machine'):
        joystick.send([0, 0, 0.1, 0, 0, 0])
        arm.go_to(HOME)
    joystick.send()
    arm.spin(1.0)
    rest = commands.joints[-1]
    arm.spin(0.5)
    assert np.array_equal(commands.joints[-1], rest)
    assert arm.motion('mode') == 'hold'
    assert MACHINE.kinematics.forward(rest).pose.position[2] > HOME.position[2] + 0.03
    check_smooth(commands)


def test_killed_source_stops_the_arm(arm):
    script = textwrap.dedent(
        """
        import time, rclpy
        from geometry_msgs.msg import TwistStamped
        rclpy.init()
        node = rclpy.create_node('doomed')
        publisher = node.create_publisher(TwistStamped, '/arm/cmd_vel/panel', 1)
        message = TwistStamped()
        message.twist.linear.x = 0.1
        while True:
            message.header.stamp = node.get_clock().now().to_msg()
            publisher.publish(message)
            time.sleep(0.02)
        """
    )
    source = subprocess.Popen([sys.executable, '-c', script])
    try:
        arm.wait('jogging', lambda: arm.motion('mode') == 'jog', 20.0)
        arm.spin(0.3)
    finally:
        source.kill()
        source.wait()
    arm.wait('standing still', lambda: arm.motion('mode') == 'hold', 2.0)


def test_bad_twists_modes_and_frames_are_refused_and_the_arm_stays(arm, joystick):
    heard = Heard(arm)
    joystick.mode('upside_down')
    for twist, frame in (([np.nan, 0, 0, 0, 0, 0], ''), ([0.1, 0, 0, 0, 0, 0], 'moon')):
        for _ in range(10):
            joystick.send(twist, frame)
            arm.spin(PERIOD)
    arm.spin(1.0)
    assert np.ptp(heard.joints, axis=0).max() < 1e-3
    told = {v.key: v.value for v in arm.diagnostics['arm/trajectory'].values}
    assert told['jog_mode'] == 'free'
    assert int(told['twists_refused']) >= 10
    assert "'moon' is not one of" in told['last_twist_refusal']


def test_twist_above_the_limits_is_scaled_and_said(arm, joystick):
    joystick.hold([0, 0, 2.0, 0, 0, 0], 0.3)
    assert 'scaled to' in arm.motion('reason')
    assert 'speed limits' in arm.motion('reason')


def test_stop_ends_a_jog_until_the_stick_is_let_go(arm, joystick):
    joystick.hold([0, 0, 0.05, 0, 0, 0], 0.3)
    arm.trigger('trajectory/stop')
    joystick.hold([0, 0, 0.05, 0, 0, 0], 0.6)
    assert (arm.motion('mode'), arm.motion('result')) == ('hold', 'stopped')
    arm.spin(0.5)
    joystick.hold([0, 0, -0.05, 0, 0, 0], 0.3)
    assert arm.motion('mode') == 'jog'


def test_gripper_opens_while_the_arm_stands(arm):
    gripper = arm.node.create_publisher(Float64, 'gripper', COMMAND)
    arm.wait('a listener', lambda: gripper.get_subscription_count() > 0, 10.0)
    heard = Heard(arm)
    gripper.publish(Float64(data=1.0))
    arm.wait(
        'the gripper',
        lambda: (
            joints_of(heard.messages[-1], ('gripper',))[0] > np.radians(49.0)
            if heard.messages
            else False
        ),
        5.0,
    )
    assert np.ptp(heard.joints, axis=0).max() < 1e-3


def test_home_pose_is_heard_on_pose(arm):
    poses = []
    arm.node.create_subscription(PoseStamped, 'pose', poses.append, MEASUREMENT)
    arm.wait('a pose', lambda: len(poses) > 3, 5.0)
    p = poses[-1].pose.position
    assert np.abs(np.array([p.x, p.y, p.z]) - HOME.position).max() < 5e-4
