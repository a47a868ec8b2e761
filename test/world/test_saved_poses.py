"""Saved poses are taken again as they were: of an arm in the saved posture, not only the pose."""

import numpy as np
import pytest

from hexarm import machines, saved_goals
from hexarm.panel.nodes.panel_node import PanelNode
from hexarm.robot import Robot
from manipulator.errors import Refused, Unreachable
from manipulator.pose import Pose
from manipulator.saved_poses import SavedPose, SavedPoses

DEAD_BAND = 0.008
BENT = np.array([0.2, 0.35, 1.4, -1.2, 0.9, -1.4])
"""Joints of the arm off its singular postures, rad."""


def flip(joints):
    """The wrist's other branch with the same pose."""
    return joints + np.array([0, 0, 0, np.pi, -2 * joints[4], np.pi])


def taught(machine, joints):
    """What the file holds after saving these joints."""
    empty = SavedPoses.none_of(machine)
    pose = machine.kinematics.forward(joints).pose
    return empty.read(empty.with_pose('up', SavedPose(pose, joints)).text)


class User:
    """Stands for the client of a Robot: sends to a world."""

    def __init__(self, world):
        self.world, self.machine = world, world.machine
        self.sent = []

    def begin(self, send, goal=None, progress=None):
        send()

    def send_joints(self, named):
        self.sent.append('joints')
        self.stamp = self.world.send_goal_joints(**named)

    def send_goal(self, pose):
        self.sent.append('pose')
        self.stamp = self.world.send_goal(pose)

    def begin_path(self, poses, speed, progress):
        self.sent.append('line')
        self.stamp = self.world.send_path(poses, speed)

    def rest(self):
        pass

    def commanded(self):
        return self.world.controller.supervisor.executor.state.pose

    def finish(self, timeout):
        status = self.world.end_of(self.stamp)
        assert status.result == 'reached', status
        self.world.run(0.5)

    def spin(self, seconds):
        pass


class Driven(Robot):
    """A Robot in a world, with a pose saved under the name `up`."""

    def __init__(self, world, saved):
        self._client, self._machine, self._saved = User(world), world.machine, saved

    @property
    def saved_poses(self):
        return self._saved

    @property
    def joints(self):
        world = self._client.world
        return dict(zip(world.machine.kinematics.joint_names, world.joints, strict=True))


@pytest.fixture
def arm(make_world):
    """One that has the pose of BENT, in the other branch."""
    world = make_world('arm_6r_stepper')
    forward = world.machine.kinematics.forward
    assert np.abs(forward(BENT).pose.twist_to(forward(flip(BENT)).pose)).max() < 1e-9
    named = dict(zip(world.machine.kinematics.joint_names, flip(BENT), strict=True))
    assert world.end_of(world.send_goal_joints(**named)).result == 'reached'
    world.run(0.5)
    return world


@pytest.mark.parametrize('how', ['move_to', 'replay'])
def test_an_arm_comes_back_in_the_posture_that_was_saved(arm, how):
    robot = Driven(arm, taught(arm.machine, BENT))
    getattr(robot, how)('up')
    assert robot._client.sent == ['joints']
    assert np.abs(arm.joints - BENT).max() < DEAD_BAND


def test_a_line_is_taken_to_the_saved_posture_or_refused(arm):
    robot = Driven(arm, taught(arm.machine, BENT))
    since = arm.now
    with pytest.raises(Refused, match=r'along a line joint_4 arrives at .*, and is saved at'):
        robot.move_to('up', speed=0.05)
    arm.run(0.2)
    assert arm.moved(since) <= 1.0
    robot.move_to('up')
    start = arm.controller.supervisor.executor.state.pose
    assert arm.go_to(start.moved([0.0, 0.0, -0.02, 0.0, 0.0, 0.0])).result == 'reached'
    robot.move_to('up', speed=0.05)
    assert robot._client.sent == ['joints', 'line']
    assert np.abs(arm.joints - BENT).max() < DEAD_BAND


def test_a_platform_is_sent_the_pose(make_world):
    world = make_world('robocake')
    pose = world.machine.kinematics.home.moved([0.002, 0.0, 0.001, 0.0, 0.0, 0.05])
    robot = Driven(world, taught(world.machine, world.machine.kinematics.inverse(pose)))
    robot.move_to('up')
    assert robot._client.sent == ['pose']
    assert np.abs(world.pose.twist_to(pose)).max() < 0.01


def test_the_page_sends_what_a_program_sends(arm):
    saved = taught(arm.machine, arm.machine.kinematics.inverse(arm.machine.kinematics.home))
    sent = []

    class Page:
        """Of a panel only what *Go* uses."""

        _machine, _moved_at = arm.machine, 0.0
        _controls = type('', (), {'follow': staticmethod(lambda pose: None)})
        _requests = type('', (), {'send_joints': staticmethod(sent.append), 'notice': ''})

        def _ask_reach(self, pose):
            pass

    PanelNode._go_to(Page(), saved.of('up'))
    assert sent == [saved_goals.joints_of(arm.machine, saved.of('up'))]


def test_an_edited_pose_counts_and_the_saved_joints_choose_its_branch():
    machine = machines.load('arm_6r_stepper')
    for start in (BENT, flip(BENT)):
        pose = machine.kinematics.forward(start).pose.moved([0.01, 0.0, 0.0, 0.0, 0.0, 0.0])
        found = np.array(list(saved_goals.joints_of(machine, SavedPose(pose, start)).values()))
        assert np.abs(machine.kinematics.forward(found).pose.twist_to(pose)).max() < 1e-9
        assert np.abs(found - start).max() < 0.3
    far = Pose.from_xyz_rpy((5.0, 0.0, 0.0))
    with pytest.raises(Unreachable):
        saved_goals.joints_of(machine, SavedPose(far, BENT))
    assert saved_goals.joints_of(machine, SavedPose(far)) is None


def test_joints_at_a_stop_that_are_measured_a_little_beyond_it_are_those_of_the_stop():
    machine = machines.load('arm_6r_stepper')
    highest = machine.joint_ranges[1][0]
    joints = machine.kinematics.inverse(machine.kinematics.home).copy()
    joints[0] = highest + 1e-3
    saved = SavedPose(machine.kinematics.forward(joints).pose, joints)
    assert saved_goals.joints_of(machine, saved)['joint_1'] == highest
