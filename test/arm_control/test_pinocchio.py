"""Another library's model of the shipped arms, from the published tables by none of our code."""

import numpy as np
import pytest

from arm_control.load import serial_arm
from bench.peers.pinocchio_arm import PinocchioArm
from bench.peers.published_arms import TABLES


@pytest.mark.parametrize('name', TABLES)
def test_pose_and_jacobian_agree_with_pinocchio(machine_file, name):
    arm, theirs = serial_arm(machine_file(name)), PinocchioArm(name)
    for q in np.random.default_rng(8).uniform(arm.limits.low, arm.limits.high, (500, 6)):
        pose, expected = arm.chain.forward(q), theirs.forward(q)
        assert np.abs(pose.rotation - expected[:3, :3]).max() < 1e-9
        assert np.abs(pose.position - expected[:3, 3]).max() < 1e-9
        assert np.abs(arm.chain.jacobian(q) - theirs.jacobian(q)).max() < 1e-9
