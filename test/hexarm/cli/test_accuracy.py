import json

import pytest

from hexarm.cli.main import main


def test_json_has_law_drawing_and_the_papers_figures(capsys):
    assert main(['accuracy', 'robocake', '--draws', '500', '--json']) == 0
    found = json.loads(capsys.readouterr().out)
    rows = {row['cause']: row for row in found['rows']}
    everything = rows['noise, all joints']
    assert everything['position_rms'] == pytest.approx(0.205e-3, rel=0.015)
    assert everything['paper_position_rms'] == pytest.approx(9.9e-6)
    cancelled = rows.pop('one signal, all joints')
    assert cancelled['position_rms'] < 1e-9
    assert cancelled['drawn']['position_rms'] == pytest.approx(0.41e-6, rel=0.1)
    for row in rows.values():
        drawn = row['drawn']
        tolerance = drawn['relative_error']
        assert drawn['position_rms'] == pytest.approx(row['position_rms'], rel=tolerance)
    assert rows['geometry']['paper_position_rms'] is None
    spread = found['map']['position']
    assert spread['least'] < spread['median'] < spread['largest']


@pytest.mark.parametrize('machine', ['stewart_6_6', 'arm_6r'])
def test_people_read_a_table_and_get_a_map(capsys, tmp_path, machine):
    picture = tmp_path / 'new' / 'map.png'
    words = ['accuracy', machine, '--draws', '100', '--picture', str(picture)]
    assert main(words) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith('rms at home')
    assert 'paper' not in lines[0]
    assert picture.stat().st_size > 10_000


@pytest.mark.parametrize(
    'words', [['--noise', '-1'], ['--noise', 'nan'], ['--tolerance', '2'], ['--draws', '3']]
)
def test_what_makes_no_sense_is_refused(capsys, words):
    assert main(['accuracy', 'robocake', *words]) == 2
    assert words[0] in capsys.readouterr().err
