"""Prints the measured joints and the pose five times a second, until Ctrl-C."""

import contextlib
import time

from hexarm import Robot

with Robot('/hexapod') as robot, contextlib.suppress(KeyboardInterrupt):
    print('  '.join(f'{name:>9}' for name in robot.joints), '  x, y, z (m)')
    while True:
        joints, position = robot.joints.values(), robot.pose.position
        print('  '.join(f'{q:9.4f}' for q in joints), '  ', position.round(4), flush=True)
        time.sleep(0.2)
