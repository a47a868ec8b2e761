import json
import re

import pytest

from hexarm.cli.main import main
from hexarm.machines import find


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


def test_the_papers_figures_stand_only_beside_the_papers_machine(capsys, tmp_path):
    own = tmp_path / 'own.yaml'
    text = find('robocake').read_text()
    for rod, is_papers in (('58.0', True), ('60.0', False)):
        own.write_text(text.replace('rod_length_mm: 58.0', f'rod_length_mm: {rod}'))
        words = ['accuracy', str(own), '--draws', '100', '--noise', '0.017453292519943295']
        assert main(words) == 0
        said = capsys.readouterr().out
        assert ('paper' in said.splitlines()[0], 'Prokopovich' in said) == (is_papers, is_papers)


@pytest.mark.parametrize('machine', ['ur5', 'ur3e'])
def test_joints_of_unknown_accuracy_are_asked_for_not_taken_for_hobby_servos(machine, capsys):
    assert main(['accuracy', machine, '--draws', '100']) == 2
    assert 'give --noise A' in capsys.readouterr().err
    assert main(['accuracy', machine, '--draws', '100', '--noise', '1e-5']) == 0


def test_noise_is_the_play_of_the_machine_files_servos(capsys):
    assert main(['accuracy', 'stewart_6_3', '--draws', '100', '--json']) == 0
    assert json.loads(capsys.readouterr().out)['noise'] == 2e-4


@pytest.mark.parametrize(
    'words',
    [
        ['--noise', '-1'],
        ['--noise', 'nan'],
        ['--tolerance', '2'],
        ['--draws', '3'],
        ['--draws', '9' * 20],
    ],
)
def test_what_makes_no_sense_is_refused(capsys, words):
    assert main(['accuracy', 'robocake', *words]) == 2
    assert words[0] in capsys.readouterr().err


def test_machines_of_micrometres_have_digits_that_count(capsys, tmp_path):
    text = find('stewart_6_3').read_text()
    for key in ('hysteresis_mm', 'dead_band_us'):
        text = re.sub(f'{key}: [0-9.]+', f'{key}: 0.0', text)
    path = tmp_path / 'precise.yaml'
    path.write_text(text)
    words = ['--noise', '1e-9', '--tolerance', '1e-9', '--draws', '100']
    assert main(['accuracy', str(path), *words]) == 0
    row = capsys.readouterr().out.splitlines()[1]
    place, angle = (float(x) for x in re.findall(r'([0-9.]+)(?: mm|°)', row))
    assert 1e-7 < place < 1e-4
    assert 1e-8 < angle < 1e-5


def test_a_file_whose_servos_have_no_play_asks_for_the_noise(capsys, tmp_path):
    text = find('stewart_6_6').read_text().replace('hysteresis_mm: 0.2', 'hysteresis_mm: 0.0')
    path = tmp_path / 'exact.yaml'
    path.write_text(text)
    assert main(['accuracy', str(path)]) == 2
    assert 'gives no play of the servos' in capsys.readouterr().err
