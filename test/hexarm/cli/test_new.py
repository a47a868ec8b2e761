"""`hexarm new`: known machines come back from the measures that people have of them."""

import io

import numpy as np
import pytest
import yaml

from hexarm import machines
from hexarm.cli import new
from hexarm.cli.main import main
from hexarm.machine_check import report_of
from hexarm.machines import load
from hexarm.new.questions import QUESTIONS, checked
from hexarm.new.reading import SIZE, numbers
from manipulator.config import parse_yaml
from manipulator.errors import ConfigError, InvalidInput

ROBOCAKE = {
    'kind': 'crank', 'given_by': 'paper', 'body_radius_mm': 71.492, 'crank_offset_mm': 25,
    'crank_shift_mm': 5.79, 'joint_inset_mm': 1.5, 'joint_shift_mm': 30, 'horn_length_mm': 17.5,
    'rod_length_mm': 58, 'home_height_mm': 41.19, 'servo': 'SG90',
}  # fmt: skip
STEWART = {
    'kind': 'linear', 'given_by': 'circles', 'base_radius_mm': 100, 'base_angles_deg': 50,
    'platform_radius_mm': 50, 'platform_angles_deg': 10, 'base_joint_height_mm': 5,
    'platform_joint_height_mm': 5, 'retracted_mm': 140, 'stroke_mm': 100,
    'cylinder_speed_mm_s': 25, 'joint_swing_deg': 45,
}  # fmt: skip
TABLE = [
    [0, 90, 89.159], [-425, 0, 0], [-392.25, 0, 0], [0, 90, 109.15], [0, -90, 94.65], [0, 0, 82.3],
]  # fmt: skip
UR5 = {
    'kind': 'arm', 'given_by': 'dh', 'dh_table': TABLE, 'joint_ranges_deg': [-360, 360],
    'servo_speed_deg_s': 180,
}  # fmt: skip
LEVEL = {
    'kind': 'crank', 'given_by': 'circles', 'base_radius_mm': 80, 'base_angles_deg': 45,
    'platform_radius_mm': 60, 'platform_angles_deg': 15, 'horn_length_mm': 20,
    'horn_direction_deg': 135, 'rod_length_mm': 90, 'servo': 'MG996R',
}  # fmt: skip


def made(measures, **others):
    text = new.machine_text(checked({'description': 'mine', **measures, **others}))
    content = parse_yaml(text)
    report = report_of(content)
    assert (report.problems, report.warnings) == ((), ())
    return content, report.machine.kinematics


def shipped(name):
    return parse_yaml(machines.find(name).read_text()), load(name).kinematics


def test_robocake_comes_back_from_the_papers_parameters():
    content, kinematics = made(ROBOCAKE)
    expected, cake = shipped('robocake')
    assert content['geometry'] == expected['geometry']
    assert content['limits']['crank_range_deg'] == [30.0, 210.0]
    assert content['motion']['joint_speed_deg_s'] == 480.0
    assert content['servos']['park_deg'] == expected['servos']['park_deg']
    assert [j['sign'] for j in content['servos']['joints']] == [1, -1, 1, -1, 1, -1]
    home = kinematics.inverse(kinematics.home)
    np.testing.assert_allclose(home, cake.inverse(cake.home), atol=1e-9)


def test_robocake_comes_back_from_circles_and_directions():
    """Measured to a hundredth of a millimetre or degree: joints to 0.02 mm."""
    _, cake = shipped('robocake')
    centres, joints = cake.geometry.crank_centres, cake.geometry.platform_points
    polar = {
        f'{plate}_{key}': np.round(value, 2).tolist()
        for plate, points in (('base', centres), ('platform', joints))
        for key, value in (
            ('radius_mm', 1e3 * np.hypot(points[0, 0], points[0, 1])),
            ('angles_deg', np.degrees(np.arctan2(points[:, 1], points[:, 0]))),
        )
    }
    circles = {k: v for k, v in ROBOCAKE.items() if not k.endswith(('offset_mm', 'shift_mm'))}
    del circles['body_radius_mm'], circles['joint_inset_mm']
    directions = [-90, 150, 30, 270, 150, 30]
    _, kinematics = made(
        circles | {'given_by': 'circles', 'horn_direction_deg': directions} | polar
    )
    np.testing.assert_allclose(kinematics.geometry.crank_centres, centres, atol=2e-5)
    np.testing.assert_allclose(kinematics.geometry.platform_points, joints, atol=2e-5)
    np.testing.assert_allclose(kinematics.geometry.tangents, cake.geometry.tangents, atol=1e-5)


def test_reachys_head_comes_back_from_coordinates():
    expected, head = shipped('reachy_mini')
    geometry = expected['geometry']
    content, kinematics = made(
        {
            'kind': 'crank', 'given_by': 'coordinates', 'servo': 'XL330',
            'base_joints_mm': geometry['crank_centres_mm'],
            'platform_joints_mm': geometry['platform_joints_mm'], 'horn_direction_deg': -30,
            'horn_length_mm': 38, 'rod_length_mm': 90, 'home_height_mm': 177,
            'horn_travel_deg': 160, 'horn_at_middle_deg': 0, 'joint_swing_deg': 45,
        }
    )  # fmt: skip
    assert content['driver'] == 'topic'
    assert content['limits']['crank_range_deg'] == [100.0, 260.0]
    np.testing.assert_allclose(content['geometry']['crank_tangents'], geometry['crank_tangents'],
                               atol=1e-5)  # fmt: skip
    np.testing.assert_allclose(kinematics.inverse(kinematics.home), head.inverse(head.home),
                               atol=1e-5)  # fmt: skip


RAILS = {'kind': 'rail', 'stroke_mm': 100, 'cylinder_speed_mm_s': 100, 'joint_swing_deg': 40}


def test_rails_come_back_from_coordinates():
    expected, rails = shipped('linear_rails')
    geometry = expected['geometry']
    content, kinematics = made(
        RAILS,
        given_by='coordinates',
        base_joints_mm=geometry['rail_points_mm'],
        platform_joints_mm=geometry['platform_joints_mm'],
        rod_length_mm=150.362,
        rail_direction='up',
    )
    assert content['geometry']['home_height_mm'] == pytest.approx(297.847, abs=1e-3)
    assert [j['centre_mm'] for j in content['servos']['joints']] == [50.0] * 6
    assert content['limits']['rail_range_mm'] == [2.0, 98.0]
    joints = kinematics.inverse(kinematics.home)
    np.testing.assert_allclose(joints, rails.inverse(rails.home), atol=1e-5)


@pytest.mark.parametrize(
    ('directions', 'side'),
    [
        ({'rail_direction': 'up'}, 'behind'),
        ({'rail_direction': 'down'}, 'ahead'),
        ({'rail_direction': 'out'}, 'ahead'),
        ({'rail_direction': 'in'}, 'behind'),
        ({'rail_direction': 'own', 'rail_directions': [[0.3, 0, 1], [0, 0.3, 1]] * 3}, 'behind'),
    ],
)
def test_carriages_are_in_the_middle_of_their_travel_at_home(directions, side):
    circles = {f'base_{k}': STEWART[f'base_{k}'] for k in ('radius_mm', 'angles_deg')}
    circles |= {f'platform_{k}': STEWART[f'platform_{k}'] for k in ('radius_mm', 'angles_deg')}
    content, kinematics = made(
        RAILS, given_by='circles', rod_length_mm=200, **circles, **directions
    )
    assert content['geometry']['carriages'] == side
    joints = kinematics.inverse(kinematics.home)
    assert joints.mean() == pytest.approx(0.05, abs=1e-5)


def test_linear_platform_comes_back_from_radii_angles_and_cylinders():
    content, _ = made(STEWART)
    expected, _ = shipped('stewart_6_6')
    assert content['geometry'] == expected['geometry']
    assert content['limits'] == expected['limits'] | {'singularity_margin': 0.29}
    assert content['servos']['joints'] == expected['servos']['joints']
    assert content['servos']['park_mm'] == expected['servos']['park_mm']


def test_arm_comes_back_from_its_table_with_a_home_that_is_chosen():
    content, kinematics = made(UR5)
    _, ur5 = shipped('ur5')
    joints = np.linspace(-1.0, 1.5, 6)
    apart = kinematics.forward(joints).pose.position - ur5.forward(joints).pose.position
    assert np.abs(apart).max() < 1e-12
    assert content['driver'] == 'topic'
    assert kinematics.sigma_min(kinematics.home, kinematics.inverse(kinematics.home)) > 0.2


def test_home_height_has_level_horns_and_rods_of_their_length():
    for height, level in (('auto', np.pi), (-70, 0.0)):
        _, kinematics = made(LEVEL, home_height_mm=height, horn_at_middle_deg=0)
        joints = kinematics.inverse(kinematics.home)
        tips = kinematics.crank_tips(joints)
        rods = kinematics.home.transform(kinematics.geometry.platform_points) - tips
        np.testing.assert_allclose(np.linalg.norm(rods, axis=1), 0.09, atol=1e-9)
        if height == 'auto':
            np.testing.assert_allclose(joints, level, atol=1e-4)
        else:
            assert np.abs(joints).max() < np.pi / 2


def test_arm_comes_back_from_its_urdf(tmp_path, capsys):
    urdf, file = tmp_path / 'arm.urdf', tmp_path / 'mine.yaml'
    assert main(['urdf', 'arm_6r', '--output', str(urdf)]) == 0
    words = [f'urdf={urdf}', 'kind=arm', 'given_by=urdf']
    assert main(['new', str(file), '--no-pictures', '--set', *words]) == 0
    assert f'hexarm up {file} --panel' in capsys.readouterr().out
    joints = np.full(6, 0.4)
    mine, arm = (load(name).kinematics.forward(joints).pose for name in (str(file), 'arm_6r'))
    assert np.abs(mine.position - arm.position).max() < 1e-6


def test_everything_that_is_wrong_is_named_at_once():
    with pytest.raises(InvalidInput) as refused:
        checked(ROBOCAKE | {'servo': 'SG9', 'rod_length_mm': '-3', 'rod_lenght_mm': 58})
    assert str(refused.value).splitlines() == [
        'rod_length_mm: -3 is outside 0.001 … 1e+06',
        "servo: 'SG9' is not one of SG90, MG90S, MG996R, DS3218, DS3218-270, XL330, STS3215, "
        "other, driver, did you mean 'SG90'?",
        "'rod_lenght_mm': unknown, did you mean 'rod_length_mm'?",
    ]
    with pytest.raises(InvalidInput, match='stroke_mm: not a measure of this kind of machine'):
        checked(ROBOCAKE | {'stroke_mm': 58})


@pytest.mark.parametrize(
    ('measures', 'reason'),
    [
        (LEVEL | {'rod_length_mm': 30}, 'rod_length_mm: 30 mm, but leg 1 has'),
        (LEVEL | {'horn_travel_deg': 200}, 'horn_travel_deg: 200°, the servo turns 180° at most'),
        (STEWART | {'retracted_mm': 10, 'stroke_mm': 20}, 'leg 1 has 69.6 mm from joint to joint'),
        (STEWART | {'platform_angles_deg': 50}, 'no leg lengths fix a pose'),
        (UR5 | {'servo': 'SG90', 'servo_speed_deg_s': None}, 'the servo turns 180° at most'),
        (UR5 | {'dh_table': TABLE[:5]}, 'dh_table: 5 rows, needs 6, in a list or with semicolons'),
        (UR5 | {'dh_table': [[a, 0, d] for a, _, d in TABLE]}, 'in every posture .* all parallel'),
        (UR5 | {'dh_table': [[0, 0, 9]] * 6, 'home_deg': [0] * 6}, 'in every posture that was'),
    ],
    ids=lambda value: value if isinstance(value, str) else '',
)
def test_measures_that_no_machine_has_are_explained(measures, reason):
    given = {k: v for k, v in measures.items() if v is not None}
    with pytest.raises((InvalidInput, ConfigError), match=reason):
        new.machine_text(checked({'description': 'mine', **given}))


def scripted(answers):
    """What a person types, in turn, and what was told."""
    typed, told = iter(answers), []

    def ask(prompt):
        told.append(prompt)
        return next(typed)

    return ask, told


def test_a_person_is_asked_again_until_all_is_understood():
    answers = [
        '', 'cranck', '1', 'circles', '80', 'wide', '45', '', '60', '15', '', 'x', '20', '',
        '135', '30', '', 'MG996R', '', '', '', '', '',  # the rod is too short
        'rod', 'rod_length_mm', '90',
    ]  # fmt: skip
    ask, told = scripted(answers)
    text = new.asked(ask, told.append, 'mine')
    assert text == new.machine_text(checked({'description': 'mine', **LEVEL}))
    said = '\n'.join(told)
    for reason in (
        "'cranck' is not one of crank, linear, rail, arm, did you mean 'crank'?",
        "'wide' is not a number",
        'an answer is needed',
        'These measures do not fit each other:\nrod_length_mm: 30 mm, but leg 1 has',
        "'rod' is not one of these",
    ):
        assert reason in said


@pytest.mark.parametrize(
    ('typed', 'reason'),
    [
        ('67,5', '2 numbers, needs 1 or 6 numbers; decimals have a point: 67.5'),
        ('67, 5', '2 numbers, needs 1 or 6 numbers'),
        ('6.57in', "'6.57in' is not a number: mm, ° and g are meant, without a unit"),
        ('45.5 mm', "'mm' is not a number: mm, ° and g are meant, without a unit"),
        ('wide', "'wide' is not a number"),
    ],
)
def test_decimal_commas_and_units_are_explained(typed, reason):
    with pytest.raises(InvalidInput) as error:
        numbers((1, 6), SIZE)(typed)
    assert str(error.value) == reason


def test_a_table_is_asked_for_row_by_row():
    ask, told = scripted([
        '', 'arm', 'dh', *(' '.join(map(str, row)) for row in TABLE[:1]), '-425 0', '-425 0 0',
        *(', '.join(map(str, row)) for row in TABLE[2:]), '', '-360 360', '', '', '180',
    ])  # fmt: skip
    assert new.asked(ask, told.append, 'm') == new.machine_text(
        checked(UR5 | {'description': 'm'})
    )
    assert '  2 numbers, needs 3 or 4 numbers' in told


def interrupt(*_):
    raise KeyboardInterrupt


class Interrupted(io.StringIO):
    """A file whose writing ends with the first half."""

    write = interrupt


def interrupted_open(path, *_, **__):
    path.touch()
    return Interrupted()


@pytest.mark.parametrize('is_asked', [True, False])
def test_ctrl_c_leaves_no_file(is_asked, tmp_path, monkeypatch, capsys):
    words = [f'{key}={value}' for key, value in ROBOCAKE.items()]
    if is_asked:
        monkeypatch.setattr('builtins.input', interrupt)
    else:
        monkeypatch.setattr(new.Path, 'open', interrupted_open)
    given = [] if is_asked else ['--set', *words]
    assert main(['new', str(tmp_path / 'mine.yaml'), *given]) == 130
    assert 'nothing is written' in capsys.readouterr().out
    assert not list(tmp_path.iterdir())


def test_an_existing_file_stays(tmp_path, capsys):
    file = tmp_path / 'mine.yaml'
    file.write_text('mine')
    assert main(['new', str(file)]) == 2
    assert 'nothing is written over' in capsys.readouterr().err
    assert file.read_text() == 'mine'


def test_file_pictures_and_next_steps(tmp_path, capsys):
    pytest.importorskip('matplotlib')
    answers, file = tmp_path / 'a.yml', tmp_path / 'mine.yaml'
    answers.write_text(yaml.safe_dump(STEWART))
    assert main(['new', str(file), '--answers', str(answers)]) == 0
    said = capsys.readouterr().out
    assert 'no problems' in said
    assert 'joints at home: 190.000' in said
    for picture in (tmp_path / 'mine.png', tmp_path / 'mine_workspace.png'):
        assert str(picture) in said
        assert picture.read_bytes().startswith(b'\x89PNG')
    assert len(list(tmp_path.iterdir())) == 4


def test_keys_are_questions_of_one_meaning():
    for question in QUESTIONS:
        assert question.text
        if question.default not in (None, ''):
            assert question.parse(question.default) is not None
