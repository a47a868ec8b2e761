"""The executables that need a device of this computer: `gamepad` and `keyboard_teleop`."""

import signal
import sys

from rclpy.node import Node

from manipulator.errors import InvalidInput
from manipulator.nodes.run import run_node


def gamepad() -> int:
    """From a pad of this machine to Joy messages."""

    def make() -> Node:
        from manipulator.nodes.gamepad_node import Gamepad  # noqa: PLC0415 (needs evdev)

        return Gamepad()

    return run_node(make)


def keyboard_teleop() -> int:
    """From a terminal's keys to twists."""
    from manipulator.nodes.keyboard_teleop_node import KeyboardTeleop  # noqa: PLC0415
    from manipulator.nodes.terminal import Terminal  # noqa: PLC0415

    signal.signal(signal.SIGHUP, signal.SIG_IGN)  # a closed window is seen when reading
    try:
        with Terminal() as terminal:
            return run_node(lambda: KeyboardTeleop(terminal))
    except InvalidInput as error:
        print(f'keyboard_teleop: {error}', file=sys.stderr)
        return 1
