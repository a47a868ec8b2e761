"""`hexarm urdf`: a file, or why there is none."""

import xml.etree.ElementTree as ET

import pytest

from hexarm.cli.main import main


@pytest.mark.parametrize('machine', ['arm_6r', 'arm_6r_stepper', 'ur5', 'puma560'])
def test_every_arm_has_one(tmp_path, capsys, machine):
    path = tmp_path / 'arm.urdf'
    assert main(['urdf', machine, '--output', str(path)]) == 0
    assert f'{path}: 6 joints' in capsys.readouterr().out
    robot = ET.parse(path).getroot()
    links = [link.get('name') for link in robot.findall('link')]
    assert links == ['base', *(f'link_{i}' for i in range(1, 7)), 'platform']
    assert robot.get('name') == machine


def test_torque_of_the_drives_is_the_limit_of_effort(capsys):
    assert main(['urdf', 'ur5']) == 0
    limit = ET.fromstring(capsys.readouterr().out).find('joint/limit')
    assert float(limit.get('effort')) == 150.0


@pytest.mark.parametrize(
    ('words', 'reason'),
    [
        (['robocake'], 'URDF has no closed loops: hexarm mjcf robocake'),
        (['arm_6r', '--output', '/does/not/exist.urdf'], 'cannot write'),
        (['arm_7r'], "did you mean 'arm_6r'"),
    ],
)
def test_refusals(capsys, words, reason):
    assert main(['urdf', *words]) == 2
    assert reason in capsys.readouterr().err
