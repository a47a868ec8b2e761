import csv
import json

import numpy as np
import pytest

from hexarm.main import main


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
    'words', [['--points', '10'], ['--tilt', '-1'], ['--tilt', 'nan'], ['--data', 'table.xls']]
)
def test_what_makes_no_sense_is_refused(capsys, words):
    assert main(['workspace', 'robocake', *words]) == 2
    assert words[0] in capsys.readouterr().err
