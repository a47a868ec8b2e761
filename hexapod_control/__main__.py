"""`python -m hexapod_control ik`: an executable without an installation."""

import sys

from hexapod_control import executables

if __name__ == '__main__':
    sys.exit(getattr(executables, sys.argv.pop(1))())
