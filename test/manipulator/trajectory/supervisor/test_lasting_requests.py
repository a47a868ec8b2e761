"""What a user set is kept while the machine moves, is lost and is taken over again."""

import numpy as np
import pytest

from hexarm.machines import load
from manipulator.errors import InvalidInput, Refused
from manipulator.pose import Pose
from manipulator.trajectory.executor import Goal

HOME = load('robocake').kinematics.home
ELSEWHERE = Pose.from_xyz_rpy((0.004, 0.002, 0.044), (0.0, 0.05, 0.0))


def test_override_is_kept_over_a_new_enabling(driving):
    driving.override(0.0)
    driving.note_machine_state('disarmed', is_followed=False)
    driving.note_machine_state('enabled', is_followed=False)
    driving.see(HOME)
    driving.note_machine_state('enabled', is_followed=True)
    driving.executor.pursue(Goal(ELSEWHERE, 1.0))
    assert np.abs(driving.run(50).twist_to(HOME)).max() < 1e-6


@pytest.mark.parametrize('rate', [-0.01, 1.01, np.nan, np.inf])
def test_an_override_outside_0_and_1_is_refused_and_the_last_one_kept(driving, rate):
    driving.override(0.0)
    with pytest.raises(Refused, match=r'speed override \S+ outside \[0, 1\]'):
        driving.override(rate)
    driving.executor.pursue(Goal(ELSEWHERE, 1.0))
    assert np.abs(driving.run(50).twist_to(HOME)).max() < 1e-6


def test_pause_outlasts_a_machine_that_is_lost_and_taken_over_again(driving):
    driving.pause(True)
    driving.note_machine_state('disarmed', is_followed=False)
    driving.note_machine_state('enabled', is_followed=False)
    driving.note_pose(HOME)
    driving.note_machine_state('enabled', is_followed=True)
    driving.executor.pursue(Goal(ELSEWHERE, 1.0))
    assert np.abs(driving.run(50).twist_to(HOME)).max() < 1e-6
    driving.pause(False)
    assert np.abs(driving.run(300).twist_to(ELSEWHERE)).max() < 1e-6


def test_a_new_pivot_does_not_end_a_pause(driving):
    driving.pause(True)
    driving.set_pivot((0.0, 0.0, 0.03))
    driving.step()
    assert driving.machine.frames.pivot(HOME).position[2] > HOME.position[2] + 0.02
    driving.executor.pursue(Goal(driving.machine.frames.pivot(ELSEWHERE), 9.0))
    driving.run(100)
    assert np.abs(driving.step().twist_to(HOME)).max() < 1e-9
    driving.pause(False)
    driving.run(300)
    assert np.abs(driving.step().twist_to(ELSEWHERE)).max() < 1e-9


def test_pivot_waits_until_the_machine_stands_still(driving):
    driving.executor.pursue(Goal(ELSEWHERE, 1.0))
    driving.run(3)
    driving.set_pivot([0.0, 0.0, 0.05])
    driving.run(1)
    assert driving.machine.frames.are_plain
    driving.run(100)
    assert not driving.machine.frames.are_plain
    assert np.abs(driving.run(3).twist_to(ELSEWHERE)).max() < 1e-8


@pytest.mark.parametrize('height', [float('nan'), 30.0])
def test_pivot_nowhere_or_far_away_is_refused(driving, height):
    with pytest.raises(InvalidInput, match='pivot'):
        driving.set_pivot([0.0, 0.0, height])
