"""The room's executable: `panel`."""

from rclpy.node import Node

from hexarm.machines import load
from manipulator.nodes.run import run_node

MACHINE = 'robocake'


def panel() -> int:
    """Serves the page of one machine."""

    def make() -> Node:
        from panel.nodes.panel_node import PanelNode  # noqa: PLC0415 (needs viser)

        return PanelNode(load, MACHINE)

    return run_node(make)
