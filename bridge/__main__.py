"""`python -m bridge serial_bridge`: an executable without an installation."""

import sys

from bridge import executables
from manipulator.nodes.run import run_named

if __name__ == '__main__':
    sys.exit(run_named(executables.fake_hardware, executables.serial_bridge))
