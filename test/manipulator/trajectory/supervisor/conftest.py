"""A supervisor, and a machine that does as it is told and says where it is."""

import pytest

from hexarm.machines import load
from manipulator.pose import Pose
from manipulator.trajectory.executor import Goal
from manipulator.trajectory.supervisor import MotionSupervisor

MACHINE = load('robocake')
HOME = MACHINE.kinematics.home
ELSEWHERE = Pose.from_xyz_rpy((0.004, 0.002, 0.044), (0.0, 0.05, 0.0))


class Rehearsal(MotionSupervisor):
    """A supervisor whose machine is where it is seen."""

    def see(self, pose):
        """Joints and pose of a machine that is there."""
        self.note_joints(MACHINE.kinematics.inverse(pose))
        self.note_pose(pose)

    def enable_at(self, pose):
        """A machine that is there is enabled, and its board follows."""
        self.note_machine_state('enabled', is_followed=False)
        self.see(pose)
        self.step()
        self.note_machine_state('enabled', is_followed=True)

    def run(self, ticks):
        """The last pose of so many ticks, each followed by the machine."""
        for _ in range(ticks):
            pose = self.step()
            if pose is not None:
                self.see(pose)
        return pose


@pytest.fixture
def supervisor():
    """A supervisor that has heard nothing yet."""
    return Rehearsal(MACHINE, 0.01)


@pytest.fixture
def driving(supervisor):
    """A supervisor that holds its machine at home."""
    supervisor.enable_at(HOME)
    return supervisor


@pytest.fixture
def moving(driving):
    """A supervisor on its way to a goal."""
    driving.executor.pursue(Goal(ELSEWHERE, 7.0))
    driving.run(8)
    return driving
