"""`hexarm simulate`: the experiment of Prokopovich 2019, figs 12 and 13."""

import json

import numpy as np
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
    image = Image.open(moving)
    assert (image.n_frames, image.info['duration']) == (12, 40)  # of half a second


@pytest.mark.parametrize(
    ('words', 'reason'),
    [
        (['--payload', '-5'], 'payload'),
        (['--torque', '0'], '--torque 0'),
        (['--frequency', '0'], '--frequency 0 Hz'),
        (['--frequency', '1', '2'], 'has 2 numbers, needs one or six'),
        (['--frequency', '1', '1', '1', '1', '1', '1.001'], 'common period'),
        (['--noise', '-1'], '--noise -1'),
        ([*QUICK, '--data', 'sensors.txt'], 'must end in .csv'),
        ([*QUICK, '--frequency', '3', '--data', '/does/not/exist.csv'], 'cannot write'),
        (['--periods', '1e9'], 'not within'),
        (['--amplitude', '0', '0', '0', '0', '0', '0'], 'periods of 0 s'),
        (['--amplitude', 'nan', '0', '0', '0', '0', '0'], 'finite'),
        ([*QUICK, '--frequency', '3', '--picture', '/does/not/exist.png'], 'No such file'),
        ([*QUICK, '--frequency', '3', '--animation', 'a.txt'], 'must end in .gif'),
    ],
)
def test_refusals(capsys, words, reason):
    assert main(['simulate', 'robocake', *words]) == 2
    assert reason in capsys.readouterr().err


def test_each_axis_has_its_own_frequency_and_phase(capsys):
    """x as a cosine of 1 Hz, y as a sine of 2 Hz, over their common period of a second."""
    motion = ['--amplitude', '0.004', '0.002', '0', '0', '0', '0', '--periods', '1']
    turns = ['--frequency', '1', '2', '1', '1', '1', '1', '--phase', '1.5708', *['0'] * 5]
    assert main(['simulate', 'robocake', *motion, *turns, '--json']) == 0
    series = json.loads(capsys.readouterr().out)['series']
    time = np.array(series['time'])
    assert time[-1] == pytest.approx(1.0)
    assert np.allclose(series['position_x'], 4e-3 * np.cos(2 * np.pi * time), atol=3e-4)
    assert np.allclose(series['position_y'], 2e-3 * np.sin(4 * np.pi * time), atol=3e-4)
    assert np.allclose(series['position_z'], 41.19e-3, atol=2e-4)


def test_sensors_on_three_axes_agree_with_each_other(capsys):
    """Speed is the change of position, acceleration that of speed; the force carries 150 g."""
    assert main(['simulate', 'robocake', *QUICK, '--json']) == 0
    columns = json.loads(capsys.readouterr().out)['series']
    series = {name: np.array(values) for name, values in columns.items()}
    dt = series['time'][1] - series['time'][0]
    for axis in 'xyz':
        speed, acceleration = series[f'speed_{axis}'], series[f'acceleration_{axis}']
        assert np.gradient(series[f'position_{axis}'], dt)[2:-2] == pytest.approx(
            speed[2:-2], abs=1e-3
        )
        assert np.gradient(speed, dt)[2:-2] == pytest.approx(acceleration[2:-2], abs=2e-2)
    assert series['force_z'].mean() == pytest.approx(0.150 * 9.80665, rel=0.02)
    assert len(series['joint_effort_crank_6']) == len(series['time'])


def test_all_sensors_over_time_go_to_a_csv_file(tmp_path, capsys):
    table = tmp_path / 'sensors.csv'
    assert main(['simulate', 'robocake', *QUICK, '--data', str(table)]) == 0
    header, *rows = table.read_text().splitlines()
    assert header.startswith('time,position_x,position_y,position_z,rotation_x')
    assert header.endswith('joint_effort_crank_6')
    assert {row.count(',') for row in rows} == {header.count(',')}
    assert str(table) in capsys.readouterr().out


@pytest.mark.parametrize('law', ['independent', 'common'])
def test_servo_noise_moves_the_platform(capsys, law):
    """±0.01 rad: hundreds of micrometres if independent, a fraction of it from one signal."""
    noise = ['--noise', '0.01', '--noise-law', law]
    assert main(['simulate', 'robocake', *QUICK, *noise, '--json']) == 0
    moved = json.loads(capsys.readouterr().out)['noise_position_rms']
    assert (60e-6 if law == 'independent' else 2e-6) < moved
    assert moved < (160e-6 if law == 'independent' else 40e-6)


def test_a_motion_that_is_too_fast_for_the_drives_is_reported(capsys):
    assert main(['simulate', 'stewart_6_6', *QUICK]) == 0
    assert 'too fast for the drives, try a lower --frequency' in capsys.readouterr().out
    assert main(['simulate', 'stewart_6_6', *QUICK, '--frequency', '0.2']) == 0
    assert 'too fast' not in capsys.readouterr().out


def test_an_arm_has_a_tool_and_no_loops(capsys):
    assert main(['simulate', 'arm_6r', *QUICK]) == 0
    reported = capsys.readouterr().out
    assert 'tool         at most ' in reported
    assert 'loops' not in reported
    assert 'platform' not in reported
