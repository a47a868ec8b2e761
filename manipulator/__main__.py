"""`python -m manipulator joy_teleop`: an executable without an installation."""

import sys

from manipulator.device_executables import gamepad, keyboard_teleop
from manipulator.executables import joy_teleop
from manipulator.nodes.run import run_named

if __name__ == '__main__':
    sys.exit(run_named(gamepad, joy_teleop, keyboard_teleop))
