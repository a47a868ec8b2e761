"""`hexarm check`: one sentence for each thing that is wrong with a machine file, all at once."""

import json
import re
from itertools import combinations

import numpy as np
import pytest
from machine_texts import ARM, CONFIG, ROBOCAKE, STACK, STEWART, UR5, changed

from hexarm.cli.main import main
from hexarm.machine_check import problems_of, report_of
from hexarm.machines import content_of, load
from manipulator.config import parse_yaml
from manipulator.errors import ConfigError
from sampling import some

MISTAKES = (
    ('kind: rotary_hexapod', 'kind: rotry_hexapod'),
    ('rod_length_mm: 58.0', 'rod_lenght_mm: 58.0'),
    ('singularity_margin: 0.3', 'singularity_margin: 2.0'),
    ('name: crank_3', 'name: crnk_3'),
    ('on_link_loss: hold', 'on_link_loss: hope'),
    ('hysteresis_deg', 'histeresis_deg'),
    ('joint_speed_deg_s: 480', 'joint_speed_deg_s: 700'),
    ('thickness_mm: 4.0', 'thicknes_mm: 4.0'),
    ('speed_deg_s: 600.0', 'sped_deg_s: 600.0'),
    ('link:\n', 'lnk:\n'),
)


def without(text, key):
    return '\n'.join(line for line in text.splitlines() if not line.strip().startswith(f'{key}:'))


def section_without(text, name):
    kept, is_inside = [], False
    for line in text.splitlines():
        if not line.startswith(' '):
            is_inside = line.startswith(f'{name}:')
        if not is_inside:
            kept.append(line)
    return '\n'.join(kept)


@pytest.mark.parametrize('file', sorted(CONFIG.glob('*.yaml')), ids=lambda file: file.stem)
def test_shipped_files_are_good(file):
    if 'kind:' in file.read_text():
        report = report_of(content_of(file))
        assert (report.problems, report.warnings) == ((), ())


@pytest.mark.parametrize(
    ('text', 'words'),
    [
        ((CONFIG / 'joystick_xbox.yaml').read_text(), 'its keys are those of a gamepad'),
        ('poses: {}', 'its keys are those of saved poses'),
        ('servers: {}', 'kind, geometry, limits, motion are missing'),
    ],
)
def test_a_file_for_something_else_is_one_line(tmp_path, text, words):
    (problem,) = problems_of(text)
    assert problem.startswith(f'this is no machine file: {words}')
    (tmp_path / 'other.yaml').write_text(text)
    with pytest.raises(ConfigError, match='this is no machine file'):
        load(str(tmp_path / 'other.yaml'))


def test_misspelt_key_names_itself_and_the_nearest():
    assert problems_of(changed(ROBOCAKE, ('rod_length_mm', 'rod_lenght_mm'))) == [
        "geometry.rod_lenght_mm: unknown key, did you mean 'rod_length_mm'?"
    ]


@pytest.mark.parametrize(
    'place',
    ['geometry.home_height_mm', 'limits.crank_range_deg', 'motion.linear_jerk_mm_s3', 'link.baud'],
)
def test_missing_key_is_named(place):
    assert problems_of(without(ROBOCAKE, place.split('.')[1])) == [f'{place}: missing']


@pytest.mark.parametrize('section', ['geometry', 'limits', 'motion', 'servos', 'link'])
def test_missing_section_is_reported_once(section):
    assert problems_of(section_without(ROBOCAKE, section)) == [f'{section}: missing']


def test_rod_shorter_than_its_gap_reports_by_how_much():
    (found,) = problems_of(changed(ROBOCAKE, ('rod_length_mm: 58.0', 'rod_length_mm: 20.0')))
    assert 'home' in found
    assert 'rod too short by' in found
    assert 'mm' in found


def test_problems_of_all_sections_come_at_once():
    found = problems_of(
        changed(
            ROBOCAKE,
            ('rod_length_mm: 58.0', 'rod_length_mm: long'),
            ('crank_range_deg', 'crank_rang_deg'),
            ('linear_speed_mm_s: 50.0', 'linear_speed_mm_s: fast'),
            ('name: crank_3, channel: 2', 'name: crank_3, channel: 1'),
            ('on_link_loss: hold', 'on_link_loss: hope'),
            ('hysteresis_deg', 'hysteresis'),
        )
        + 'colour: red\n'
    )
    for words in (
        'colour: unknown key',
        "motion.linear_speed_mm_s: holds the text 'fast', needs a number",
        "geometry.rod_length_mm: holds the text 'long', needs a number",
        'limits.crank_rang_deg: unknown key',
        'servos: joints: channels [0, 1, 1, 3, 4, 5]',
        "link.on_link_loss: 'hope' is not one of",
        'simulation.hysteresis: unknown key',
    ):
        assert sum(problem.startswith(words) for problem in found) == 1, (words, found)
    assert len(found) == 7


@pytest.mark.parametrize('text', ['', '- 1', 'kind: [', 'kind: 7', 'geometry: 5\nservos: none'])
def test_what_is_no_machine_file_is_refused_in_words(text):
    found = problems_of(text)
    assert found
    assert all(problem.strip() for problem in found)


def test_unknown_kind_names_the_nearest():
    (found,) = problems_of(changed(ROBOCAKE, ('rotary_hexapod', 'rotary_hexpod')))
    assert "did you mean 'rotary_hexapod'?" in found


def test_servo_of_another_name_is_missed_and_found():
    assert problems_of(changed(ROBOCAKE, ('name: crank_3', 'name: crnak_3'))) == [
        "servos.joints: none is called 'crank_3', but 'crnak_3'"
    ]


def test_gripper_beside_the_six_joints_is_no_problem():
    assert 'name: gripper' in ARM
    assert problems_of(ARM) == []


def test_linear_legs_on_rotary_servos_are_refused():
    servos = ROBOCAKE[ROBOCAKE.index('servos:') : ROBOCAKE.index('link:')]
    text = section_without(STEWART, 'servos') + '\n' + servos.replace('crank_', 'leg_')
    (found,) = problems_of(text)
    assert found.startswith('servos.joints: in degrees')


def test_pulse_range_that_does_not_cover_the_joint_range_is_named():
    narrow = (
        'crank_2, channel: 1, sign: -1, centre_us: 1500.0',
        'crank_2, channel: 1, sign: -1, centre_us: 1600.0',
    )
    (found,) = problems_of(changed(ROBOCAKE, narrow))
    # (1600 − 550) / 10.5 = 100° above the centre of 120°, (2450 − 1600) / 10.5 = 80.95° below.
    assert found == (
        'servos.joints: crank_2 reaches [39.05, 220] deg, its range in limits is [30, 210] deg'
    )


def test_servos_that_are_too_narrow_alike_are_one_line():
    (found,) = problems_of(changed(ROBOCAKE, ('[550.0, 2450.0]', '[700.0, 2300.0]')))
    assert found.startswith('servos.joints: crank_1, crank_2, crank_3, crank_4, crank_5, crank_6 ')
    assert found.endswith('reach [43.81, 196.2] deg, their range in limits is [30, 210] deg')
    report = report_of(parse_yaml(changed(ROBOCAKE, ('[30.0, 210.0]', '[-30.0, 210.0]'))))
    assert (len(report.problems), report.warnings) == (1, ())


def test_ranges_that_differ_are_not_written_alike_and_less_than_a_count_is_no_difference():
    lowest = ('centre_us: 1500.0', 'centre_us: 15000.0'), ('us_per_mm: 10.0', 'us_per_mm: 100.0')
    narrow = changed(STEWART, *lowest, ('[1000.0, 2000.0]', '[10201.0, 19800.0]'))
    (found,) = [p for p in problems_of(narrow) if ' reach ' in p]
    assert found.endswith('reach [142.01, 238] mm, their range in limits is [142, 238] mm')
    narrow = changed(STEWART, *lowest, ('[1000.0, 2000.0]', '[10200.4, 19800.0]'))
    assert problems_of(narrow) == []


def test_park_beyond_a_limit_or_a_pulse_range_is_named():
    park = 'park_deg: [120.0, 120.0, 120.0, 120.0, 120.0, 120.0]'
    low = problems_of(changed(ROBOCAKE, (park, f'park_deg: [{", ".join(["40.0"] * 6)}]')))
    assert low
    assert all(problem.startswith('servos.park_deg: ') for problem in low)
    (far,) = problems_of(changed(ROBOCAKE, (park, park.replace('[120.0', '[250.0'))))
    assert far.startswith('servos.park: crank_1: 4.363 rad outside')


def test_pivot_out_of_proportion_is_named():
    (found,) = problems_of(ROBOCAKE + 'frames: {pivot_xyz_mm: [2000.0, 2000.0, 0.0]}\n')
    assert found.startswith('frames.pivot_xyz_mm: pivot [2.0, 2.0, 0.0] is 2.828 m from the platf')


def test_tools_that_do_not_fit_are_named():
    tools = """
tools:
  - {name: far, xyz_mm: [0.0, 0.0, 9000.0]}
  - {name: near, xyz_mm: [0.0, 0.0, 20.0]}
  - {name: huge, xyz_mm: [20000.0, 0.0, 20.0]}
  - {name: lever, xyz_mm: [0.0, 0.0, 20.0], mass_g: 20.0, centre_mm: [0.0, 9e3, 0.0]}
"""
    found = problems_of(ROBOCAKE + tools)
    assert [problem.partition(' [')[0] for problem in found] == [
        "tools[0].xyz_mm: tool 'far'",
        "tools[2].xyz_mm: tool 'huge'",
        "tools[3].centre_mm: centre of tool 'lever'",
    ]
    (endless,) = problems_of(ROBOCAKE + 'tools: [{name: laser, xyz_mm: [0.0, .nan, 0.0]}]\n')
    assert endless == 'tools[0].xyz_mm[1]: nan is not finite'
    (nameless,) = problems_of(ROBOCAKE + 'tools: [{name: a b, xyz_mm: [0.0, 0.0, 0.0]}]\n')
    assert nameless.startswith("tools[0]: name: 'a b' is not a name of a tool: a letter")


def test_speed_beyond_the_servos_is_named():
    (found,) = problems_of(changed(ROBOCAKE, ('joint_speed_deg_s: 480', 'joint_speed_deg_s: 700')))
    assert found.startswith('motion.joint_speed_deg_s: 700 is more than the servos do')


def test_command_prints_each_problem_on_a_line_and_fails(tmp_path, capsys):
    bad = tmp_path / 'bad.yaml'
    bad.write_text(changed(ROBOCAKE, ('rod_length_mm', 'rod_lenght_mm')))
    assert main(['check', str(bad)]) == 2
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == f'{bad}: 1 problem'
    assert lines[1].startswith('geometry.rod_lenght_mm: unknown key')
    assert lines[2].startswith('joints at home: ')


def test_command_answers_programs(tmp_path, capsys):
    assert main(['check', 'robocake', '--json']) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found['problems'], found['warnings']) == ([], [])
    assert found['joints_at_home']['names'] == [f'crank_{i}' for i in range(1, 7)]
    assert found['joints_at_home']['positions'] == pytest.approx([np.radians(120.0)] * 6, abs=1e-4)
    assert main(['check', str(tmp_path / 'none.yaml'), '--json']) == 2
    assert 'does not exist' in json.loads(capsys.readouterr().out)['problems'][0]


def test_file_that_is_no_machine_file_is_one_line_with_its_name(tmp_path, capsys):
    urdf = '<?xml version="1.0"?>\n<robot name="arm">' + '<link name="l"/>' * 800 + '</robot>\n'
    files = {
        'arm.urdf': (urdf.encode(), 'is a URDF: hexarm import FILE makes'),
        'huge.urdf': (urdf.encode() * 20, 'is a URDF: hexarm import FILE makes'),
        'page.yaml': (b'<html>' + b'x' * 20_000, 'is XML or HTML, needs YAML'),
        'mesh.yaml': (bytes(range(256)) * 100, 'cannot be read: it is no text'),
        'text.yaml': (b'just words ' * 2000, "holds the text 'just words"),
        'list.yaml': (b'- 1\n' * 2000, 'holds a list, needs a mapping'),
        'tag.yaml': (b'a: !' + b'x' * 20_000 + b' 1', 'line 1: could not determine a constructor'),
        'log.yaml': (b'a' * 500_000, '500000 bytes, a machine file has at most'),
    }
    for name, (content, reason) in files.items():
        path = tmp_path / name
        path.write_bytes(content)
        for command in (['check', str(path)], ['fk', str(path), *'000000']):
            assert main(command) == 2
            said = ''.join(capsys.readouterr())
            assert said.count('\n') == 1, said
            assert f'{path}: {reason}' in said
            assert len(said) - len(str(path)) < 300, said


def test_long_values_and_names_are_not_repeated_whole():
    long = 'x' * 1000
    text = changed(
        ROBOCAKE,
        ('baud: 250000', f'baud: {long}'),
        ('on_link_loss: hold', f'on_link_loss: {long}'),
        ('name: crank_3', f'name: {long}'),
        ('hysteresis_deg', long),
        ('rotary_hexapod', long),
    )
    found = problems_of(text)
    assert len(found) == 5
    assert max(map(len, found)) < 300


def test_path_that_is_too_long_is_refused_in_words(capsys):
    assert main(['check', '/' + 'x/' * 20_000]) == 2
    said = ''.join(capsys.readouterr())
    assert 'does not exist' in said
    assert len(said) < 300


def test_command_prints_home_and_warnings_and_succeeds(tmp_path, capsys):
    path = tmp_path / 'mine.yaml'
    path.write_text(changed(ROBOCAKE, ('us_per_deg: 10.5', 'us_per_deg: 5.25')))
    assert main(['check', str(path)]) == 0
    head, warning, home, *_ = capsys.readouterr().out.splitlines()
    assert head == f'{path}: no problems, 1 warning'
    assert warning.startswith('warning: servos.joints: crank_1, crank_2')
    assert home == f'joints at home: {"  ".join(["2.094473"] * 6)} rad'
    assert main(['check', str(path), '--units', 'mm']) == 0
    _, _, home, moves, turns, margins = capsys.readouterr().out.splitlines()
    assert home == f'joints at home: {"  ".join(["120.0045"] * 6)} °'
    assert moves == (
        'reach from home: x -15.627 … 15.627  y -15.192 … 19.682  z -17.800 … 17.910 mm'
    )
    assert turns.startswith('reach from home: roll -13.3190 … 17.3988  pitch')
    assert margins.startswith('smallest margins at home: rod shortfall 12.43 mm (leg ')
    assert main(['check', 'stewart_6_6']) == 0
    assert '0.190000  0.190000 m' in capsys.readouterr().out


def test_one_wrong_word_in_every_entry_of_a_list_is_one_line():
    assert problems_of(changed(ROBOCAKE, ('centre_deg', 'center_deg'))) == [
        "servos.joints[0, 1, 2, 3, 4, 5].center_deg: unknown key, did you mean 'centre_deg'?"
    ]


@pytest.mark.parametrize('text', [ROBOCAKE, STEWART, UR5, STACK])
def test_one_wrong_letter_is_one_line(text):
    text = re.sub('#.*|^description.*', '', re.sub('".*?"', 'x', text), flags=re.MULTILINE)
    words = {*re.findall(r'(\w{4,}):', text), *re.findall(r'^kind: (\w+)', text)}
    for word in some(sorted(words), 20):
        wrong = re.sub(rf'\b{word}\b', f'{word[:2]}q{word[3:]}', text, count=1)
        assert len(problems_of(wrong)) == 1, (word, problems_of(wrong))


def test_the_kind_of_another_machine_is_one_line():
    assert problems_of(changed(STEWART, ('kind: linear_hexapod', 'kind: serial_arm'))) == [
        "kind: 'serial_arm', but geometry has the keys of a linear_hexapod"
    ]


@pytest.mark.parametrize('kind', ['kind: rotary_hexpod', 'kind: 7', '', 'kind: serial_arm'])
def test_what_else_is_wrong_is_found_whatever_the_kind_says(kind):
    found = problems_of(
        changed(ROBOCAKE, ('kind: rotary_hexapod', kind), ('[30.0, 210.0]', '[130.0, 210.0]'))
    )
    assert found[0].startswith('kind: ')
    assert found[1:] == ['limits: home has crank angle 120° on all legs, outside [130, 210]°']


def test_no_mistake_hides_another():
    alone = {mistake: set(problems_of(changed(ROBOCAKE, mistake))) for mistake in MISTAKES}
    for first, second in combinations(MISTAKES, 2):
        found = problems_of(changed(ROBOCAKE, first, second))
        assert set(found) == alone[first] | alone[second], (first, second)
    whole = problems_of(changed(ROBOCAKE, *MISTAKES))
    assert set(whole) == set().union(*alone.values())


def test_reach_and_margins_are_there_for_programs(capsys):
    assert main(['check', 'stewart_6_6', '--json']) == 0
    found = json.loads(capsys.readouterr().out)
    low, high = found['reach']['z']
    machine = load('stewart_6_6')
    home = machine.kinematics.home
    for end in (low, high):
        edge = home.moved(np.array([0.0, 0.0, end, 0.0, 0.0, 0.0]))
        beyond = home.moved(np.array([0.0, 0.0, 1.001 * end, 0.0, 0.0, 0.0]))
        assert machine.constraints.admits(edge, machine.kinematics.inverse(edge))
        assert not machine.constraints.admits(beyond, machine.kinematics.inverse(beyond))
    margins = {m['quantity']: m['margin'] for m in found['smallest_margins']}
    assert margins['leg length'] == pytest.approx(0.048, abs=1e-6)
