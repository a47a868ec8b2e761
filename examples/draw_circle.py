"""Draws two level circles and prints how far the measured pose was from them."""

from math import cos, hypot, pi, sin

from hexarm import Robot

RADIUS, HEIGHT, SPEED = 0.008, 0.045, 0.015  # m, m, m/s
with Robot('/hexapod') as robot:
    robot.enable()
    turns = [k * pi / 50 for k in range(201)]
    robot.move(x=RADIUS, y=0, z=HEIGHT)
    robot.follow(
        [(RADIUS * cos(a), RADIUS * sin(a), HEIGHT) for a in turns], speed=SPEED, wait=False
    )
    errors = []
    while not robot.is_done():
        x, y, _ = robot.pose.position
        errors.append(1e3 * abs(hypot(x, y) - RADIUS))
    print(f'{len(errors)} poses, at most {max(errors):.2f} mm from the circle')
