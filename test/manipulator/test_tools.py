"""Tools by name: frames with an orientation, of which one is in force."""

from dataclasses import replace

import numpy as np
import pytest

from hexarm.machines import load
from manipulator.errors import ConfigError, InvalidInput
from manipulator.framed_machine import in_frames
from manipulator.frames import Frames, FramesConfig, ToolConfig
from manipulator.limits.limit import Search
from manipulator.pose import Pose
from manipulator.teleop.jogger import JogMotion, in_work_axes
from manipulator.unit_hints import check_tool

POINT, TURN = (4.0, 10.0, 25.0), (20.0, -35.0, 60.0)
WORK = FramesConfig((100.0, -50.0, 20.0), (10.0, 20.0, 30.0))
CONFIGS = (ToolConfig('laser', POINT, TURN), ToolConfig('probe', POINT))
FRAMES = Frames.from_config(WORK, CONFIGS)
ALIKE = FRAMES.with_tool('probe')
"""The same point, with the platform's axes."""
A_TURN = Pose(np.zeros(3), FRAMES.T_platform_pivot.rotation)


def test_the_first_tool_is_in_force_until_another_is_chosen():
    assert FRAMES.tool == 'laser'
    offset = Pose.from_xyz_rpy(1e-3 * np.array(POINT), np.radians(TURN))
    assert np.abs(FRAMES.T_platform_pivot.twist_to(offset)).max() < 1e-15
    assert ALIKE.tool == 'probe'
    bare = ALIKE.with_tool('')
    assert bare.tool == ''
    assert not np.any(Pose.identity().twist_to(bare.T_platform_pivot))
    assert bare.with_tool('laser').T_platform_pivot is FRAMES.tools[0].T_platform_tool


def test_a_pivot_takes_the_place_of_the_tool():
    frames = FRAMES.with_pivot([0.0, 0.0, 0.01])
    assert frames.tool == ''
    np.testing.assert_array_equal(frames.T_platform_pivot.rotation, np.eye(3))
    assert frames.with_tool('laser').tool == 'laser'


@pytest.mark.parametrize(('name', 'shown'), [('lasr', "'lasr'"), ('x' * 5000, "'x")])
def test_a_tool_that_the_machine_has_not_is_refused_by_name(name, shown):
    with pytest.raises(InvalidInput, match=f'no tool is called {shown}.*laser, probe') as raised:
        FRAMES.with_tool(name)
    assert len(str(raised.value)) < 200


def test_tools_of_one_name_and_pivots_beside_tools_are_named():
    two = (*CONFIGS, ToolConfig('laser', POINT))
    with pytest.raises(ConfigError) as raised:
        Frames.from_config(FramesConfig(pivot_xyz_mm=(0.0, 0.0, 1.0)), two)
    assert raised.value.problems == (
        "tools[2].name: 'laser' is the name of tools[0]",
        'frames.pivot_xyz_mm: without a use beside tools, which have points',
    )


@pytest.mark.parametrize('name', ['robocake', 'arm_6r'])
def test_jacobian_is_the_derivative_of_the_tools_pose(name):
    machine, h = in_frames(load(name), FRAMES), 1e-6
    kinematics = machine.kinematics
    pose = kinematics.home.moved([2e-3, -1e-3, 2e-3, 0.03, 0.02, -0.04])
    joints = kinematics.inverse(pose)
    jacobian = kinematics.jacobian(pose, joints)
    for k, step in enumerate(h * np.eye(6)):
        ahead, behind = (kinematics.forward(joints + s * step, pose).pose for s in (1, -1))
        np.testing.assert_allclose(jacobian[:, k], behind.twist_to(ahead) / (2 * h), atol=1e-6)


@pytest.mark.parametrize('name', ['robocake', 'stack_6_6', 'arm_6r'])
def test_a_twist_in_work_axes_moves_the_joints_alike_whatever_the_tools_axes(name):
    """Up to the edge and along it."""
    ends, speed = [], load(name).motion.linear.speed
    for frames in (FRAMES, ALIKE):
        machine = in_frames(load(name), frames)
        start = frames.pivot(load(name).kinematics.home)
        motion = JogMotion.at_rest(start, machine.kinematics.inverse(start))
        jogger, held = machine.make_jogger(machine), []
        for _ in range(60):
            motion = jogger.step(motion, speed * np.array([0.4, 0.2, 0.8, 1.0, 0.0, 2.0]), 0.02)
            held.append(motion.held_by)
        ends.append((motion.joints, held))
    np.testing.assert_allclose(ends[0][0], ends[1][0], atol=1e-9)
    assert ends[0][1] == ends[1][1]


def test_a_twist_in_the_tools_axes_is_along_them():
    pose = FRAMES.pivot(Pose.from_xyz_rpy([0.1, 0.0, 0.2], [0.3, 0.2, 0.1]))
    twist = in_work_axes(np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0]), 'tool', pose, FRAMES)
    tip = Pose.from_xyz_rpy(1e-3 * np.array(POINT), np.radians(TURN))
    platform = FRAMES.platform(pose)
    along = (platform @ tip).rotation[:, 2]
    np.testing.assert_allclose(FRAMES.T_base_work.rotation @ twist[:3], along, atol=1e-12)


@pytest.mark.parametrize('name', ['robocake', 'stack_6_6'])
def test_the_nearest_pose_is_the_same_whatever_the_tools_axes(name):
    """And of the tool's point: as near to the target as its limits allow, not the platform's."""
    bare = load(name)
    found = []
    for frames, turn in ((FRAMES, A_TURN), (ALIKE, Pose.identity())):
        machine = in_frames(bare, frames)
        start = frames.pivot(bare.kinematics.home)
        search = Search(start.moved([4e-3, 0, 3e-3, 0.02, 0.05, 0]), 1e-6, 20)
        unmoved = machine.constraints.descended(replace(search, most_steps=0), start)
        assert np.abs(unmoved.twist_to(start)).max() < 1e-12
        end = machine.constraints.descended(search, start)
        assert np.abs(end.twist_to(search.target)).max() < 1e-5
        found.append(end @ turn.inverse())
    assert np.abs(found[0].twist_to(found[1])).max() < 1e-5


def test_no_tool_on_a_machine_that_has_one_in_its_file_is_its_platform():
    machine = replace(load('arm_6r'), frames=Frames.from_config(FramesConfig(), CONFIGS))
    bare = in_frames(machine, machine.frames.with_tool(''))
    assert bare.frames.tool == ''
    assert bare.frames.pivot(bare.kinematics.home) is bare.kinematics.home


@pytest.mark.parametrize(
    ('name', 'xyz', 'reason'),
    [
        ('arm_6r', (0.0, 0.0, -30.0), "tool 'laser' is inside the last link"),
        ('ur3e', (5.0, 0.0, -30.0), "tool 'laser' is inside the last link"),
        ('niryo_one', (-12.0, 2.0, 0.0), "tool 'laser' is inside the last link"),
        ('arm_6r', (0.0, 9e4, 0.0), "tool 'laser' .* is 90 m from the platform"),
        ('robocake', (0.0, 9e4, 0.0), "tool 'laser' .* is 90 m from the platform"),
    ],
)
def test_a_tool_in_the_wrist_or_far_away_is_refused(name, xyz, reason):
    (tool,) = Frames.from_config(FramesConfig(), [ToolConfig('laser', xyz, TURN)]).tools
    with pytest.raises(InvalidInput, match=reason):
        check_tool(load(name).kinematics, tool)


@pytest.mark.parametrize(
    ('name', 'xyz'),
    [
        *(('arm_6r', xyz) for xyz in ((0.0, 0.0, 0.0), (0.0, 0.0, 80.0), (120.0, 0.0, -30.0))),
        ('ur3e', (60.0, 0.0, -30.0)),
        ('puma560', (0.0, 0.0, -1.0)),
        ('robocake', (0.0, 0.0, -10.0)),
    ],
)
def test_a_tool_on_beside_or_beyond_the_last_link_or_below_a_platform_is_none_of_these(name, xyz):
    (tool,) = Frames.from_config(FramesConfig(), [ToolConfig('laser', xyz)]).tools
    check_tool(load(name).kinematics, tool)
