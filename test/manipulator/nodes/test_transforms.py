"""What goes out on /tf: a tree whose transforms lead from the base to every frame."""

import numpy as np
import pytest
from builtin_interfaces.msg import Time

from hexarm import machines
from manipulator.frames import Frames
from manipulator.nodes.pose_node import transforms
from manipulator.pose import Pose

STAMP = Time(sec=7, nanosec=9)
FRAMES = Frames(Pose.from_xyz_rpy((0.1, 0.0, 0.2), (0.0, 0.0, 0.5))).with_pivot([0.0, 0.01, 0.02])


def reported(name, prefix=''):
    kinematics = machines.load(name).kinematics
    pose = kinematics.home
    joints = kinematics.inverse(pose)
    return transforms(kinematics.links(pose, joints), FRAMES, prefix, STAMP), pose


def in_root(messages, frame):
    """T_root_frame by following the parents."""
    by_child = {m.child_frame_id: m for m in messages}
    pose = Pose.identity()
    while frame in by_child:
        message = by_child[frame]
        t, q = message.transform.translation, message.transform.rotation
        pose = Pose.from_xyz_quaternion((t.x, t.y, t.z), (q.x, q.y, q.z, q.w)) @ pose
        frame = message.header.frame_id
    return frame, pose


@pytest.mark.parametrize('name', ['robocake', 'stewart_6_6', 'arm_6r'])
def test_every_frame_hangs_on_the_base_by_one_parent(name):
    messages, pose = reported(name)
    children = [m.child_frame_id for m in messages]
    assert len(children) == len(set(children))
    assert {in_root(messages, child)[0] for child in children} == {'base'}
    assert {(m.header.stamp.sec, m.header.stamp.nanosec) for m in messages} == {(7, 9)}
    assert np.abs(pose.twist_to(in_root(messages, 'platform')[1])).max() < 1e-12


def test_pivot_and_work_frame_are_the_users():
    messages, pose = reported('robocake')
    _, pivot = in_root(messages, 'pivot')
    _, work = in_root(messages, 'work')
    assert np.abs(FRAMES.pivot(pose).twist_to(work.inverse() @ pivot)).max() < 1e-12


def test_prefix_stands_before_every_frame():
    frames = {
        f for m in reported('arm_6r', 'lab/arm_')[0] for f in (m.header.frame_id, m.child_frame_id)
    }
    assert {f.removeprefix('lab/arm_') for f in frames} == {
        *('base', 'work', 'platform', 'pivot'),
        *(f'link_{i}' for i in range(1, 7)),
    }
    assert all(f.startswith('lab/arm_') for f in frames)
