"""Shipped arms against the joint origins of their makers' URDFs, multiplied by definition.

A row is xyz in metres and rpy in radians of a joint's frame in the one before, and its axis; None
for a fixed one. URDFs round right angles (1.5708), which the machine files do not.
"""

import numpy as np
import pytest

from arm_control.load import serial_arm
from manipulator.rotation import exp, from_rpy

Q, O3 = np.pi / 2, (0.0, 0.0, 0.0)
X, Y, Z = np.eye(3)
SOURCES = {
    'ur3e': [
        (O3, (0, 0, np.pi), None),
        ((0, 0, 0.15185), O3, Z),
        (O3, (1.570796327, 0, 0), Z),
        ((-0.24355, 0, 0), O3, Z),
        ((-0.2132, 0, 0.13105), O3, Z),
        ((0, -0.08535, -1.750557762378351e-11), (1.570796327, 0, 0), Z),
        ((0, 0.0921, -1.8890025766262e-11), (1.570796326589793, np.pi, np.pi), Z),
        (O3, (0, -Q, -Q), None),
        (O3, (Q, 0, Q), None),
    ],
    'xarm6': [
        ((0, 0, 0.267), O3, Z),
        (O3, (-1.5708, 0, 0), Z),
        ((0.0535, -0.2845, 0), O3, Z),
        ((0.0775, 0.3425, 0), (-1.5708, 0, 0), Z),
        (O3, (1.5708, 0, 0), Z),
        ((0.076, 0.097, 0), (-1.5708, 0, 0), Z),
    ],
    'vx300s': [
        ((0, 0, 0.079), O3, Z),
        ((0, 0, 0.04805), O3, Y),
        ((0.05955, 0, 0.3), O3, Y),
        ((0.2, 0, 0), O3, X),
        ((0.1, 0, 0), O3, Y),
        ((0.069744, 0, 0), O3, X),
        ((0.042825 + 0.025875 + 0.0385, 0, 0), O3, None),
    ],
    'ar4_mk3': [
        (O3, (np.pi, 0, 0), Z),
        ((0, 0.0642, -0.16977), (1.5708, 0, -1.5708), -Z),
        ((0, -0.305, 0.007), (0, 0, 3.1416), -Z),
        (O3, (1.5708, 0, -1.5708), -Z),
        ((0, 0, -0.22263), (np.pi, 0, -1.5708), X),
        ((0, 0, 0.041), (0, 0, 3.1416), Z),
    ],
    'niryo_one': [
        ((0, 0, 0.103), O3, Z),
        ((0, 0, 0.08), (Q, -Q, 0), Z),
        ((0.21, 0, 0), (0, 0, -Q), Z),
        ((0.0415, 0.03, 0), (0, Q, 0), Z),
        ((0, 0, 0.18), (0, -Q, 0), Z),
        ((0.0164, -0.0055, 0), (0, Q, 0), Z),
        ((0, 0, 0.0073), (-Q, -Q, 0), None),
    ],
    'irb120': [
        (O3, O3, Z),
        ((0, 0, 0.29), O3, Y),
        ((0, 0, 0.27), O3, Y),
        ((0, 0, 0.07), O3, X),
        ((0.302, 0, 0), O3, Y),
        ((0.072, 0, 0), O3, X),
    ],
}

NUMERICAL = ('xarm6', 'niryo_one')
"""Arms without a closed form: offsets at the wrist."""


def tool_of(rows, joints):
    frame, angles = np.eye(4), iter(joints)
    for xyz, rpy, axis in rows:
        step = np.eye(4)
        step[:3, 3], step[:3, :3] = xyz, from_rpy(rpy)
        if axis is not None:
            step[:3, :3] = step[:3, :3] @ exp(next(angles) * axis)
        frame = frame @ step
    return frame


@pytest.mark.parametrize('name', SOURCES)
def test_tool_is_where_the_makers_urdf_puts_it(machine_file, name):
    kinematics = serial_arm(machine_file(name))
    assert kinematics.is_explicit == (name not in NUMERICAL)
    for joints in (np.zeros(6), kinematics.rest, np.array([0.3, -0.4, 0.2, 0.5, -0.6, 0.7])):
        expected, pose = tool_of(SOURCES[name], joints), kinematics.chain.forward(joints)
        assert np.abs(pose.position - expected[:3, 3]).max() < 2e-5
        assert np.abs(pose.rotation - expected[:3, :3]).max() < 4e-5
