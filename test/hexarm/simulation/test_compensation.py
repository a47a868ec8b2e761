"""What compensation of gravity gains, measured in simulation."""

import json

import numpy as np
import pytest

from hexarm import machines
from hexarm.cli.main import main
from hexarm.simulation.compensation import Compensation
from hexarm.simulation.model import dynamics_of
from hexarm.simulation.static_load import static_load
from manipulator.errors import ConfigError, InvalidInput
from manipulator.static_deflection import commanded, deflected


def compensation_of(this, payload_g=None):
    load = static_load(this.kinematics, dynamics_of(this.file, payload_g))
    return Compensation(load, this.mechanism.drives)


def error_at_rest(this, pose, is_compensated, payload_g=None):
    simulation = this.simulation(pose, payload_g=payload_g)
    joints = this.kinematics.inverse(pose)
    offsets = compensation_of(this, payload_g)(pose, joints) if is_compensated else 0.0
    simulation.aim(joints + offsets)
    simulation.step(1500)
    return np.linalg.norm(simulation.pose.twist_to(pose)[:3])


@pytest.mark.parametrize('name', ['robocake', 'stewart_6_6', 'arm_6r', 'ur5'])
def test_at_rest_the_sag_is_gone(example, name):
    this = example(name)
    pose = this.kinematics.home.moved(np.array([3e-3, 2e-3, -2e-3, 0.03, 0.02, 0.02]))
    without = error_at_rest(this, pose, False)
    assert error_at_rest(this, pose, True) < 0.1 * without


def test_in_slow_motion_most_of_the_error_was_sag(capsys):
    words = ['simulate', 'robocake', '--frequency', '0.2', '--periods', '0.5', '--json']
    errors = []
    for flag in ('--no-compensate', '--compensate'):
        assert main([*words, flag]) == 0
        reported = json.loads(capsys.readouterr().out)
        assert reported['is_compensated'] == (flag == '--compensate')
        errors.append(reported['position_error'])
    assert errors[1] < 0.4 * errors[0]


def test_offsets_end_where_the_drives_do(example):
    this = example('robocake')
    home = this.kinematics.home
    offsets = compensation_of(this, 20_000.0)(home, this.kinematics.inverse(home))
    assert np.abs(offsets) == pytest.approx(this.mechanism.drives.band)


def loaded(tmp_path, **changes):
    text = machines.text_of(machines.find('robocake'))
    for old, new in changes.values():
        assert old in text
        text = text.replace(old, new)
    path = tmp_path / 'compensated.yaml'
    path.write_text(text)
    return machines.load(str(path))


ON = ('compensation: false', 'compensation: true')


def test_nodes_bring_the_platform_where_it_was_wanted(example, tmp_path):
    """The command of the ik node into MuJoCo, and the pose node's word on where that leads."""
    machine, this = loaded(tmp_path, on=ON), example('robocake')
    pose = machine.kinematics.home.moved(np.array([3e-3, 2e-3, -2e-3, 0.03, 0.02, 0.02]))
    command = commanded(machine.deflection, pose, machine.kinematics.inverse(pose))
    simulation = this.simulation(pose)
    simulation.aim(command)
    simulation.step(1500)
    real = simulation.pose
    raw = machine.kinematics.forward(command, pose)
    reported = deflected(machine.deflection, machine.kinematics, command, raw).pose
    assert np.abs(real.twist_to(pose)[:3]).max() < 1e-5
    assert np.abs(real.twist_to(reported)[:3]).max() < 1e-5
    assert np.abs(real.twist_to(raw.pose)[:3]).max() > 1e-4


def test_the_compensated_load_is_the_first_tools_and_another_is_refused(tmp_path):
    tools = """
tools:
  - {name: drill, xyz_mm: [0, 0, 20], mass_g: 80}
  - {name: bit, xyz_mm: [0, 0, 50], mass_g: 80, centre_mm: [0, 0, 10]}
  - {name: saw, xyz_mm: [0, 0, 20], mass_g: 120}
"""
    machine = loaded(tmp_path, on=ON, tools=('\ndynamics:', f'{tools}\ndynamics:'))
    home, joints = machine.kinematics.home, machine.kinematics.inverse(machine.kinematics.home)
    bare = loaded(tmp_path, on=ON)
    assert (machine.deflection(home, joints) / bare.deflection(home, joints) > 1.1).all()
    assert machine.frames.with_tool('bit').tool == 'bit'
    with pytest.raises(InvalidInput, match=r"'saw' has 120 g at .* is for 'drill', 80 g at"):
        machine.frames.with_tool('saw')


def test_taking_over_again_and_again_moves_nothing(tmp_path):
    machine = loaded(tmp_path, on=ON)
    kinematics = machine.kinematics
    first = command = kinematics.inverse(kinematics.home)
    for _ in range(50):
        raw = kinematics.forward(command, kinematics.home)
        pose = deflected(machine.deflection, kinematics, command, raw).pose
        command = commanded(machine.deflection, pose, kinematics.inverse(pose))
    assert np.abs(command - first).max() < np.radians(0.1)


def test_without_the_key_nothing_is_added(tmp_path):
    machine = loaded(tmp_path)
    joints = machine.kinematics.inverse(machine.kinematics.home)
    solution = machine.kinematics.forward(joints)
    assert machine.deflection is None
    assert commanded(None, machine.kinematics.home, joints) is joints
    assert deflected(None, machine.kinematics, joints, solution) is solution


def test_machines_with_encoders_are_refused(tmp_path):
    measured = ('  battery_v: 7.8', '  battery_v: 7.8\n  joints: measured')
    with pytest.raises(ConfigError, match='joints are measured'):
        loaded(tmp_path, on=ON, measured=measured)
