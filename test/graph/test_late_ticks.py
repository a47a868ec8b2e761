"""A trajectory node that is frozen in the middle of a tick says nothing that is too late."""

import time

import pytest
import rclpy
from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from geometry_msgs.msg import PoseStamped
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from sensor_msgs.msg import JointState

from hexarm.machines import load
from manipulator.nodes.messages import joint_message, pose_message, pose_of, seconds
from manipulator.nodes.qos import COMMAND, LATCHED, MEASUREMENT
from manipulator.nodes.steady_timer import SteadyTimer
from manipulator.nodes.trajectory_node import TrajectoryNode
from manipulator.pose import Pose
from manipulator.trajectory.pilot import POSE_DEADLINE
from manipulator.trajectory.player import Player

pytestmark = pytest.mark.graph

KINEMATICS = load('robocake').kinematics
HOME = KINEMATICS.home
HIGHER = Pose.from_xyz_rpy((0.0, 0.0, HOME.position[2] + 0.004), (0.0, 0.0, 0.0))


class StandingMachine(Node):
    """Says that it is enabled, follows, and stands at home; hears where it should go."""

    def __init__(self):
        super().__init__('standing_machine')
        self.setpoints = []
        self._states = self.create_publisher(DiagnosticStatus, 'machine_state', LATCHED)
        self._joints = self.create_publisher(JointState, 'joint_states', MEASUREMENT)
        self._poses = self.create_publisher(PoseStamped, 'pose', MEASUREMENT)
        self._goals = self.create_publisher(PoseStamped, 'goal_pose', COMMAND)
        self.create_subscription(PoseStamped, 'setpoint', self._hear, COMMAND)

    def _hear(self, message):
        self.setpoints.append((seconds(message.header.stamp), pose_of(message).position[2]))

    @property
    def now(self):
        return self.get_clock().now().to_msg()

    def say_where_it_is(self):
        values = [KeyValue(key='followed', value='yes')]
        self._states.publish(DiagnosticStatus(message='enabled', values=values))
        joints = KINEMATICS.inverse(HOME)
        self._joints.publish(joint_message(joints, KINEMATICS.joint_names, self.now))
        self._poses.publish(pose_message(HOME, self.now))

    def send_up(self):
        self._goals.publish(pose_message(HIGHER, self.now))


@pytest.fixture
def machine():
    """The machine and its trajectory node, spun by `machine.wait`."""
    rclpy.init()
    machine, trajectory = StandingMachine(), TrajectoryNode(load, 'robocake')
    executor = EventsExecutor()
    executor.add_node(machine)
    executor.add_node(trajectory)
    SteadyTimer(machine, 0.02, machine.say_where_it_is)

    def wait(is_so):
        end = time.monotonic() + 20.0
        while not is_so():
            assert time.monotonic() < end
            executor.spin_once(timeout_sec=0.1)

    machine.wait = wait
    yield machine
    trajectory.close()
    executor.shutdown()
    trajectory.destroy_node()
    machine.destroy_node()
    rclpy.shutdown()


def test_tick_that_was_frozen_for_too_long_says_no_setpoint(machine, monkeypatch):
    resumed = []
    step = Player.step

    def freezing(player):
        pose = step(player)
        if not resumed and pose.position[2] > HOME.position[2] + 0.001:
            time.sleep(POSE_DEADLINE + 0.1)
            resumed.append(time.time())
        return pose

    monkeypatch.setattr(Player, 'step', freezing)
    machine.wait(lambda: machine.setpoints)
    machine.send_up()
    machine.wait(lambda: resumed and machine.setpoints[-1][0] > resumed[0] + 0.1)
    before = [height for stamp, height in machine.setpoints if stamp < resumed[0]]
    afterwards = [height for stamp, height in machine.setpoints if stamp >= resumed[0]]
    assert max(before) > HOME.position[2] + 0.0005
    assert afterwards == pytest.approx([HOME.position[2]] * len(afterwards), abs=1e-9)
