"""Stops a machine that another program moves: along its path, or with --emergency at once.

The first brakes within all limits, and the next motion is free. After an emergency stop the board
holds until `robot.clear()` or `hexarm clear`. Neither replaces a switch in the servos' supply.
"""

import sys

from hexarm import Robot

with Robot('/hexapod') as robot:
    if '--emergency' in sys.argv:
        robot.emergency_stop()
    else:
        robot.stop()
    print(robot.state)
