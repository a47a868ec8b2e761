"""`python -m bridge serial_bridge`: an executable without an installation."""

import sys

from bridge import executables

if __name__ == '__main__':
    sys.exit(getattr(executables, sys.argv.pop(1))())
