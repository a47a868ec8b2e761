"""`python -m manipulator joy_teleop`: an executable without an installation."""

import sys

from manipulator import executables
from manipulator.nodes.run import run_named

if __name__ == '__main__':
    sys.exit(run_named(executables.joy_teleop, executables.keyboard_teleop))
