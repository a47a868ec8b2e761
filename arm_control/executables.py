"""The executables of serial arms: arm_trajectory, arm_ik, arm_pose."""

from rclpy.node import Node

from hexarm.machines import described, load
from manipulator.nodes.run import run_node

MACHINE = 'arm_6r'


def trajectory() -> int:
    """Runs the trajectory node."""

    def make() -> Node:
        from manipulator.nodes.trajectory_node import TrajectoryNode  # noqa: PLC0415 (needs ruckig)

        return TrajectoryNode(load, MACHINE)

    return run_node(make, described)


def ik() -> int:
    """Runs the inverse kinematics node."""
    from manipulator.nodes.ik_node import IkNode  # noqa: PLC0415 (starts faster)

    return run_node(lambda: IkNode(load, MACHINE), described)


def pose() -> int:
    """Runs the forward kinematics node."""
    from manipulator.nodes.pose_node import PoseNode  # noqa: PLC0415

    return run_node(lambda: PoseNode(load, MACHINE), described)
