"""Moves along and about each axis, to both sides of home: Prokopovich 2019. Checks the wiring."""

import sys

from hexarm import Robot

with Robot(sys.argv[1] if len(sys.argv) > 1 else '/hexapod') as robot:
    robot.enable()
    robot.home()
    home = dict(zip(('x', 'y', 'z'), robot.pose.position, strict=True))
    home |= dict.fromkeys(('roll', 'pitch', 'yaw'), 0.0)
    for axis, centre in home.items():
        unit, way = ('m', 0.004) if axis in 'xyz' else ('rad', 0.07)
        for value in (centre + way, centre - way, centre):
            robot.move(**{axis: value})
            pose = robot.pose
            measured = dict(zip(home, (*pose.position, *pose.rpy), strict=True))[axis] - centre
            print(f'{axis} {value - centre:+.4f} {unit}, measured {measured:+.4f}', flush=True)
