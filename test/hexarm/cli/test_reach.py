import json

import numpy as np
import pytest

from hexarm.cli.main import main
from hexarm.cli.statuses import OUT_OF_REACH
from hexarm.machines import load
from manipulator.pose import Pose

HOME = ['--xyz', '0', '0', '0.04119']
OUT = ['--xyz', '0.03', '0', '0.04119']


def answer(capsys, *words, status=0):
    assert main(['reach', *words, '--json']) == status
    return json.loads(capsys.readouterr().out)


def test_a_reachable_pose_has_positive_margins_nearest_first(capsys):
    found = answer(capsys, 'robocake', *HOME)
    assert found['reachable'] is True
    assert found['nearest'] is None
    assert min(r['margin'] for r in found['limits']) > 0
    assert {'quantity', 'owner', 'value', 'low', 'high', 'unit', 'margin'} <= set(
        found['limits'][0]
    )


def test_out_of_reach_is_answered_with_the_leg_and_a_pose_that_is_reachable(capsys):
    found = answer(capsys, 'robocake', *OUT, status=OUT_OF_REACH)
    assert found['reachable'] is False
    worst = found['limits'][0]
    assert worst['margin'] < 0
    assert worst['owner'].startswith('leg ')
    machine = load('robocake')
    near = found['nearest']
    pose = Pose.from_xyz_quaternion(near['xyz'], near['quaternion_xyzw'])
    assert machine.constraints.admits(pose, machine.kinematics.inverse(pose))


def test_travel_along_a_twist_is_reported(capsys):
    found = answer(capsys, 'robocake', *HOME, '--along', '0', '0', '-0.01', '0', '0', '0')
    assert found['travel']['seconds'] == pytest.approx(1.78)
    assert found['travel']['end']['xyz'] == pytest.approx([0, 0, 0.02339])
    assert 'platform height' in found['travel']['reason']


@pytest.mark.parametrize('machine', ['robocake', 'stewart_6_6', 'arm_6r'])
def test_people_read_the_limits_and_the_nearest_pose(capsys, machine):
    assert main(['reach', machine, '--xyz', '0', '0', '3']) == OUT_OF_REACH
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith('out of reach: ')
    assert lines[-3] == 'nearest reachable'
    assert lines[-2].startswith('x, y, z ')


def test_millimetres_are_asked_about_and_written_without_powers_of_ten(capsys):
    assert main(['reach', 'robocake', '--xyz', '5', '0', '45']) == OUT_OF_REACH
    text = capsys.readouterr().out
    assert 'rod too short by 45.2 m' in text
    assert 'are these millimetres?' in text
    assert 'e+' not in text


@pytest.mark.parametrize(
    'words',
    [
        ['robocake', '--xyz', 'nan', '0', '0'],
        ['robocake', *HOME, '--along', *'000000'],
        ['robocaek', *HOME],
        ['robocake', *HOME, '--rpy', '0', '0', '10'],
    ],
)
def test_what_is_no_question_is_refused(capsys, words):
    assert main(['reach', *words]) == 2
    assert np.size(capsys.readouterr().err.splitlines()) == 1
