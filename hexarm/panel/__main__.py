"""`python -m panel panel`: the executable without an installation."""

import sys

from hexarm.panel.executables import panel
from manipulator.nodes.run import run_named

if __name__ == '__main__':
    sys.exit(run_named(panel))
