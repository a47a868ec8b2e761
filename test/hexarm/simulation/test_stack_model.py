"""The MuJoCo model of a stack: its loops close, and the end is where the kinematics have it."""

import numpy as np
import pytest

from hexarm import machines
from hexarm.machine_check import report_of
from hexarm.simulation.model import mechanism
from hexarm.simulation.simulation import Simulation
from manipulator.config import build
from manipulator.errors import ConfigError
from manipulator.machine import MachineFile

TWIST = (0.02, -0.01, 0.03, 0.1, -0.1, 0.2)


def content(name, tool):
    """Two sections of a shipped machine, with its motion and a tool on the upper one."""
    path = machines.find('stack_6_6')
    below = {'machine': name, 'next': {'xyz_mm': [0.0, 0.0, 10.0], 'rpy_deg': [0.0, 0.0, 20.0]}}
    raw = machines.content_of(path)
    raw['motion'] = machines.content_of(machines.find(name))['motion']
    raw['geometry'] = {'sections': [below, {'machine': name, 'next': tool}]}
    return machines.with_sections(raw, path.parent)


def simulated(raw):
    raw['servos'] = {'speed_mm_s': 25.0, 'speed_deg_s': 600.0}
    machine_file = build(MachineFile, raw)
    machine = machines.loader('stack')(machine_file)
    home = machine.kinematics.home
    model = mechanism('two', machine_file, machine.kinematics)
    return machine.kinematics, Simulation(model, home, machine.kinematics.inverse(home))


@pytest.mark.parametrize(('name', 'part'), [('stewart_6_3', 1.0), ('robocake', 0.2)])
def test_all_loops_close_and_the_end_is_where_the_kinematics_have_it(name, part):
    kinematics, simulation = simulated(content(name, {'xyz_mm': [5.0, 0.0, 20.0]}))
    assert (simulation.model.nv, simulation.model.neq, simulation.model.nu) == (48, 12, 12)
    pose = kinematics.home.moved(part * np.array(TWIST))
    joints = kinematics.inverse(pose)
    simulation.reset(pose, joints)  # raises where a loop is open
    np.testing.assert_allclose(simulation.joints, joints, atol=1e-12)
    np.testing.assert_allclose(simulation.pose.twist_to(pose), np.zeros(6), atol=1e-9)


def test_the_drives_hold_a_stack_up():
    kinematics, simulation = simulated(content('stewart_6_6', {}))
    simulation.step(200)
    simulation.check_closed()
    assert np.abs(kinematics.home.twist_to(simulation.pose)).max() < 3e-3


def test_a_section_without_masses_is_named():
    raw = content('stewart_6_6', {})
    del raw['geometry']['sections'][1]['dynamics']
    with pytest.raises(ConfigError, match=r'geometry.sections\[1\].dynamics: missing'):
        simulated(raw)


def test_masses_are_checked_with_their_section():
    raw = content('stewart_6_6', {})
    raw['dynamics'] = {'drive': {}}
    raw['geometry']['sections'][0]['dynamics'] = {'mass': 1.0}
    problems = report_of(raw).problems
    assert 'dynamics.drive: unknown key' in problems
    assert any(p.startswith('geometry.sections[0].dynamics.mass: unknown key') for p in problems)
