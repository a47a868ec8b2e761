"""Three poses, a circle of 20 poses, a refusal, a jog and a stop: start `hexarm up hexapod`."""

from math import cos, pi, sin

from hexarm import Refused, Robot

with Robot('/hexapod') as robot:
    robot.enable()
    for pose in ((0, 0, 0.045), (0.004, 0, 0.047), (0, 0, 0.045, 0, 0, 0.1)):
        robot.move_to(pose)
        print('measured', robot.pose.position.round(4), robot.pose.rpy.round(3))
    turns = [k * pi / 10 for k in range(21)]
    robot.follow([(0.008 * cos(a), 0.008 * sin(a), 0.045) for a in turns], speed=0.03)
    try:
        robot.move(x=0.04)
    except Refused as reason:
        print('refused:', reason)
    robot.jog(vx=-0.01, seconds=0.5)
    robot.move(z=0.041, wait=False)
    robot.stop()
