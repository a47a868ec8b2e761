"""`python -m arm_control ik`: an executable without an installation."""

import sys

from arm_control import executables
from manipulator.nodes.run import run_named

if __name__ == '__main__':
    sys.exit(run_named(executables.ik, executables.pose, executables.trajectory))
