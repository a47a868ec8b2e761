"""The gripper of an arm: it opens beside whatever the arm does, and moves by nobody's leave."""

import numpy as np
import pytest

from manipulator.errors import Refused

ARM = 6
"""The gripper's servo is the one after the arm's."""
QUIET = 2.0
CLOSED, OPEN = 2000, 4000
"""The ends of its range of pulses, 1 and 2 ms, in half microseconds."""


@pytest.fixture
def arm(make_world):
    return make_world('arm_6r')


def gripper(world, since):
    return world.pulses(since)[:, ARM]


def test_it_opens_while_the_arm_stands(arm):
    arm.run(0.3)
    since = arm.now
    arm.bridge.aim_gripper(1.0)
    arm.run(2.0)
    pulses = arm.pulses(since)
    assert np.ptp(pulses[:, :ARM], axis=0).max() <= QUIET
    assert pulses[-1, ARM] == OPEN
    half_speed = 0.5 * arm.board.machine.board.settings.count_speeds[ARM]
    assert np.diff(pulses[:, ARM]).max() <= 0.02 * half_speed + QUIET


def test_it_closes_while_a_goal_is_driven_which_is_reached(arm):
    stamp = arm.send_goal(arm.machine.kinematics.home.moved(np.array([0.05, 0, 0.05, 0, 0, 0.2])))
    arm.run(0.2)
    since = arm.now
    arm.bridge.aim_gripper(0.0)
    assert arm.end_of(stamp).result == 'reached'
    arm.run(2.0)
    assert gripper(arm, since)[-1] == CLOSED


def test_a_machine_that_holds_while_it_moves_goes_on_and_so_does_it(arm):
    arm.bridge.aim_gripper(1.0)
    arm.run(0.1)
    arm.inverse.freeze(0.6)
    arm.wait('hold', lambda: arm.state == 'holding')
    arm.wait('enabled machine', lambda: arm.state == 'enabled')
    arm.run(2.0)
    assert gripper(arm, arm.now - 0.1)[-1] == OPEN


def test_a_stop_holds_it_and_it_does_not_go_on_after_the_clear(arm):
    arm.bridge.aim_gripper(1.0)
    arm.run(0.2)
    arm.emergency_stop()
    arm.wait('stop', lambda: arm.state == 'stopped')
    arm.run(0.1)
    since = arm.now
    with pytest.raises(Refused, match='stopped'):
        arm.bridge.aim_gripper(0.0)
    arm.run(0.5)
    assert arm.clear() == ''
    arm.wait('enabled machine', lambda: arm.state == 'enabled')
    assert arm.go_to(arm.machine.kinematics.home.moved(np.array([0, 0, 0.02, 0, 0, 0]))).result
    assert np.ptp(gripper(arm, since)) <= QUIET
    arm.bridge.aim_gripper(1.0)
    arm.run(2.0)
    assert gripper(arm, since)[-1] > gripper(arm, since)[0] + 100


def test_what_is_asked_of_a_machine_whose_servos_are_off_is_not_done_later(arm):
    arm.disable()
    arm.wait('word', lambda: arm.state == 'disarmed')
    with pytest.raises(Refused, match='disarmed'):
        arm.bridge.aim_gripper(1.0)
    arm.enable()
    since = arm.now
    arm.run(1.0)
    assert np.ptp(gripper(arm, since)) <= QUIET
