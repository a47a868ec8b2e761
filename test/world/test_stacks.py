"""A stack of three sections on one board: a goal, a path, a jog into a limit, a stop."""

import numpy as np

from bridge.protocol import Setpoint

UP = np.array([0.004, 0.0, 0.02, 0.0, 0.0, 0.05])
NEAR = 5e-4
"""Metres by which frames, in steps of the servos, are off the rule."""
SLACK = 4e-3
"""Metres and radians that three sections make of the servos' dead bands."""


def joints_at(world, counts):
    """The joints that the counts (n, 18) of frames mean."""
    kinematics, calibration = world.machine.kinematics, world.calibration
    order = [calibration.names.index(name) for name in kinematics.joint_names]
    joints = np.array([calibration.positions(row) for row in counts])
    return joints[:, order]


def test_a_stack_reaches_a_goal_follows_a_path_jogs_into_a_limit_and_stops(make_world):
    world = make_world('stack_6_6')
    machine, kinematics, since = world.machine, world.machine.kinematics, world.now
    goal = kinematics.home.moved([0.02, -0.01, 0.13, 0.05, 0.1, 0.1])
    assert world.go_to(goal).result == 'reached'
    world.run(0.3)
    assert np.abs(world.pose.twist_to(goal)).max() < SLACK
    along = np.linspace(0.0, 1.0, 9)[:, None] * np.array([-0.01, 0.01, -0.01, 0.0, 0.05, 0.0])
    assert world.end_of(world.send_path(goal.moved(along))).result == 'reached'
    assert world.go_to(goal).result == 'reached'
    world.jog(UP, 2.0)
    assert 'section' in world.status.reason
    world.run(0.5)
    far = kinematics.home.moved([0.0, 0.0, 0.1, 0.0, 0.0, 0.0])
    world.send_goal(far)
    world.run(0.5)
    answer = world.emergency_stop()
    world.wait('stop', lambda: answer.said is not None)
    stopped = world.now
    world.run(0.5)
    assert world.moved(stopped + 0.1) == 0.0
    frames = world.setpoints(since)
    joints = joints_at(world, frames)
    ends = [kinematics.forward(row).pose for row in joints[::20]]
    for row, end in zip(joints[::20], ends, strict=True):
        assert not machine.constraints.violations(end, row)
        assert np.abs(kinematics.inverse(end) - row).max() < NEAR
    assert world.frames(Setpoint, stopped + 0.3) == []
