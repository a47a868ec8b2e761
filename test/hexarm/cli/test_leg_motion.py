"""`hexarm leg-motion`: the experiment of Lapikov et al. 2014, section 4."""

import json
import subprocess
import sys

import numpy as np
import pytest

from hexarm.cli.main import main
from hexarm.cli.statuses import OUT_OF_REACH

PAPER = ['--legs', '0.15', '--to', '0.02', '0.02', '0.2']


@pytest.mark.parametrize(
    ('machine', 'height', 'axis', 'vector', 'degrees'),
    [
        ('stewart_6_6', 0.142893, 1.326e-3, 2.11e-3, 0.0261),
        ('stewart_6_3', 0.138171, 1.378e-3, 2.26e-3, 0.0321),
    ],
)
def test_figures_of_the_experiment(capsys, machine, height, axis, vector, degrees):
    assert main(['leg-motion', machine, *PAPER, '--json']) == 0
    reported = json.loads(capsys.readouterr().out)
    assert len(reported['xyz']) == len(reported['share']) == 101
    assert reported['xyz'][0] == pytest.approx([0.0, 0.0, height], abs=1e-6)
    assert reported['xyz'][-1] == pytest.approx([0.02, 0.02, 0.2], abs=1e-9)
    assert reported['deviation']['axis'] == pytest.approx(axis, abs=1e-6)
    assert reported['deviation']['position'] == pytest.approx(vector, abs=1e-5)
    assert np.degrees(reported['deviation']['angle']) == pytest.approx(degrees, abs=1e-4)
    assert np.ptp(np.diff(reported['lengths'], axis=0), axis=0).max() < 1e-12
    assert reported['beyond_a_limit'] is None
    alpha, beta, gamma = np.degrees(reported['euler_zxz']).T
    assert np.abs([alpha, gamma]).max() < 0.35
    assert beta.min() == pytest.approx(-degrees, abs=1e-4)


def test_table_has_eleven_steps_and_the_deviation(capsys):
    assert main(['leg-motion', 'stewart_6_6', *PAPER]) == 0
    header, *rows, last = capsys.readouterr().out.splitlines()
    assert header.split()[:2] == ['path', '(%)']
    assert [float(row.split()[0]) for row in rows] == [10.0 * k for k in range(11)]
    assert last == 'deviation from linear: at most 2.106 mm (1.326 mm on one axis) and 0.0261°'


def test_without_legs_the_motion_starts_at_home(capsys):
    words = ['leg-motion', 'stewart_6_3', '--to', '0', '0.01', '0.19', '--steps', '4', '--json']
    assert main(words) == 0
    assert json.loads(capsys.readouterr().out)['xyz'][0] == pytest.approx([0, 0, 0.183286])


@pytest.mark.parametrize(
    ('words', 'reason'),
    [
        (['robocake', '--to', '0', '0', '0.04'], 'needs linear legs'),
        (['stewart_6_6', '--to', '0', '0', '0.3'], 'leg 1: leg length'),
        (['stewart_6_6', '--to', '0', '0', '0.19', '--legs', '0.02'], 'leg 1'),
        (['stewart_6_6', '--to', '0', '0', '0.19', '--steps', '0'], '0 steps'),
        (['stewart_6_6', '--to', '0', '0', '0.19', '--steps', '1000000000'], 'at most'),
        (['stewart_6_6', '--to', 'nan', '0', '0.19'], 'not finite'),
        (
            ['stewart_6_6', *PAPER, '--picture', '/does/not/exist.png'],
            '/does/not/exist.png: No such',
        ),
    ],
)
def test_what_cannot_be_simulated_is_refused_with_a_reason(capsys, words, reason):
    assert main(['leg-motion', *words]) == (OUT_OF_REACH if reason.startswith('leg 1') else 2)
    assert reason in capsys.readouterr().err


def test_a_picture_of_an_unknown_ending_is_refused_before_anything_is_computed(capsys):
    with pytest.raises(SystemExit, match='2'):
        main(['leg-motion', 'stewart_6_6', *PAPER, '--picture', 'motion.nonsense'])
    assert 'motion.nonsense: a picture ends in one of' in capsys.readouterr().err


def test_picture_is_saved(tmp_path, capsys):
    picture = tmp_path / 'motion.png'
    assert main(['leg-motion', 'stewart_6_6', *PAPER, '--picture', str(picture)]) == 0
    assert picture.read_bytes().startswith(b'\x89PNG')


def test_a_picture_without_matplotlib_names_what_to_install(tmp_path):
    """A None in sys.modules is how Python takes a module for missing."""
    program = (
        "import sys; sys.modules['matplotlib'] = None; from hexarm.cli.main import main; "
        f'sys.exit(main({["leg-motion", "stewart_6_6", *PAPER, "--picture", "a.png"]!r}))'
    )
    done = subprocess.run(
        [sys.executable, '-c', program], capture_output=True, text=True, check=False, timeout=60
    )
    assert done.returncode == 1
    assert 'pip install matplotlib' in done.stderr
    assert done.stdout == ''
