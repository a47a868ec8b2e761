"""Goals, home, park, stop and cycles: what is driven, refused, waits or is dropped."""

from dataclasses import replace

import numpy as np
import pytest

from hexarm.machines import load
from manipulator.errors import NoSolution, Refused
from manipulator.planning.cycle import Cycle
from manipulator.planning.goal import Goal
from manipulator.pose import Pose
from manipulator.trajectory.controller import MotionController
from manipulator.trajectory.early_command import PATIENCE

MACHINE = load('robocake')
HIGHER = Pose.from_xyz_rpy((0.0, 0.0, 0.0452))


def small_cycle(amplitude):
    return lambda centre: Cycle(centre, np.full(6, amplitude), np.full(6, 0.5), np.zeros(6))


def at(pose, expected):
    return np.abs(pose.twist_to(expected)).max() < 1e-9


def test_goals_are_of_the_platform_or_of_the_pivot(stage):
    stage.core.supervisor.set_pivot([0.0, 0.0, 0.01])
    stage.run(2)
    stage.pursue(Goal(HIGHER, 1.0))
    stage.run(200)
    assert at(stage.pose, HIGHER)
    higher_by_the_pivot = HIGHER.moved(np.array([0.0, 0.0, 0.01, 0.0, 0.0, 0.0]))
    stage.pursue(Goal(stage.machine.kinematics.home, 2.0))
    stage.run(200)
    stage.pursue(Goal(higher_by_the_pivot, 3.0), is_of_platform=False)
    stage.run(200)
    assert at(stage.pose, HIGHER)


def test_a_goal_that_comes_too_early_is_driven_once_the_machine_is_taken_over(stage):
    stage.is_followed = False
    stage.tick()
    stage.pursue(Goal(HIGHER, 1.0))
    stage.run(30)
    assert stage.pose.position[2] == pytest.approx(stage.machine.kinematics.home.position[2])
    stage.is_followed = True
    stage.run(200)
    assert (stage.status.result, stage.refusals) == ('reached', [])


def test_a_goal_that_waits_is_driven_also_where_the_bridge_has_nothing_new_to_report(stage):
    stage.state = 'disarmed'
    stage.tick()
    stage.state, stage.does_pose_come = 'enabled', False
    stage.tick()
    stage.pursue(Goal(HIGHER, 1.0))
    stage.tick()
    stage.does_bridge_say, stage.does_pose_come = False, True
    stage.run(100)
    assert at(stage.pose, HIGHER)


def test_a_goal_does_not_wait_for_longer_than_the_patience(stage):
    stage.is_followed = False
    stage.tick()
    stage.pursue(Goal(HIGHER, 1.0))
    stage.run(round(PATIENCE / 0.01) + 2)
    assert stage.refusals == ['the board does not follow setpoints yet']


def test_commands_for_a_machine_that_is_stopped_are_refused(stage):
    stage.state = 'stopped'
    stage.tick()
    core = stage.core
    for ask in (
        lambda: stage.pursue(Goal(HIGHER, 1.0)),
        lambda: core.home(1.0, stage.now),
        lambda: core.park(1.0, stage.now),
        core.stop,
        lambda: core.start_cycle(small_cycle(0.001), 1.0),
    ):
        with pytest.raises(Refused, match='clear the stop first'):
            ask()


@pytest.mark.parametrize('name', ['robocake', 'arm_6r'])
def test_home_and_park_arrive_with_their_own_joints(staged, name):
    stage = staged(name)
    kinematics, park = stage.machine.kinematics, stage.machine.park
    stage.core.park(1.0, stage.now)
    stage.run(1500)
    assert (stage.status.result, stage.status.goal_stamp) == ('reached', 1.0)
    np.testing.assert_allclose(stage.executor.joints, park, atol=1e-6)
    stage.core.home(2.0, stage.now)
    stage.run(1500)
    assert (stage.status.result, stage.status.goal_stamp) == ('reached', 2.0)
    np.testing.assert_allclose(
        stage.executor.joints, kinematics.inverse(kinematics.home), atol=1e-6
    )


def test_home_is_the_platforms_whatever_the_pivot(stage):
    stage.pursue(Goal(HIGHER, 1.0))
    stage.run(200)
    stage.core.supervisor.set_pivot([0.0, 0.0, 0.01])
    stage.run(2)
    stage.core.home(2.0, stage.now)
    home = stage.machine.kinematics.home
    assert at(stage.core.supervisor.machine.frames.platform(stage.executor.pursued), home)
    stage.run(200)
    assert at(stage.pose, home)


def test_home_that_waits_and_comes_to_nothing_is_news(stage):
    stage.is_followed = False
    stage.tick()
    stage.core.home(5.0, stage.now)
    stage.run(round(PATIENCE / 0.01) + 2)
    assert (stage.status.result, stage.status.goal_stamp) == ('refused', 5.0)


def test_park_of_a_machine_without_servos_is_refused():
    with pytest.raises(Refused, match='no usable park position'):
        MotionController(replace(MACHINE, park=None), 0.01).park(1.0, 0.0)


def test_park_of_a_machine_whose_pose_there_is_unknown_is_refused():
    class Lost:
        def __getattr__(self, name):
            return getattr(MACHINE.kinematics, name)

        def forward(self, joints, near=None):
            raise NoSolution('two assembly modes fit')

    with pytest.raises(
        Refused, match='the forward solution of the park position failed: two assembly modes fit'
    ):
        MotionController(replace(MACHINE, kinematics=Lost()), 0.01).park(1.0, 0.0)


def test_stop_brakes_drops_what_waits_and_silences_the_stick(stage):
    twist = np.array([0.01, 0.0, 0.0, 0.0, 0.0, 0.0])
    stage.core.teleop.receive('cmd_vel/joy', twist, '', stage.now)
    stage.run(10)
    stage.core.stop()
    for _ in range(30):
        stage.tick()
        with pytest.raises(Refused):
            stage.core.teleop.receive('cmd_vel/joy', twist, '', stage.now)
    assert (stage.status.mode, stage.status.result) == ('hold', 'stopped')


def test_stop_refuses_a_goal_that_waits_for_the_machine(stage):
    stage.is_followed = False
    stage.tick()
    stage.pursue(Goal(HIGHER, 1.0))
    with pytest.raises(Refused):
        stage.core.stop()
    assert stage.refusals == ['stopped before it began']


def test_a_cycle_is_answered_once_it_has_begun(slow):
    slow.core.start_cycle(small_cycle(0.001), 5.0)
    assert slow.core.cycle_answer(5.0) is None
    slow.run(20)
    answer = slow.core.cycle_answer(5.0)
    assert answer.is_obeyed
    assert answer.text == 'cycling until stopped'


@pytest.mark.parametrize('result', ['refused', 'reached'])
def test_what_became_of_another_goal_is_no_answer_to_a_cycle(slow, result):
    slow.pursue(Goal(HIGHER if result == 'reached' else HIGHER.moved(np.full(6, 0.1)), 4.0))
    slow.run(200)
    assert (slow.status.result, slow.status.goal_stamp) == (result, 4.0)
    slow.core.start_cycle(small_cycle(0.001), 5.0)
    assert slow.core.cycle_answer(5.0) is None
    slow.run(1)
    assert slow.core.cycle_answer(5.0) is None


def test_a_cycle_beyond_the_reach_is_answered_with_the_reason(slow):
    slow.core.start_cycle(small_cycle(0.2), 5.0)
    slow.run(20)
    answer = slow.core.cycle_answer(5.0)
    assert not answer.is_obeyed
    assert answer.text == slow.status.reason != ''


def test_a_cycle_that_a_newer_goal_replaces_is_answered_so(slow):
    slow.core.start_cycle(small_cycle(0.001), 5.0)
    slow.pursue(Goal(HIGHER, 6.0))
    slow.run(1)
    answer = slow.core.cycle_answer(5.0)
    assert (answer.is_obeyed, answer.text) == (
        False,
        'replaced by a newer command before it began',
    )


def test_a_cycle_whose_machine_is_lost_before_it_began_is_answered_so(slow):
    slow.core.start_cycle(small_cycle(0.001), 5.0)
    slow.state = 'fault'
    slow.run(1)
    answer = slow.core.cycle_answer(5.0)
    assert (answer.is_obeyed, answer.text) == (False, 'the machine is fault')


def test_a_cycle_whose_machine_was_lost_and_waits_to_be_driven_again_is_answered_too(slow):
    slow.core.start_cycle(small_cycle(0.001), 5.0)
    slow.state, slow.does_pose_come = 'fault', False
    slow.run(1)
    slow.state = 'enabled'
    slow.run(1)
    answer = slow.core.cycle_answer(5.0)
    assert (answer.is_obeyed, answer.text) == (
        False,
        'replaced by a newer command before it began',
    )


def test_an_unknown_jog_mode_is_refused_and_the_last_one_stays(stage):
    teleop = stage.core.teleop
    teleop.set_mode('hold_orientation')
    with pytest.raises(Refused, match="'hold_orientatio' is not one of"):
        teleop.set_mode('hold_orientatio')
    assert teleop.mode == 'hold_orientation'
