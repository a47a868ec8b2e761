import csv
import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from arm_control.arm import SerialArm
from hexarm.cli.main import main
from hexarm.cli.workspace import default_points
from hexarm.machines import load

CONFIG = Path(__file__).resolve().parents[3] / 'config'


def test_json_has_ranges_and_volumes_with_errors(capsys, tmp_path):
    table = tmp_path / 'new' / 'table.npz'
    words = ['workspace', 'robocake', '--points', '20000', '--tilt', '0.2', '--data', str(table)]
    assert main([*words, '--json']) == 0
    out, err = capsys.readouterr()
    found = json.loads(out)
    assert found['ranges']['x'] == pytest.approx([-0.015627, 0.015627], abs=1e-6)
    constant = found['volumes']['constant_orientation']
    assert abs(constant['value'] - 2.0536e-5) < 2 * constant['error'] < 1e-6
    assert constant['confidence'] == 0.95
    assert found['volumes']['some_orientation']['value'] > constant['value']
    assert found['files'] == [str(table)]
    columns = np.load(table)
    admitted = columns['admitted'].astype(bool)
    assert np.isfinite(columns['sigma_min']).tolist() == admitted.tolist()
    assert columns['sigma_min'][admitted].min() >= 0.3
    assert 'volume: done' in err


def test_pictures_and_a_csv_table_are_written(capsys, tmp_path):
    table = tmp_path / 'table.csv'
    words = ['--points', '1000', '--picture', str(tmp_path / 'pictures'), '--data', str(table)]
    assert main(['workspace', 'stewart_6_6', *words]) == 0
    assert 'dm³' in capsys.readouterr().out
    assert {f.name for f in (tmp_path / 'pictures').iterdir()} == {
        'workspace.png',
        'joint_speeds.png',
    }
    rows = list(csv.DictReader(table.open(encoding='utf-8')))
    assert len(rows) == 1000
    assert all((row['sigma_min'] == '') == (row['admitted'] == '0') for row in rows)


@pytest.mark.parametrize(
    'words',
    [
        ['--points', '10'],
        ['--points', '0'],
        ['--points', '9' * 20],
        ['--tilt', '-1'],
        ['--tilt', 'nan'],
        ['--data', 'table.xls'],
    ],
)
def test_what_makes_no_sense_is_refused(capsys, words):
    assert main(['workspace', 'robocake', *words]) == 2
    assert words[0] in capsys.readouterr().err


def test_work_for_an_arm_is_bounded_by_the_positions_asked_for(capsys, monkeypatch):
    asked, real = [], SerialArm.inverse_or_nan

    def counted(self, pose, near=None):
        asked.append(pose.position.size // 3)
        return real(self, pose, near)

    monkeypatch.setattr(SerialArm, 'inverse_or_nan', counted)
    assert main(['workspace', 'ur5', '--points', '1000']) == 0
    assert sum(asked) < 250_000
    stages = capsys.readouterr().err.splitlines()
    assert stages[:3] == ['ranges: done', 'box: done', 'volume: done']


def test_fewer_positions_are_the_default_where_there_is_no_closed_form(tmp_path):
    skew = tmp_path / 'skew.yaml'
    skew.write_text(re.sub('a_mm: .*?,', 'a_mm: 30.0,', (CONFIG / 'puma560.yaml').read_text()))
    assert default_points(load('puma560')) == 20_000
    assert default_points(load(str(skew))) == 2000
    assert default_points(load('robocake')) == 1_000_000


def test_ctrl_c_ends_it_quietly():
    script = (
        'import signal, hexarm.cli.workspace as w\n'
        'from hexarm.cli.main import main\n'
        'signal.signal(signal.SIGINT, signal.default_int_handler)\n'
        'w.survey = lambda *rest: signal.raise_signal(signal.SIGINT)\n'
        'raise SystemExit(main(["workspace", "ur5"]))'
    )
    done = subprocess.run(
        [sys.executable, '-c', script], check=False, capture_output=True, text=True, timeout=60
    )
    assert (done.returncode, done.stdout, done.stderr) == (130, '', '')
