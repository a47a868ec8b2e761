"""An arm's URDF, evaluated by MuJoCo, which shares no line with our kinematics."""

import xml.etree.ElementTree as ET
from itertools import pairwise

import mujoco
import numpy as np
import pytest

from arm_control.urdf import urdf
from hexarm import machines

ARMS = ('arm_6r', 'ur5', 'puma560')
AS_IT_IS = (
    '<mujoco><compiler fusestatic="false" discardvisual="false" boundmass="1" boundinertia="1"/>'
    '</mujoco>'
)
"""Without it MuJoCo leaves out fixed links and rods that are only drawn, and wants masses."""


@pytest.fixture(scope='module', params=ARMS)
def arm(request):
    return machines.load(request.param).kinematics


@pytest.fixture(scope='module')
def text(arm):
    return urdf('arm', arm, [0.03] * 6, [float(i) for i in range(6)])


@pytest.fixture(scope='module')
def model(text):
    return mujoco.MjModel.from_xml_string(text.replace('</robot>', f'{AS_IT_IS}</robot>'))


def evaluated(model, joints, body):
    """Where MuJoCo puts a body: position and rotation matrix in the world."""
    state = mujoco.MjData(model)
    for i, angle in enumerate(joints):
        state.joint(f'joint_{i + 1}').qpos = angle
    mujoco.mj_kinematics(model, state)
    return state.body(body).xpos.copy(), state.body(body).xmat.reshape(3, 3).copy()


def postures(arm):
    rng = np.random.default_rng(5)
    return rng.uniform(arm.limits.low, arm.limits.high, (100, 6))


def test_tool_is_where_forward_kinematics_says(arm, model):
    for joints in postures(arm):
        pose = arm.forward(joints).pose
        position, rotation = evaluated(model, joints, 'platform')
        assert np.abs(position - pose.position).max() < 1e-9
        assert np.abs(rotation - pose.rotation).max() < 1e-9


def test_links_are_where_the_transforms_say(arm, model):
    for joints in postures(arm)[:20]:
        for link in arm.links(arm.forward(joints).pose, joints):
            position, rotation = evaluated(model, joints, link.name)
            assert np.abs(position - link.pose.position).max() < 1e-9
            assert np.abs(rotation - link.pose.rotation).max() < 1e-9


def test_limits_are_those_of_the_machine_file(arm, text):
    limits = [joint.find('limit').attrib for joint in ET.fromstring(text).findall('joint')[:6]]
    for key, expected in (
        ('lower', arm.limits.low),
        ('upper', arm.limits.high),
        ('velocity', arm.limits.speed),
        ('effort', np.arange(6)),
    ):
        np.testing.assert_allclose([float(limit[key]) for limit in limits], expected, rtol=1e-12)


def test_drawn_rods_reach_from_joint_to_joint(arm, model):
    joints = postures(arm)[0]
    state = mujoco.MjData(model)
    for i, angle in enumerate(joints):
        state.joint(f'joint_{i + 1}').qpos = angle
    mujoco.mj_kinematics(model, state)
    (line,) = (stroke.points for stroke in arm.skeleton(arm.forward(joints).pose, joints))
    centres, halves = state.geom_xpos, model.geom_size[:, 1]
    for begin, end in pairwise(line):
        length = np.linalg.norm(end - begin)
        if length > 1e-6:
            fits = np.abs(centres - (begin + end) / 2).max(axis=1) < 1e-9
            fits &= np.abs(2 * halves - length) < 1e-9
            (geom,) = np.flatnonzero(fits)
            along = state.geom_xmat[geom].reshape(3, 3)[:, 2]
            assert np.linalg.norm(np.cross(along, end - begin)) < 1e-9
