"""What each station lets through: ik commands, the validator setpoints, the session frames."""

import numpy as np
import pytest

from bridge.protocol import Setpoint
from manipulator.pose import Pose

FAR = Pose.from_xyz_rpy((0.010, 0.0, 0.0412))
HIGHER = Pose.from_xyz_rpy((0.0, 0.0, 0.0452))
COUNT = 1.0
"""Half a microsecond: what rounding may change."""


def joints_at(world, pose):
    return world.machine.kinematics.inverse(pose, world.inverse.published[-1][1])


def commanded_counts(world, joints):
    """By channel, of joints in the kinematics' order."""
    names = list(world.machine.kinematics.joint_names)
    order = [names.index(name) for name in world.calibration.names]
    return np.array(world.calibration.counts(np.asarray(joints)[order]))


@pytest.mark.parametrize('goal', [FAR, HIGHER])
def test_of_a_motion_every_station_sees_the_whole_and_refuses_nothing(world, goal):
    began = world.now
    assert world.go_to(goal).result == 'reached'
    world.run(0.01)  # what is on its way
    published = [joints for t, joints in world.inverse.published if t >= began]
    admitted = [joints for t, joints in world.bridge.admitted if t >= began]
    sent = [m.counts for t, m in world.bridge.sent if t >= began and isinstance(m, Setpoint)]
    assert len(published) > 10
    assert abs(len(published) - len(admitted)) <= 1
    assert abs(len(admitted) - len(sent)) <= 1
    assert np.array_equal(sent[-1], commanded_counts(world, published[-1]))
    assert world.inverse.on_setpoint.refusals == []
    assert [why for t, why in world.bridge.refusals if t >= began] == []


def test_ik_publishes_no_command_for_a_setpoint_that_would_have_a_joint_jump(world):
    world.run(0.2)
    near, far = joints_at(world, world.machine.kinematics.home), joints_at(world, FAR)
    began = world.now
    world.links['setpoint'].send(world.controller.stamp, FAR)
    world.run(0.2)
    published = np.array([joints for t, joints in world.inverse.published if t >= began])
    assert np.abs(published - near).max() < 0.5 * np.abs(far - near).max()
    assert 'would jump' in world.inverse.on_setpoint.refusals[-1][1]
    assert world.go_to(FAR).result == 'reached'


def test_the_validator_admits_no_command_that_would_have_a_servo_jump(world):
    world.run(0.2)
    still, began = world.inverse.published[-1][1], world.now
    world.links['commands'].send(world.inverse.stamp, still + 0.6 * np.eye(6)[2])
    world.run(0.2)
    frames = world.setpoints(began)
    assert np.abs(frames - commanded_counts(world, still)).max() <= COUNT
    assert world.bridge.monitor.last_refusal == world.bridge.refusals[-1][1]
    assert 'would jump' in world.bridge.monitor.last_refusal
    assert f'{world.machine.kinematics.joint_names[2]}: ' in world.bridge.monitor.last_refusal


def test_a_machine_whose_board_holds_is_released_and_its_goal_does_not_resume(world):
    world.send_goal(FAR)
    world.run(0.3)
    world.links['commands'].loses = lambda: True
    world.wait('hold', lambda: world.state == 'holding')
    world.links['commands'].loses = lambda: False
    world.run(0.1)
    assert ('stopped', 'the machine is holding') in [
        (status.result, status.reason) for _, status in world.controller.statuses
    ]
    still = world.now
    world.run(3.0)
    assert np.abs(np.diff(world.pulses(still), axis=0)).max() <= COUNT
    assert world.status.result != 'reached'
    assert world.go_to(FAR).result == 'reached'


def test_frozen_bridge_publishes_of_what_piled_up_the_last_of_each_mode(world):
    """Else the controller would be led back to where its joints were long ago."""
    world.send_goal(FAR)
    world.run(0.3)
    arrived = []
    send = world.bridge.on_joints
    world.bridge.on_joints = lambda joints: (arrived.append(world.now), send(joints))
    world.bridge.freeze(0.4)
    world.run(0.41)
    assert 1 <= len(arrived) <= 4
