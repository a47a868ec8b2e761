"""`hexarm simulate`: the experiment of Prokopovich 2019, figs 12 and 13."""

import json

import pytest
from PIL import Image

from hexarm.cli.main import main

QUICK = ['--periods', '0.5']


def test_figures_of_the_experiment(capsys):
    assert main(['simulate', 'robocake', *QUICK, '--json']) == 0
    reported = json.loads(capsys.readouterr().out)
    assert reported['part_in_reach'] == 1.0
    assert 20 <= reported['corners_out_of_reach'] <= 44
    assert reported['platform_speed'] == pytest.approx(0.050, rel=0.02)
    assert max(reported['joint_effort']) < 0.25 * 0.1765
    assert reported['closure_error'] < 1e-5
    assert reported['position_error'] < 1e-3


def test_amplitudes_beyond_reach_are_made_smaller_and_it_reports_that(capsys):
    wide = ['--amplitude', '0.012', '0.012', '0.006', '0.2', '0.2', '0.16']
    assert main(['simulate', 'robocake', *QUICK, *wide, '--frequency', '0.5']) == 0
    assert '% of the amplitudes' in capsys.readouterr().out


def test_a_payload_beyond_the_servos_reports_where_it_stalls(capsys):
    assert main(['simulate', 'robocake', '--payload', '4000']) == 2
    reported = capsys.readouterr().err
    assert 'crank_' in reported
    assert 'stalls at x ' in reported


def test_pictures_are_saved(tmp_path, capsys):
    plot, moving = tmp_path / 'sensors.png', tmp_path / 'moving.gif'
    words = ['--picture', str(plot), '--animation', str(moving), '--frequency', '2']
    small = ['--amplitude', '0', '0.004', '0', '0', '0', '0.05']
    assert main(['simulate', 'stewart_6_3', '--periods', '1', *words, *small]) == 0
    assert plot.read_bytes().startswith(b'\x89PNG')
    assert Image.open(moving).n_frames == 10


@pytest.mark.parametrize(
    ('words', 'reason'),
    [
        (['--payload', '-5'], 'payload'),
        (['--torque', '0'], '--torque 0'),
        (['--frequency', '0'], 'periods at 0 Hz'),
        (['--periods', '1e9'], 'not within'),
        (['--amplitude', '0', '0', '0', '0', '0', '0'], 'periods of 0 s'),
        (['--amplitude', 'nan', '0', '0', '0', '0', '0'], 'finite'),
        ([*QUICK, '--frequency', '3', '--picture', '/does/not/exist.png'], 'cannot save'),
        ([*QUICK, '--frequency', '3', '--animation', 'a.txt'], 'must end in .gif'),
    ],
)
def test_refusals(capsys, words, reason):
    assert main(['simulate', 'robocake', *words]) == 2
    assert reason in capsys.readouterr().err
