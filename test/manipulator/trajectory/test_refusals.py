"""What a player says of goals, cycles and paths that the machine cannot drive, or only just."""

import re

import numpy as np

from hexarm.machines import load
from manipulator.trajectory.player import Goal, Player

DT = 0.01


def drive(motion, goal):
    """To its end: the poses of the ticks until then."""
    motion.pursue(goal)
    poses = []
    while not poses or motion.status.result in ('idle', 'planning', 'moving'):
        poses.append(motion.step())
        assert len(poses) < 1000
    return poses


def test_a_way_on_which_an_arm_would_have_to_turn_round_is_refused_before_it_takes_for_ever():
    """Behind joint 1's axis, which does not turn that far: its step is the same however slow."""
    arm = load('arm_6r')
    turn = np.array([2.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    rest = arm.kinematics.rest
    right, left = (arm.kinematics.forward(rest + side * turn).pose for side in (-1.0, 1.0))
    motion = Player(arm, right, rest - turn, DT)
    drive(motion, Goal(left, 7.0))
    assert (motion.status.result, motion.status.goal_stamp) == ('refused', 7.0)
    pattern = r'the way would take \d+ s, at most 600 s: joint speed is too high on it'
    assert re.fullmatch(pattern, motion.status.reason)
