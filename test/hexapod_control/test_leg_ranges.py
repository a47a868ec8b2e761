"""Ranges, speeds and accelerations of each leg's own."""

import numpy as np
import pytest

from hexapod_control.load import hexapod
from hexarm.machines import content_of, find
from manipulator.config import build
from manipulator.errors import ConfigError, LimitViolated
from manipulator.machine import MachineFile

WIDE, NARROW = [100.0, 250.0], [100.0, 228.0]
"""Of Reachy Mini's motors: 80 degrees one way, 70 or 48 the other, from 180 degrees."""


def load(content):
    return hexapod(build(MachineFile, content))


@pytest.fixture
def reachy_mini():
    return content_of(find('reachy_mini'))


def test_each_crank_keeps_its_own_range(reachy_mini):
    machine = load(reachy_mini)
    ends = np.array([WIDE if leg in (2, 5) else NARROW for leg in range(1, 7)])
    for leg in range(6):
        most = np.radians(ends[leg, 1])
        for degrees, is_inside in ((ends[leg, 1] - 0.1, True), (ends[leg, 1] + 0.1, False)):
            joints = np.radians(np.full(6, 180.0))
            joints[leg] = np.radians(degrees)
            pose = machine.kinematics.forward(joints, machine.kinematics.home).pose
            beyond = machine.constraints.violations(pose, joints)
            assert ('crank angle' in [v.quantity for v in beyond]) is not is_inside
            if not is_inside:
                text = rf'leg {leg + 1}: crank angle .* outside \[1\.745, {most:.4g}'
                with pytest.raises(LimitViolated, match=text):
                    machine.constraints.check(pose, joints)


def test_each_crank_angle_is_within_half_a_turn_of_its_own_range(robocake_content):
    """Ranges that together are wider than a turn, as of servos that are mounted mirrored."""
    one = load(robocake_content)
    turns = np.array([0.0, 1.0, 0.0, -1.0, 0.0, 1.0])
    ranges = [[30.0 + 360.0 * turn, 210.0 + 360.0 * turn] for turn in turns]
    robocake_content['limits']['crank_range_deg'] = ranges
    other = load(robocake_content)
    pose = one.kinematics.home.moved(np.array([0.002, -0.001, 0.002, 0.02, 0.01, -0.05]))
    joints = other.kinematics.inverse(pose)
    np.testing.assert_allclose(joints, one.kinematics.inverse(pose) + 2 * np.pi * turns)
    assert other.constraints.admits(pose, joints)


def test_each_leg_has_its_own_stroke(stewart_content):
    content = stewart_content('stewart_6_6')
    strokes = [[142.0 + leg, 238.0 - leg] for leg in range(6)]
    content['limits']['stroke_range_mm'] = strokes
    low, high = load(content).joint_ranges
    np.testing.assert_allclose(1e3 * np.stack([low, high], axis=1), strokes)


def test_each_joint_may_have_its_own_speed_and_acceleration(robocake_content):
    robocake_content['motion']['joint_speed_deg_s'] = [480.0, 90.0, 480.0, 480.0, 480.0, 480.0]
    robocake_content['motion']['joint_acceleration_deg_s2'] = [*[9000.0] * 5, 700.0]
    joint = load(robocake_content).motion.joint
    np.testing.assert_allclose(np.degrees(joint.speed), [480, 90, 480, 480, 480, 480])
    np.testing.assert_allclose(np.degrees(joint.acceleration), [9000] * 5 + [700])


def test_ranges_that_are_none_are_all_named(robocake_content):
    ranges = [NARROW, [210.0, 30.0], NARROW, NARROW, [0.0, 400.0], NARROW]
    robocake_content['limits']['crank_range_deg'] = ranges
    with pytest.raises(ConfigError) as caught:
        load(robocake_content)
    assert list(caught.value.problems) == [
        'limits: crank_range_deg[1]: [210, 30] is no range within a turn',
        'limits: crank_range_deg[4]: [0, 400] is no range within a turn',
    ]


@pytest.mark.parametrize('ranges', [[NARROW] * 5, [100.0] * 6])
def test_another_number_of_ranges_is_refused(robocake_content, ranges):
    robocake_content['limits']['crank_range_deg'] = ranges
    with pytest.raises(ConfigError, match=r'limits\.crank_range_deg'):
        load(robocake_content)


def test_cranks_that_are_bent_the_other_way_are_told_each_range_to_write(reachy_mini):
    geometry, limits = reachy_mini['geometry'], reachy_mini['limits']
    ranges = limits['crank_range_deg']
    mirrored = {'crank_tangents': [[-c for c in t] for t in geometry['crank_tangents']]}
    turned = {'crank_range_deg': [[180.0 - high, 180.0 - low] for low, high in ranges]}
    there = {'geometry': geometry | mirrored, 'limits': limits | turned}
    with pytest.raises(ConfigError) as caught:
        load(reachy_mini | there)
    written = ', '.join(f'[{low:g}, {high:g}]' for low, high in ranges)
    assert f'crank_range_deg: [{written}], centre_deg' in caught.value.problems[0]
