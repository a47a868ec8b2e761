"""`python -m panel panel`: the executable without an installation."""

import sys

from manipulator.nodes.run import run_named
from panel.executables import panel

if __name__ == '__main__':
    sys.exit(run_named(panel))
