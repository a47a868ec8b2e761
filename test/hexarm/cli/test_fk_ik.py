"""`hexarm fk` and `hexarm ik`: one answer, and with --all every one."""

import json

import numpy as np
import pytest

from hexarm.cli.main import main
from hexarm.cli.statuses import OUT_OF_REACH
from hexarm.machines import load
from manipulator.pose import Pose

LEGS = ['0.19', '0.2', '0.19', '0.18', '0.19', '0.19']


@pytest.fixture
def ask(capsys):
    """Runs a subcommand with --json; its answer."""

    def ask(*words):
        assert main([*words, '--json']) == 0
        return json.loads(capsys.readouterr().out)

    return ask


def as_pose(reported):
    return Pose.from_xyz_quaternion(reported['xyz'], reported['quaternion_xyzw'])


def test_cold_start_counts_the_modes_that_all_lists(ask):
    cold = ask('fk', 'stewart_6_6', *LEGS)
    listed = ask('fk', 'stewart_6_6', *LEGS, '--all')
    assert listed['is_complete']
    assert cold['other_modes'] == len(listed['modes']) - 1
    assert cold['other_modes_reachable'] == 0
    (reachable,) = [mode for mode in listed['modes'] if mode['is_reachable']]
    assert np.abs(as_pose(cold['pose']).twist_to(as_pose(reachable['pose']))).max() < 1e-8
    assert reachable['sigma_min'] == pytest.approx(cold['sigma_min'])
    assert reachable['violations'] == []


def test_every_mode_listed_has_the_joints_asked_for(ask):
    kinematics = load('stewart_6_6').kinematics
    modes = ask('fk', 'stewart_6_6', *LEGS, '--all')['modes']
    assert len(modes) > 2
    for mode in modes:
        legs = kinematics.inverse(as_pose(mode['pose']))
        np.testing.assert_allclose(legs, [float(leg) for leg in LEGS], atol=1e-10)


def test_table_of_modes_reports_which_the_machine_can_be_in(capsys):
    assert main(['fk', 'robocake', *['2.09'] * 6, '--all']) == 0
    header, *rows, last = capsys.readouterr().out.splitlines()
    assert 'margin' in header
    assert len([row for row in rows if row.endswith('reachable')]) == 1
    assert last == f'{len(rows)} modes, 1 reachable within all limits'


def test_units_are_those_of_what_is_typed_and_printed(ask, capsys):
    metres = ask('ik', 'ur5', '--xyz', '-0.3', '0.2', '0.3', '--rpy', '0.1', '0', '0')
    words = ['--xyz', '-300', '200', '300', '--rpy', str(np.degrees(0.1)), '0', '0']
    millimetres = ask('ik', 'ur5', *words, '--units', 'mm')
    np.testing.assert_allclose(
        millimetres['joints']['positions'], metres['joints']['positions'], atol=1e-9
    )
    assert main(['ik', 'ur5', *words, '--units', 'mm']) == 0
    name, number, unit = capsys.readouterr().out.splitlines()[0].split()
    assert (name, unit) == ('joint_1', '°')
    assert float(number) == pytest.approx(np.degrees(metres['joints']['positions'][0]), abs=1e-3)
    assert main(['fk', 'stewart_6_6', *['190'] * 6, '--units', 'mm']) == 0
    in_mm = capsys.readouterr().out.splitlines()[0].split()
    assert main(['fk', 'stewart_6_6', *['0.19'] * 6]) == 0
    in_m = capsys.readouterr().out.splitlines()[0].split()
    assert (in_mm[-1], in_m[-1]) == ('mm', 'm')
    assert float(in_mm[-2]) == pytest.approx(1e3 * float(in_m[-2]), abs=1e-3)


def test_out_of_reach_has_one_exit_status(capsys):
    for command in ('ik', 'reach'):
        assert main([command, 'robocake', '--xyz', '0.04', '0', '0.045']) == OUT_OF_REACH
        assert main([command, 'robocake', '--xyz', 'nan', '0', '0.045']) == 2


def test_serial_arms_have_one_mode(ask):
    angles = ['0.1', '0.2', '0.3', '0.4', '0.5', '0.6']
    assert ask('fk', 'arm_6r', *angles)['other_modes'] == 0
    assert len(ask('fk', 'arm_6r', *angles, '--all')['modes']) == 1


def test_all_eight_branches_of_an_arm_give_the_pose(ask):
    kinematics = load('ur5').kinematics
    words = ['--xyz', '-0.3', '0.2', '0.3', '--rpy', '0.1', '0.2', '0.3']
    branches = ask('ik', 'ur5', *words, '--all')['branches']
    assert len(branches) == 8
    wanted = Pose.from_xyz_rpy([-0.3, 0.2, 0.3], [0.1, 0.2, 0.3])
    sets = np.array([branch['positions'] for branch in branches])
    assert len(np.unique(np.round(sets, 6), axis=0)) == 8
    for joints in sets:
        assert np.abs(wanted.twist_to(kinematics.forward(joints).pose)).max() < 1e-9
    first = ask('ik', 'ur5', *words)['joints']['positions']
    assert np.abs(sets - first).max(axis=1).min() < 1e-9


def test_every_elbow_of_a_crank_platform_is_listed_the_usual_one_first(ask):
    words = ['--xyz', '0.002', '0.001', '0.042']
    listed = ask('ik', 'robocake', *words, '--all')
    usual, *others = listed['branches']
    assert usual['positions'] == pytest.approx(
        ask('ik', 'robocake', *words)['joints']['positions']
    )
    assert usual['violations'] == []
    assert len(others) == 63
    assert all(branch['violations'] for branch in others)
    kinematics = load('robocake').kinematics
    pose = Pose.from_xyz_rpy([0.002, 0.001, 0.042])
    for branch in others:
        np.testing.assert_allclose(
            pose.transform(kinematics.geometry.platform_points)
            - kinematics.unit_rods(pose, np.array(branch['positions'])) * 0.058,
            kinematics.crank_tips(np.array(branch['positions'])),
            atol=1e-12,
        )


def test_linear_legs_have_one_branch(ask):
    assert len(ask('ik', 'stewart_6_3', '--xyz', '0', '0', '0.19', '--all')['branches']) == 1


@pytest.mark.parametrize('words', [('0.19',) * 5, ('0.19',) * 5 + ('-0.1',)])
def test_joints_that_no_machine_has_are_refused_with_status_2(capsys, words):
    assert main(['fk', 'stewart_6_6', *words, '--all', '--json']) == 2
    assert 'error' in json.loads(capsys.readouterr().out)


def test_ik_asks_whether_millimetres_or_degrees_were_meant(capsys):
    assert main(['ik', 'ur5', '--xyz', '300', '0', '400']) == OUT_OF_REACH
    assert 'are these millimetres?' in capsys.readouterr().err
    assert main(['ik', 'ur5', '--xyz', '0.3', '0', '0.4', '--rpy', '0', '90', '0']) == 2
    assert 'pitch: 90 rad is more than a turn; are these degrees?' in capsys.readouterr().err


@pytest.mark.parametrize('machine', ['robocake', 'ur5'])
def test_degrees_are_distinguished_from_radians(machine, capsys):
    assert main(['fk', machine, '0', '0', '90', '0', '0', '0']) == 2
    assert '90 rad is more than a turn' in capsys.readouterr().err
    assert main(['fk', 'ur5', '0', '-6.28', '0', '0', '0', '0']) == 0


def test_near_selects_the_branch_and_the_turns(ask):
    kinematics = load('ur5').kinematics
    home = kinematics.inverse(kinematics.home)
    x, y, z = map(str, kinematics.home.position)
    rpy = [str(angle) for angle in kinematics.home.rpy]
    pose = ['--xyz', x, y, z, '--rpy', *rpy]
    for branch in ask('ik', 'ur5', *pose, '--all')['branches']:
        if branch['violations']:
            continue
        near = np.array(branch['positions'])
        near[5] += 2 * np.pi if near[5] < 0 else -2 * np.pi
        found = ask('ik', 'ur5', *pose, '--near', *map(str, near))['joints']['positions']
        np.testing.assert_allclose(found, near, atol=1e-6)
    assert ask('ik', 'ur5', *pose)['joints']['positions'] == pytest.approx(home.tolist())


def test_near_needs_a_number_for_each_joint(capsys):
    assert main(['ik', 'ur5', '--xyz', '0.4', '0', '0.4', '--near', '1', '2']) == 2
    assert '--near: 2 numbers, needs 6: joint_1, joint_2' in capsys.readouterr().err


def test_an_arm_needs_no_search_and_reports_none(capsys):
    assert main(['fk', 'ur5', *['0.5'] * 6]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split('  ')[0].split(' 0')[0] for line in lines[2:]] == ['singularity margin']
    assert main(['fk', 'stewart_6_6', *LEGS]) == 0
    assert 'iterations, residual' in capsys.readouterr().out
