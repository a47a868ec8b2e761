"""The room's executables: `serial_bridge` and `fake_hardware`."""

import sys

from hexarm.machines import described
from manipulator.nodes.run import run_node


def serial_bridge() -> None:
    """Between the graph and the board."""
    from bridge.serial_bridge_node import SerialBridge  # noqa: PLC0415 (each imports its own node)

    sys.exit(run_node(SerialBridge, described))


def fake_hardware() -> None:
    """A board on a pty."""
    from bridge.fake_hardware_node import FakeHardware  # noqa: PLC0415

    sys.exit(run_node(FakeHardware, described))
