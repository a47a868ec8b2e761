"""The room's executable: `panel`."""

from rclpy.node import Node

from bridge.calibration import Calibration
from bridge.servo_config import BoardConfig
from hexarm.machines import described, load, read
from hexarm.panel.gripper import GripperJoint
from manipulator.nodes.run import run_node

MACHINE = 'robocake'


def panel() -> int:
    """Serves the page of one machine."""

    def make() -> Node:
        from hexarm.panel.nodes.panel_node import PanelNode  # noqa: PLC0415 (needs viser)

        return PanelNode(load, gripper_of, MACHINE)

    return run_node(make, described)


def gripper_of(name_or_path: str) -> GripperJoint | None:
    """The joint that a machine file marks as its gripper; ConfigError says what is wrong."""
    servos = BoardConfig.from_machine(read(name_or_path), name_or_path).servos
    calibration = Calibration.from_config(servos)
    for joint in servos.joints:
        if joint.is_gripper:
            closed, opened = calibration.range_of(calibration.names.index(joint.name))
            return GripperJoint(joint.name, closed, opened)
    return None
