import numpy as np
import pytest

from hexarm.machines import load

MACHINES = ('robocake', 'stewart_6_6', 'arm_6r', 'ur5')


def strokes(machine, part):
    kinematics = machine.kinematics
    found = kinematics.skeleton(kinematics.home, kinematics.inverse(kinematics.home))
    return [stroke.points for stroke in found if stroke.part == part]


def test_cranks_and_rods_have_their_lengths_and_meet():
    machine = load('robocake')
    cranks, rods = strokes(machine, 'crank'), strokes(machine, 'rod')
    for crank, rod in zip(cranks, rods, strict=True):
        assert np.linalg.norm(crank[1] - crank[0]) == pytest.approx(0.0175)
        assert np.linalg.norm(rod[1] - rod[0]) == pytest.approx(0.058)
        np.testing.assert_array_equal(crank[1], rod[0])


def test_linear_legs_are_as_long_as_their_joints():
    machine = load('stewart_6_6')
    lengths = [np.linalg.norm(leg[1] - leg[0]) for leg in strokes(machine, 'rod')]
    np.testing.assert_allclose(lengths, machine.kinematics.inverse(machine.kinematics.home))


@pytest.mark.parametrize('name', ['arm_6r', 'ur5'])
def test_arm_ends_at_the_tool_point(name):
    machine = load(name)
    (line,) = strokes(machine, 'link')
    np.testing.assert_allclose(line[-1], machine.kinematics.home.position, atol=1e-12)


def test_links_of_the_papers_arm_have_its_lengths():
    (line,) = strokes(load('arm_6r'), 'link')
    lengths = np.linalg.norm(np.diff(line, axis=0), axis=1)
    for expected in (0.3, 0.4, 0.4, 0.12):
        assert np.abs(lengths - expected).min() < 1e-12


@pytest.mark.parametrize('name', MACHINES)
def test_outlines_are_closed(name):
    machine = load(name)
    for part in ('body', 'platform'):
        for points in strokes(machine, part):
            np.testing.assert_array_equal(points[0], points[-1])
