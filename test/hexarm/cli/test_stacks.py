"""The commands on a stack: of a shipped machine below, and one of a file beside it above."""

import json

import numpy as np
import pytest

from hexarm import machines
from hexarm.cli.main import main
from manipulator.analysis.survey import Survey
from manipulator.analysis.volume import Box, Volume

HEAD, _, TAIL = machines.find('stack_6_6').read_text().partition('geometry:')
TAIL = TAIL[TAIL.index('\nlimits:') :]
TWO = """geometry:
  sections:
    - machine: stewart_6_6
      next: {xyz_mm: [0.0, 0.0, 4.0]}
    - machine: parts/upper.yaml
"""


@pytest.fixture
def stack(tmp_path):
    """A stack of two sections, without servos."""
    (tmp_path / 'parts').mkdir()
    (tmp_path / 'parts' / 'upper.yaml').write_text(machines.find('stewart_6_3').read_text())
    return written(tmp_path, TWO)


def written(folder, geometry):
    path = folder / 'stack.yaml'
    tail = TAIL[: TAIL.index('\nservos:')] + '\ndriver: topic\n'
    path.write_text(HEAD + geometry + tail)
    return str(path)


def test_joints_that_ik_gives_are_of_the_pose_that_fk_gives(stack, capsys):
    assert (
        main(['ik', stack, '--xyz', '0.02', '0', '0.4', '--rpy', '0', '0.2', '0', '--json']) == 0
    )
    joints = json.loads(capsys.readouterr().out)['joints']['positions']
    assert len(joints) == 12
    assert main(['fk', stack, '--json', *(str(q) for q in joints)]) == 0
    found = json.loads(capsys.readouterr().out)
    np.testing.assert_allclose(found['pose']['xyz'], [0.02, 0.0, 0.4], atol=1e-9)


def test_all_modes_of_a_stack_are_refused_with_what_they_would_be(stack, capsys):
    assert main(['fk', stack, '--all', *['0.19'] * 12]) == 2
    assert 'each section of a stack has assembly modes of its own' in capsys.readouterr().err


def test_a_pose_out_of_reach_names_the_section(stack, capsys):
    assert main(['reach', stack, '--xyz', '0', '0', '0.6', '--rpy', '0', '0', '0']) == 3
    assert 'section 2 leg 1: leg length' in capsys.readouterr().out


def test_workspace_says_how_it_was_sampled(stack, capsys, monkeypatch):
    volume = Volume(0.05, 0.001, 992)
    box = Box(np.zeros(3), np.array([0.8, 0.6, 0.4]))
    ranges = dict.fromkeys(('x', 'y', 'z', 'roll', 'pitch', 'yaw'), (-0.1, 0.1))
    found = Survey(ranges, volume, 1.0, Volume(0.06, 0.01, 64), 0.0, 0.5, box)
    monkeypatch.setattr('hexarm.cli.workspace.survey', lambda *arguments: found)
    assert main(['workspace', stack, '--points', '1000']) == 0
    words = capsys.readouterr().out
    assert 'sampled at 992 positions spread evenly over 800 × 600 × 400 mm' in words
    assert 'sections share each pose as docs/kinematics.md, 9, says' in words


@pytest.mark.parametrize(
    ('geometry', 'problem'),
    [
        (TWO.replace('upper', 'uper'), 'geometry.sections[1].machine: machine file'),
        (TWO.replace('stewart_6_6', 'stewart_66'), "did you mean 'stewart_6_6'?"),
        (TWO.replace('stewart_6_6', 'stack_6_6'), "geometry.sections[0].kind: 'stack' is not"),
        (TWO.replace('stewart_6_6', '[6]'), 'sections[0].machine: [6] is neither a name nor'),
        (TWO + '      limits: {}\n', "'parts/upper.yaml' gives limits, and so does"),
        (TWO + '      lenght: 1\n', 'geometry.sections[1].lenght: unknown key'),
        (TWO.replace('next', 'nxt'), "sections[0].nxt: unknown key, did you mean 'next'?"),
        (TWO.replace('sections', 'section'), 'geometry.section: unknown key'),
        ('geometry:\n  sections:\n' + 20 * '    - machine: stewart_6_6\n', '20 sections, a stack'),
        ('geometry:\n  sections: []\n', 'geometry.sections: 0 sections, a stack has 2 to 6'),
    ],
)  # fmt: skip
def test_what_is_wrong_with_the_sections_is_said(stack, tmp_path, capsys, geometry, problem):
    assert main(['check', written(tmp_path, geometry)]) == 2
    assert problem in capsys.readouterr().out


def test_a_fault_in_a_named_file_is_told_with_the_section_and_the_file(stack, tmp_path, capsys):
    upper = tmp_path / 'parts' / 'upper.yaml'
    upper.write_text(upper.read_text().replace('home_height_mm', 'home_hight_mm'))
    main(['check', stack])
    found = capsys.readouterr().out
    assert 'geometry.sections[1].geometry.home_hight_mm: unknown key' in found
    assert '(of parts/upper.yaml)' in found


def test_a_channel_used_twice_is_named_with_its_joints(tmp_path, capsys):
    path = tmp_path / 'stack.yaml'
    text = machines.find('stack_6_6').read_text()
    path.write_text(text.replace('section_2_leg_2, channel: 7', 'section_2_leg_2, channel: 3'))
    assert main(['check', str(path)]) == 2
    assert '3 is that of section_1_leg_4 and section_2_leg_2' in capsys.readouterr().out
