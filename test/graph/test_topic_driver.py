"""A machine whose joints another driver moves: the whole graph, with a driver in this process."""

import numpy as np
import pytest
import yaml
from sensor_msgs.msg import JointState

from hexarm.graph import Graph, check_alive, machine_graph
from hexarm.machines import load, read
from manipulator.nodes.messages import joints_of
from manipulator.nodes.qos import COMMAND
from patient_user import PatientUser

pytestmark = pytest.mark.graph

REPORTS, COMMANDS = 'driver/joint_states', 'driver/joint_command'
START = np.array([0.3, -1.2, 1.1, -1.5, -1.4, 0.2])
LAG = 0.3
"""Of the distance to the newest command, what the driver goes in a hundredth of a second."""


class Driver:
    """Of a maker: reports its joints and its gripper's, and follows commands with a lag."""

    def __init__(self, user, names):
        self.names, self.joints, self.target = names, START.copy(), None
        self.commands, self.is_silent, self.node = [], False, user.node
        self.reports = user.node.create_publisher(JointState, REPORTS, 10)
        user.node.create_subscription(JointState, COMMANDS, self.follow, COMMAND)
        user.node.create_timer(0.01, self.turn)

    def follow(self, message):
        self.target = joints_of(message, self.names)
        self.commands.append(self.target)

    def turn(self):
        if self.target is not None:
            self.joints = self.joints + LAG * (self.target - self.joints)
        message = JointState(name=['finger', *self.names], position=[0.01, *self.joints.tolist()])
        message.header.stamp = self.node.get_clock().now().to_msg()
        if not self.is_silent:
            self.reports.publish(message)


@pytest.fixture(scope='module')
def file(tmp_path_factory):
    content = {'kind': 'serial_arm', 'driver': 'topic'}
    shipped = read('ur5')
    joints = [{**row, 'name': f'left_{i}'} for i, row in enumerate(shipped.limits['joints'])]
    motion = {key: value for key, value in vars(shipped.motion).items() if value is not None}
    content |= {'geometry': shipped.geometry, 'motion': motion}
    content['limits'] = {**shipped.limits, 'joints': joints}
    path = tmp_path_factory.mktemp('arm') / 'left.yaml'
    path.write_text(yaml.safe_dump(content))
    return str(path)


@pytest.fixture(scope='module')
def user(file, tmp_path_factory):
    nodes = machine_graph(file, REPORTS, tmp_path_factory.mktemp('link') / 'board')
    with (
        Graph(nodes, 'arm') as graph,
        PatientUser('arm', lambda: check_alive(graph)) as client,
    ):
        yield client


def test_a_driver_is_commanded_from_where_it_is_to_the_goal_and_not_without_its_joints(
    user, file, interfaces
):
    kinematics = load(file).kinematics
    user.wait_for_state('disconnected')
    driver = Driver(user, kinematics.joint_names)
    user.wait_for_state('disarmed')
    section = 'serial_bridge without a board'
    interfaces.assert_documented(user, 'serial_bridge', section, '/arm')
    assert driver.commands == []
    user.make_ready()
    goal = kinematics.forward(START).pose.moved([0.05, 0.0, -0.05, 0.0, 0.1, 0.0])

    def missed_by():
        return np.abs(kinematics.forward(driver.joints).pose.twist_to(goal)).max()

    def go():
        user.go_to(goal)
        user.wait_while_driven('the goal', lambda: missed_by() < 1e-3)

    user.persist(go)
    assert np.abs(driver.commands[0] - START).max() < 1e-3
    driver.is_silent = True
    user.wait_for_state('disconnected')
    user.wait('rest', lambda: user.motion('mode') == 'disabled')
    driver.is_silent = False
    user.wait_for_state('disarmed')
    sent = len(driver.commands)
    user.spin(0.3)
    assert len(driver.commands) == sent
