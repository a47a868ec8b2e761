"""Another library's model of the shipped arms, from the published tables by none of our code."""

import numpy as np
import pinocchio as pin
import pytest

from arm_control.load import serial_arm

QUARTER = np.pi / 2
TABLES = {  # standard Denavit–Hartenberg: a (m), alpha (rad), d (m)
    'ur5': (  # Universal Robots, "DH Parameters for calculations of kinematics and dynamics"
        (0.0, QUARTER, 0.089159),
        (-0.425, 0.0, 0.0),
        (-0.39225, 0.0, 0.0),
        (0.0, QUARTER, 0.10915),
        (0.0, -QUARTER, 0.09465),
        (0.0, 0.0, 0.0823),
    ),
    'puma560': (  # P. Corke, B. Armstrong-Hélouvry, ICRA 1994
        (0.0, QUARTER, 0.67183),
        (0.4318, 0.0, 0.0),
        (0.0203, -QUARTER, 0.15005),
        (0.0, QUARTER, 0.4318),
        (0.0, -QUARTER, 0.0),
        (0.0, 0.0, 0.0),
    ),
}


def model_of(table):
    """Pinocchio's model; its last frame is the tool."""
    model, joint, place = pin.Model(), 0, pin.SE3.Identity()
    for k, (a, alpha, d) in enumerate(table):
        joint = model.addJoint(joint, pin.JointModelRZ(), place, f'joint_{k + 1}')
        place = pin.SE3(pin.utils.rotate('x', alpha), np.array([a, 0.0, d]))
    model.addFrame(pin.Frame('tool', joint, 0, place, pin.FrameType.OP_FRAME))
    return model


@pytest.mark.parametrize('name', TABLES)
def test_pose_and_jacobian_agree_with_pinocchio(machine_file, name):
    arm, model = serial_arm(machine_file(name)), model_of(TABLES[name])
    data, tool = model.createData(), model.getFrameId('tool')
    axes = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    for q in np.random.default_rng(8).uniform(arm.limits.low, arm.limits.high, (500, 6)):
        jacobian = pin.computeFrameJacobian(model, data, q, tool, axes)
        pin.forwardKinematics(model, data, q)
        expected = pin.updateFramePlacement(model, data, tool)
        pose = arm.chain.forward(q)
        assert np.abs(pose.rotation - expected.rotation).max() < 1e-9
        assert np.abs(pose.position - expected.translation).max() < 1e-9
        assert np.abs(arm.chain.jacobian(q) - jacobian).max() < 1e-9
