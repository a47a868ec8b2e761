"""The same graph drives linear legs: joints in metres, servos in millimetres."""

import re

import numpy as np
import pytest
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import JointState

from hexarm.graph import Graph, machine_graph
from hexarm.machines import find, load
from manipulator.errors import Refused
from manipulator.nodes.messages import joints_of, pose_of
from manipulator.nodes.qos import MEASUREMENT
from manipulator.pose import Pose

pytestmark = [pytest.mark.graph, pytest.mark.real_time]
PULSE = 0.5 / 10.0 * 1e-3  # half a microsecond at 10 µs/mm
PLAY = 0.2e-3


@pytest.fixture(scope='module', params=['stewart_6_6', 'stewart_6_3'])
def patient_stewart(request, tmp_path_factory):
    """A linear platform whose board waits longer than a busy test machine may stall."""
    text = find(request.param).read_text()
    patient = tmp_path_factory.mktemp('machine') / f'{request.param}.yaml'
    patient.write_text(re.sub('setpoint_deadline_ms: .*', 'setpoint_deadline_ms: 1000', text))
    return str(patient)


@pytest.fixture(scope='module')
def hexapod_graph(patient_stewart, tmp_path_factory):
    link = tmp_path_factory.mktemp('port') / 'board'
    with Graph(machine_graph('hexapod', patient_stewart, 'fake', link), 'hexapod') as graph:
        yield graph


@pytest.fixture
def kinematics(patient_stewart):
    return load(patient_stewart).kinematics


def last_heard(user, kind, topic):
    heard = []
    subscription = user.node.create_subscription(kind, topic, heard.append, MEASUREMENT)
    user.wait(topic, lambda: len(heard) > 3, 5.0)
    user.node.destroy_subscription(subscription)
    return heard[-1]


def test_goal_is_reached_in_legs_of_metres_and_in_pose(enabled, kinematics):
    goal = Pose.from_xyz_rpy((0.01, -0.008, 0.195), (0.05, 0.03, 0.1))
    enabled.go_to(goal, 20.0)
    enabled.spin(0.3)
    legs = joints_of(last_heard(enabled, JointState, 'joint_states'), kinematics.joint_names)
    assert np.abs(legs - kinematics.inverse(goal)).max() < PULSE + PLAY
    error = goal.twist_to(pose_of(last_heard(enabled, PoseStamped, 'pose')))
    assert np.abs(error[:3]).max() < 0.0005
    assert np.abs(error[3:]).max() < 0.01


def test_goal_beyond_the_stroke_is_refused_with_its_leg_and_the_next_one_works(enabled):
    with pytest.raises(Refused, match=r'leg \d: leg length 0\.2\d+ m outside \[0\.142, 0\.238\]'):
        enabled.go_to(Pose.from_xyz_rpy((0.0, 0.0, 0.26)))
    enabled.go_to(Pose.from_xyz_rpy((0.0, 0.0, 0.19)), 20.0)
