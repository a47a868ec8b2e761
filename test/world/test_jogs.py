"""Sticks, and who has the machine."""

import numpy as np
import pytest

FORWARD = np.array([0.01, 0.0, 0.0, 0.0, 0.0, 0.0])


def test_a_jog_moves_while_it_is_held_and_stops_at_release(world):
    world.jog(FORWARD, 0.4)
    world.run(0.5)
    there = world.pose.position[0]
    assert there > 0.002
    world.run(1.0)
    assert world.pose.position[0] == pytest.approx(there, abs=2e-4)


def test_a_stick_that_falls_silent_stops_the_machine(world):
    world.links['twists'].send(world.user.stamp, 'cmd_vel/joy', FORWARD)
    world.run(0.25 + 0.3)
    there = world.pose.position[0]
    world.run(1.0)
    assert there > 0.001
    assert world.pose.position[0] == pytest.approx(there, abs=2e-4)


def test_a_person_takes_the_machine_from_the_computer_which_must_let_go_first(world):
    world.jog(FORWARD, 0.2, 'cmd_vel')
    for _ in range(10):  # both hold: a person's twist leads backwards
        world.links['twists'].send(world.user.stamp, 'cmd_vel/joy', -FORWARD)
        world.run(0.02)
        world.links['twists'].send(world.user.stamp, 'cmd_vel', FORWARD)
        world.run(0.02)
    assert world.supervisor.teleop.owner(world.now) == 'cmd_vel/joy'
    reasons = [reason for _, reason in world.supervisor.on_twist.refusals]
    assert any('cmd_vel/joy took the machine over' in reason for reason in reasons)
