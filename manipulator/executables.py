"""The executables of people's input devices: `joy_teleop`, `gamepad`, `keyboard_teleop`."""

import signal
import sys

from manipulator.errors import InvalidInput
from manipulator.nodes.run import run_node


def joy_teleop() -> int:
    """From Joy messages to twists."""
    from hexarm.gamepads import load  # noqa: PLC0415 (each imports its own node)
    from manipulator.nodes.joy_teleop_node import JoyTeleop  # noqa: PLC0415

    return run_node(lambda: JoyTeleop(load))


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
