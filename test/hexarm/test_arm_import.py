"""`hexarm import`: an arm's URDF becomes a machine file whose tool is where the URDF puts it."""

import json
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from arm_control.urdf_chain import arm_of
from arm_control.urdf_file import read_urdf, with_right_angles
from hexarm import machines
from hexarm.arm_import import ImportOptions, machine_text
from hexarm.cli.main import main
from hexarm.machine_check import report_of
from hexarm.simulation.arm_model import arm_links
from hexarm.simulation.model import dynamics_of
from manipulator.config import parse_yaml
from manipulator.errors import ConfigError
from manipulator.rotation import from_rpy

QUARTERS = np.pi / 2 * np.arange(-2, 3)
SIX = ('a', 'b', 'c', 'd', 'e', 'f')


def numbers(values):
    return ' '.join(repr(float(value)) for value in values)


def joint(
    name, parent, child, kind='revolute', xyz=(0, 0, 0.1), rpy=(0, 0, 0), axis=(0, 0, 1), rest=''
):
    if not rest and kind == 'revolute':
        rest = '<limit lower="-2" upper="2.5" velocity="3" effort="7"/>'
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{numbers(xyz)}" rpy="{numbers(rpy)}"/><axis xyz="{numbers(axis)}"/>'
        f'{rest}</joint>'
    )


def robot(links, joints, name='arm'):
    made = ''.join(link if '<' in link else f'<link name="{link}"/>' for link in links)
    return f'<robot name="{name}">{made}{"".join(joints)}</robot>'


def plain(*changes, links=(), kind='revolute', count=6):
    """link_0 to link_6, the last three axes through one point; changes: further joints."""
    names = [f'link_{i}' for i in range(count + 1)]
    axes = [(0, 0, 1), (0, 1, 0), (0, 1, 0), (1, 0, 0), (0, 1, 0), (1, 0, 0), (0, 1, 0)]
    joints = [
        joint(
            f'joint {i}'.replace(' ', '_'),
            names[i],
            names[i + 1],
            kind,
            (0.05, 0, 0.1 if i < 4 else 0),
            axis=axes[i],
        )
        for i in range(count)
    ]
    return robot([*names, *links], [*joints, *changes])


def random_urdf(rng):
    """Six turning joints with fixed ones between and beside them."""
    links, joints, here = ['base'], [], 'base'

    def place():
        angles = rng.choice(QUARTERS, 3) if rng.random() < 0.5 else rng.uniform(-4, 4, 3)
        angles = angles + rng.choice([0.0, 1e-6, 5e-12, 2e-15])  # as in 1.5708 and 1.57079632679
        return {'xyz': rng.uniform(-0.4, 0.4, 3), 'rpy': angles}

    for i in range(6):
        for _ in range(rng.integers(0, 3)):
            links.append(f'fixed_{len(links)}')
            joints.append(joint(f'to_{links[-1]}', here, links[-1], 'fixed', **place()))
            if rng.random() < 0.7:
                here = links[-1]
        axis = np.eye(3)[rng.integers(3)] if rng.random() < 0.5 else rng.normal(size=3)
        links.append(f'link_{i}')
        kind = 'continuous' if rng.random() < 0.2 else 'revolute'
        joints.append(joint(SIX[i], here, links[-1], kind, axis=axis, **place()))
        here = links[-1]
    links.append('tip')
    joints.append(joint('to_tip', here, 'tip', 'fixed', **place()))
    order = rng.permutation(len(joints))
    return robot(links, [joints[k] for k in order])


def tool_of(text, base, tip, angles):
    """T_base_tip by the definition of URDF, in doubles: origin, then a turn about the axis."""
    above = {e.find('child').get('link'): e for e in ET.fromstring(text).findall('joint')}
    frame, link = np.eye(4), tip
    while link != base:
        element = above[link]
        origin = {
            key: [float(v) for v in element.find('origin').get(key).split()]
            for key in ('xyz', 'rpy')
        }
        step = np.eye(4)
        step[:3, :3], step[:3, 3] = from_rpy(origin['rpy']), origin['xyz']
        if element.get('name') in angles:
            axis = np.array([float(v) for v in element.find('axis').get('xyz').split()])
            axis /= np.linalg.norm(axis)
            q, cross = angles[element.get('name')], np.cross(np.eye(3), axis)
            turn = np.eye(4)
            turn[:3, :3] += np.sin(q) * cross + (1 - np.cos(q)) * cross @ cross
            step = step @ turn
        frame, link = step @ frame, element.find('parent').get('link')
    return frame


def imported(text, base=None, tip=None, options=ImportOptions()):  # noqa: B008 (frozen)
    source = read_urdf(text)
    return machine_text(arm_of(source, base, tip), source.name, 'arm.urdf', options).text


def saved(tmp_path, text, name='arm.yaml'):
    path = tmp_path / name
    path.write_text(text)
    return str(path)


def test_random_chains_and_their_way_back_through_urdf_put_the_tool_where_it_was(tmp_path, capsys):
    rng = np.random.default_rng(8)
    for _ in range(8):
        text = random_urdf(rng)
        file = saved(tmp_path, imported(text, tip='tip'))
        kinematics = machines.load(file).kinematics
        assert kinematics.joint_names == SIX
        assert main(['urdf', file]) == 0
        back = capsys.readouterr().out
        for angles in rng.uniform(-2.0, 2.0, (4, 6)):
            named = dict(zip(SIX, angles, strict=True))
            expected = tool_of(text, 'base', 'tip', named)
            pose = kinematics.forward(angles).pose
            assert np.abs(pose.position - expected[:3, 3]).max() < 1e-12
            assert np.abs(pose.rotation - expected[:3, :3]).max() < 1e-12
            again = tool_of(back, 'base', 'platform', named)
            assert np.abs(again - expected).max() < 1e-12


def test_ranges_speeds_and_efforts_come_back(tmp_path, capsys):
    file = saved(tmp_path, imported(plain(links=[], kind='revolute')))
    limits = machines.load(file).kinematics.limits
    np.testing.assert_allclose([limits.low, limits.high], [[-2.0] * 6, [2.5] * 6], rtol=1e-14)
    np.testing.assert_allclose(limits.speed, 3.0, rtol=1e-14)
    assert main(['urdf', file]) == 0
    back = [
        j.find('limit').attrib for j in ET.fromstring(capsys.readouterr().out).findall('joint')[:6]
    ]
    assert [float(limit['lower']) for limit in back] == pytest.approx([-2.0] * 6, rel=1e-14)


WEIGHED = (
    '<link name="{}"><inertial><origin xyz="0.01 0.02 0.03" rpy="0.3 -0.2 0.5"/><mass value="2"/>'
    '<inertia ixx="0.02" ixy="0.001" ixz="-0.002" iyy="0.03" iyz="0.003" izz="0.04"/></inertial>'
    '</link>'
)


def weighed(**changes):
    """The plain arm with masses, a tool on a fixed joint, and a finger that slides on it."""
    text = plain(
        joint('mount', 'link_6', 'tool', 'fixed', (0, 0, 0.05), (0.1, 0.2, 0.3)),
        joint('slide', 'tool', 'finger', 'prismatic'),
        links=[WEIGHED.format('tool'), WEIGHED.format('finger')],
    )
    for i in range(1, 7):
        body = WEIGHED.format(f'link_{i}')
        for old, new in changes.items():
            body = body.replace(old, new)
        text = text.replace(f'<link name="link_{i}"/>', body)
    return text


def test_masses_and_inertias_are_those_of_the_file_with_fixed_links_folded_in(tmp_path):
    text = weighed()
    file = saved(tmp_path, imported(text))
    described = dynamics_of(machines.read(file))
    bodies = arm_links(machines.load(file).kinematics, described)
    assert [body.mass for body in bodies] == pytest.approx([2.0] * 5 + [6.0])
    own, turned = (
        np.array([[0.02, 0.001, -0.002], [0.001, 0.03, 0.003], [-0.002, 0.003, 0.04]]),
        from_rpy((0.3, -0.2, 0.5)),
    )
    total, moment, about = 0.0, np.zeros(3), np.zeros((3, 3))
    for link in ('link_6', 'tool', 'finger'):
        frame = tool_of(text, 'link_0', link, {})
        centre = frame[:3, :3] @ [0.01, 0.02, 0.03] + frame[:3, 3]
        axes = frame[:3, :3] @ turned
        total, moment = total + 2.0, moment + 2.0 * centre
        about += axes @ own @ axes.T + 2.0 * (
            centre @ centre * np.eye(3) - np.outer(centre, centre)
        )
    centre = moment / total
    about -= total * (centre @ centre * np.eye(3) - np.outer(centre, centre))
    np.testing.assert_allclose(bodies[5].centre, centre, atol=1e-12)
    np.testing.assert_allclose(bodies[5].inertia, about, atol=1e-12)
    assert described.links[0].drive.torque_n_m == 7.0


def test_an_inertia_that_no_body_has_is_left_out_and_marked():
    text = imported(weighed(**{'izz="0.04"': 'izz="4"'}))
    assert 'inertia (no body has that of the file)' in text
    assert ', inertia_g_mm2' not in text


def test_what_the_file_does_not_say_is_assumed_and_marked():
    text = plain().replace(' velocity="3" effort="7"', '').replace('lower="-2" upper="2.5"', '')
    made = imported(text)
    assert made.count('# assumed: range, speed, acceleration') == 6
    assert 'home_deg' in made
    assert 'No dynamics: the file has no mass' in made
    told = imported(plain(), options=ImportOptions([0, 20, 40, 0, 30, 0], 500.0))
    assert 'home_deg: [0.0, 20.0, 40.0, 0.0, 30.0, 0.0]\n' in told
    assert 'acceleration_deg_s2: 500.0}\n' in told


def test_home_is_within_the_ranges_and_not_near_a_singular_posture(tmp_path):
    rng = np.random.default_rng(9)
    for k in range(5):
        file = saved(tmp_path, imported(random_urdf(rng), tip='tip'), f'{k}.yaml')
        kinematics = machines.load(file).kinematics
        assert kinematics.sigma_min(kinematics.home, kinematics.rest) > 0.08


def test_home_is_no_joint_stop(tmp_path):
    text = plain().replace('lower="-2" upper="2.5"', 'lower="0" upper="3"')
    kinematics = machines.load(saved(tmp_path, imported(text))).kinematics
    stops = np.array([kinematics.limits.low, kinematics.limits.high])
    assert np.abs(kinematics.rest - stops).min() > np.radians(9.0)


@pytest.mark.parametrize('name', ['yes', '1.5', 'null', 'a-b', 'left/elbow'])
def test_names_that_yaml_would_take_for_something_else_stay_names(tmp_path, name):
    file = saved(tmp_path, imported(plain().replace('"joint_2"', f'"{name}"')))
    assert machines.load(file).kinematics.joint_names[2] == name


def test_a_robot_named_with_anything_stays_in_its_comments():
    made = imported(plain().replace('name="arm"', 'name="a&#10;kind: x&#10;# &quot;b"'))
    assert report_of(parse_yaml(made)).problems == ()
    assert parse_yaml(made)['kind'] == 'serial_arm'


def test_of_several_tips_tool0_is_taken_and_without_one_all_are_named():
    flange = joint('m', 'link_6', 'flange', 'fixed')
    tool = joint('t', 'flange', 'left_tool0', 'fixed')
    sensor = joint('s', 'link_6', 'sensor', 'fixed')
    both = plain(flange, tool, sensor, links=['flange', 'left_tool0', 'sensor'])
    assert arm_of(read_urdf(both)).tip == 'left_tool0'
    with pytest.raises(ConfigError, match='the tip is not clear, --tip: flange, sensor'):
        arm_of(read_urdf(plain(flange, sensor, links=['flange', 'sensor'])))
    assert arm_of(read_urdf(both), tip='sensor').tip == 'sensor'
    assert arm_of(read_urdf(both), base='link_0', tip='link_6').chain.points[0].tolist() == [
        0.05,
        0,
        0.1,
    ]


AHEAD = ['--xyz', '0.15', '0', '0.4']
PROPERTY = '<xacro:property xmlns:xacro="http://www.ros.org/wiki/xacro" name="width" value="0.2"/>'
REFUSED = {
    'loop': (plain(joint('back', 'link_4', 'link_2', 'fixed')), 'below two joints, .*: a loop'),
    'circle': (
        robot(['a', 'b', 'c'], [joint('x', 'b', 'c'), joint('y', 'c', 'b')]),
        'is below itself: a loop',
    ),
    'prismatic': (
        plain(kind='prismatic'),
        "joint 'joint_0' is prismatic, an arm has joints that turn",
    ),
    'mimic': (
        plain().replace('effort="7"/>', 'effort="7"/><mimic joint="joint_1"/>', 1),
        "joint 'joint_0' mimics 'joint_1', an arm has a drive for each",
    ),
    'mimic further out': (
        plain()
        .replace('effort="7"/>', 'effort="7"/><mimic joint="joint_1"/>', 4)
        .replace('<mimic joint="joint_1"/>', '', 3),
        "joint 'joint_3' mimics 'joint_1', an arm has a drive for each",
    ),
    'seven': (
        plain(joint('jaw', 'link_7', 'left', 'prismatic'), links=['left'], count=7),
        "to tip 'link_7': 7 axes",
    ),
    'seven axes': (
        plain(count=7),
        "to tip 'link_7': 7 axes, arms with 6 .*a gripper follows, --tip",
    ),
    'seven and tool0': (
        plain(joint('t', 'link_7', 'tool0', 'fixed'), links=['tool0'], count=7),
        "to tip 'tool0': 7 axes",
    ),
    'five and fingers': (
        plain(
            joint('left', 'link_5', 'left', 'prismatic'),
            joint('turning', 'link_5', 'turned'),
            links=['left', 'turned'],
            count=5,
        ),
        "to tip 'link_5': 5 axes",
    ),
    'two arms': (
        robot(
            ['torso', *(f'{side}_{i}' for side in 'lr' for i in range(6))],
            [
                joint(f'{side}{i}', f'{side}_{i - 1}' if i else 'torso', f'{side}_{i}')
                for side in 'lr'
                for i in range(6)
            ],
        ),
        'the tip is not clear, --tip: l_5, r_5',
    ),
    'five': (
        plain(count=5),
        "to tip 'link_5': 5 axes, arms with 6 are supported; 5 and 7 are planned",
    ),
    'no link': (plain(joint('x', 'link_6', 'nowhere')), "its child 'nowhere' is no link"),
    'two roots': (plain(links=['alone']), 'the base is not clear, --base: link_0, alone'),
    'twice': (plain(links=['link_3']), "link 'link_3': is there twice"),
    'no axis': (plain().replace('axis xyz="0.0 1.0 0.0"', 'axis xyz="0 0 0"'), 'has no direction'),
    'no number': (
        plain().replace('lower="-2"', 'lower="${-PI}"'),
        'lower of limit is .* needs 1 finite number',
    ),
    'not finite': (plain().replace('0.05 0.0 0.1', 'nan 0 0'), 'needs 3 finite numbers'),
    'kind': (plain(kind='ball'), "type 'ball' is not one of"),
    'mass': (weighed(**{'mass value="2"': 'mass value="-2"'}), 'mass -2 kg is negative'),
    'xacro': (
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include filename="x"/></robot>',
        'is xacro, needs plain URDF: run  xacro FILE',
    ),
    'xacro property': (plain(links=[PROPERTY]).replace('"2.5"', '"${width}"'), 'is xacro, needs'),
    'sliding wrist': (
        plain(
            joint('slide', 'link_4', 'end', 'prismatic'),
            joint('last', 'end', 'hand'),
            links=['end', 'hand'],
            count=4,
        ),
        "joint 'slide' is prismatic, an arm has joints that turn",
    ),
    'entities': ('<!DOCTYPE r [<!ENTITY a "aaaa">]><robot name="&a;"/>', 'has a document type'),
    'other': ('<sdf/>', "its root is 'sdf', needs <robot>"),
    'broken': ('<robot>', 'is not XML'),
    'huge': ('<robot>' + ' ' * 5_000_001 + '</robot>', 'at most 5000000 are read'),
    'links': (robot([f'l{i}' for i in range(2001)], []), '2001 links, at most 2000'),
    'empty': ('<robot/>', 'there is no link'),
}


@pytest.mark.parametrize('fault', REFUSED)
def test_what_is_no_arm_is_refused_by_name(fault):
    text, said = REFUSED[fault]
    with pytest.raises(ConfigError, match=said) as caught:
        arm_of(read_urdf(text))
    assert len(str(caught.value)) < 1000


def test_an_arm_of_endless_joints_has_no_margins_and_its_answers_are_json(tmp_path, capsys):
    def strict(constant):
        raise AssertionError(constant)

    file = saved(tmp_path, imported(plain(kind='continuous')))
    for words, limits in (
        (['check', file], 'smallest_margins'),
        (['reach', file, *AHEAD], 'limits'),
    ):
        assert main([*words, '--json']) == 0
        assert json.loads(capsys.readouterr().out, parse_constant=strict)[limits] == []
        assert main(words) == 0
        assert 'inf' not in capsys.readouterr().out


def test_a_xacro_property_that_nothing_uses_does_not_matter():
    assert arm_of(read_urdf(plain(links=[PROPERTY]))).tip == 'link_6'


def test_an_arm_ends_before_the_joint_of_a_gripper_that_its_other_fingers_mimic():
    knuckle = joint('knuckle', 'link_6', 'left')
    mimic = joint('f', 'link_6', 'right', rest='<mimic joint="knuckle"/>')
    text = plain(knuckle, mimic, links=['left', 'right'])
    assert arm_of(read_urdf(text)).tip == 'link_6'


def test_an_arm_ends_at_what_carries_its_fingers():
    fingers = [joint('f', 'link_6', 'left'), joint('g', 'link_6', 'right', 'prismatic')]
    assert arm_of(read_urdf(plain(*fingers, links=['left', 'right']))).tip == 'link_6'
    mimic = joint('f', 'link_6', 'left', rest='<mimic joint="joint_1"/>')
    assert arm_of(read_urdf(plain(mimic, links=['left']))).tip == 'link_6'
    single = plain(joint('f', 'link_6', 'left'), links=['left'])
    with pytest.raises(ConfigError, match='7 axes'):
        arm_of(read_urdf(single))
    assert arm_of(read_urdf(single), tip='link_6').tip == 'link_6'


def test_right_angles_that_the_file_rounds_are_exact_on_request(tmp_path, capsys):
    rows = [
        ((0.0, 0.0, 0.3), (0.0, 0.0, 0.0)),
        ((0.05, 0.0, 0.0), (1.5708, 0.0, 0.0)),
        ((0.4, 0.0, 0.0), (6.2832, 0.0, 0.0)),
        ((0.02, 0.0, 0.0), (-1.5708, 0.0, 0.0)),
        ((0.0, 0.0, 0.35), (1.5708, 0.0, 0.0)),
        ((0.0, 0.0, 0.0), (-1.5708, 0.0, 0.0)),
    ]
    links = [f'l{i}' for i in range(7)]
    pairs = zip(SIX, links, links[1:], rows, strict=False)
    joints = [joint(name, a, b, xyz=xyz, rpy=rpy) for name, a, b, (xyz, rpy) in pairs]
    text = robot(links, joints)
    source = saved(tmp_path, text, 'a.urdf')
    files = {option: str(tmp_path / f'{len(option)}.yaml') for option in ('', '--right-angles')}
    for option, file in files.items():
        assert main(['import', source, '--output', file, *option.split()]) == 0
        assert ('with --right-angles' in capsys.readouterr().out) == (option == '')
        assert machines.load(file).kinematics.is_explicit == (option != '')
    angles = np.array([0.3, -0.4, 0.2, 0.5, -0.6, 0.7])
    for rounded, right in (('1.5708', np.pi / 2), ('6.2832', 2 * np.pi)):
        text = text.replace(rounded, repr(right))
    expected = tool_of(text, 'l0', 'l6', dict(zip(SIX, angles, strict=True)))
    pose = machines.load(files['--right-angles']).kinematics.forward(angles).pose
    assert np.abs(pose.position - expected[:3, 3]).max() < 1e-12


def test_angles_that_are_meant_are_kept():
    for angles in ((1.57, 0.3, 0.0), (1.57, 0.0, 0.0), (0.0, 0.0, 2e-4)):
        text = plain().replace('rpy="0.0 0.0 0.0"', f'rpy="{numbers(angles)}"')
        kept = with_right_angles(read_urdf(text)).joints[0].origin.rotation
        assert np.abs(kept - from_rpy(angles)).max() < 1e-12


def test_command_writes_a_file_that_is_good_and_never_over_another(tmp_path, capsys):
    source, output = saved(tmp_path, weighed(), 'arm.urdf'), tmp_path / 'mine.yaml'
    words = [
        'import',
        source,
        '--tip',
        'tool',
        '--prefix',
        'l/',
        '--output',
        str(output),
        '--json',
    ]
    assert main(words) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer['tip'] == 'tool'
    assert any('acceleration' in line for line in answer['assumed'])
    assert machines.load(str(output)).kinematics.joint_names == tuple(answer['joints'])
    assert answer['joints'][0] == 'l/joint_0'
    assert main(['check', str(output)]) == 0
    capsys.readouterr()
    before = output.read_text()
    assert main(words) == 2
    assert 'exists: another name with --output' in capsys.readouterr().out
    assert output.read_text() == before
    assert main(['import', source, '--tip', 'elbow']) == 2
    assert "tip 'elbow' is no link of the file, which has link_0" in capsys.readouterr().err
    assert main(['import', str(tmp_path / 'none.urdf')]) == 2
    assert 'No such file' in capsys.readouterr().err
