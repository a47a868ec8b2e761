"""Masses and drives that cannot be are refused, each by name."""

import pytest

from hexarm import machines
from hexarm.machine_check import problems_of
from hexarm.simulation.dynamics_config import PlateConfig
from hexarm.simulation.model import drives_of, dynamics_of
from manipulator.errors import ConfigError


def changed(old, new):
    text = machines.text_of(machines.find('robocake'))
    assert old in text
    return problems_of(text.replace(old, new))


@pytest.mark.parametrize(
    ('old', 'new', 'reported'),
    [
        ('{mass_g: 100.0, th', '{mass_g: -100.0, th', 'dynamics.platform.mass_g: -100 outside'),
        ('{mass_g: 4.0', '{mass_g: 0.0', 'dynamics.rod.mass_g: 0 outside'),
        ('{mass_g: 1.0', '{mass_g: .nan', 'dynamics.crank.mass_g: nan is not finite'),
        ('{mass_g: 1.0', '{mass_kg: 1.0', "mass_kg: unknown key, did you mean 'mass_g'"),
        ('torque_n_m: 0.1765', 'torque_n_m: 0.0', 'dynamics.drive.torque_n_m: 0 outside'),
        (', source: estimate}\n  rod', '}\n  rod', 'dynamics.crank.source: missing'),
        (
            'thickness_mm: 4.0',
            'thickness_mm: 4.0, inertia_g_mm2: [1.0e+5, 1.0e+5, 3.0e+5]',
            'dynamics.platform: inertia_g_mm2: 300000 is more than 100000 + 100000',
        ),
        (
            'thickness_mm: 4.0',
            'thickness_mm: 4.0, inertia_g_mm2: [1.0e+12, 1.0e+12, 1.0e+12]',
            'radius of gyration of 1e+05 mm',
        ),
    ],
)
def test_check_names_what_is_impossible(old, new, reported):
    assert [p for p in changed(old, new) if reported in p]


def test_moments_at_the_edge_of_the_triangle_inequality_are_good():
    PlateConfig('estimate', 100.0, 4.0, inertia_g_mm2=(1e5, 1e5, 2e5))
    with pytest.raises(ConfigError):
        PlateConfig('estimate', 100.0, 4.0, inertia_g_mm2=(1e5, 1e5, 2.0001e5))


def test_a_machine_without_masses_reports_that():
    with pytest.raises(ConfigError, match='dynamics: missing'):
        dynamics_of(machines.read('puma560'))


def test_a_drive_stalls_at_full_error_and_runs_free_at_full_speed():
    this = machines.read('robocake')
    drives = drives_of(dynamics_of(this), this)
    assert drives.stiffness * drives.band == pytest.approx(drives.effort)
    assert drives.damping * drives.speed == pytest.approx(drives.effort)
    assert drives.effort / 0.0980665 == pytest.approx([1.8] * 6, rel=1e-3)
