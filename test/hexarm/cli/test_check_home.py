"""`hexarm check` on home: beyond limits, on another bend, with horns entered the other way."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from machine_texts import BY_COORDINATES, ROBOCAKE, STEWART, changed

from hexapod_control.geometry import HexagonConfig
from hexarm.machine_check import problems_of, report_of
from hexarm.machines import content_of, find
from leg_kinds import TILTED_CRANKS
from manipulator.config import build, parse_yaml


def test_home_beyond_a_limit_is_found_beside_a_faulty_section():
    found = problems_of(
        changed(ROBOCAKE, ('[30.0, 210.0]', '[130.0, 210.0]'), ('baud: 250000', 'baud: fast'))
    )
    assert 'limits: home has crank angle 120° on all legs, outside [130, 210]°' in found
    assert "link.baud: holds the text 'fast', needs a whole number" in found


def hobby_platform(is_hanging):
    """By docs/machine-files.md: horns that point along a hexagon's sides, level at home."""
    content = parse_yaml(BY_COORDINATES)
    at, joint = (np.radians(a) for a in ([40.0, 80.0, 160.0, 200.0, 280.0, 320.0],
                                         [10.0, 110.0, 130.0, 230.0, 250.0, 350.0]))  # fmt: skip
    along = at + np.radians([90.0, -90.0] * 3)  # β, where each leg's horn points
    axes, ends = (radius * np.stack([np.cos(a), np.sin(a), 0 * a], 1)
                  for radius, a in ((80.0, at), (50.0, joint)))  # fmt: skip
    horns = np.stack([np.cos(along), np.sin(along), 0 * along], 1)
    across = np.linalg.norm(axes + 20.0 * horns - ends, axis=1)
    height = float(np.sqrt(140.0**2 - across[0] ** 2))
    content['geometry'] = {
        'crank_centres_mm': axes.tolist(),
        'crank_tangents': (horns if is_hanging else -horns).tolist(),
        'platform_joints_mm': ends.tolist(),
        'crank_length_mm': 20.0,
        'rod_length_mm': 140.0,
        'home_height_mm': -height if is_hanging else height,
    }
    level = 0.0 if is_hanging else 180.0
    content['limits'] |= {
        'crank_range_deg': [level - 80.0, level + 80.0],
        'minimum_height_mm': -1000.0,
        'characteristic_length_mm': 50.0,
    }
    content['servos']['park_deg'] = [level] * 6
    for servo in content['servos']['joints']:
        servo['centre_deg'] = level
    return content, axes + 20.0 * horns


@pytest.mark.parametrize('is_hanging', [False, True])
def test_a_hobby_platform_by_the_page_has_its_horns_where_they_are(is_hanging):
    content, tips = hobby_platform(is_hanging)
    report = report_of(content)
    assert (report.problems, report.warnings) == ((), ())
    kinematics = report.machine.kinematics
    found = kinematics.crank_tips(kinematics.inverse(kinematics.home))
    np.testing.assert_allclose(1e3 * found, tips, atol=1e-6)


def with_level_cranks(is_mirrored):
    """RoboCake with longer cranks whose angles at home are 0 and about 110°, either the wrong one.

    The rods are as long as it takes from the tips of level cranks.
    """
    config = build(HexagonConfig, parse_yaml(ROBOCAKE)['geometry'])
    joints = replace(config, home_height_mm=51.0, crank_length_mm=30.0).geometry()
    tips = joints.crank_centres + joints.crank_lengths[:, None] * joints.tangents
    rod = np.linalg.norm(joints.platform_points[0] + [0.0, 0.0, 0.051] - tips[0])
    middle = 45.0 if is_mirrored else 120.0
    return changed(
        ROBOCAKE,
        ('crank_length_mm: 17.5', 'crank_length_mm: 30.0'),
        ('home_height_mm: 41.19', 'home_height_mm: 51.0'),
        ('rod_length_mm: 58.0', f'rod_length_mm: {1e3 * rod:.6f}'),
        ('[30.0, 210.0]', f'[{middle - 90.0}, {middle + 90.0}]'),
        ('centre_deg: 120.0', f'centre_deg: {middle}'),
        ('minimum_height_mm: 23.39', 'minimum_height_mm: 20.0'),
        ('park_deg: [120.0, 120.0, 120.0, 120.0, 120.0, 120.0]', f'park_deg: {[110.0] * 6}'),
    )


def test_home_on_the_wrong_bend_is_a_warning_with_both_values():
    report = report_of(parse_yaml(with_level_cranks(is_mirrored=True)))
    (warning,) = report.warnings
    assert 'crank_1, crank_2, crank_3, crank_4, crank_5, crank_6 at 109.9°' in warning
    assert 'on the other branch: 0.0°, 0.0°' in warning


def test_tangents_that_rise_without_axes_are_a_warning_that_says_which_plane_was_taken():
    text = Path(TILTED_CRANKS).read_text()
    assert report_of(parse_yaml(text)).warnings == ()
    content = parse_yaml(text)
    del content['geometry']['crank_axes']
    (warning,) = report_of(content).warnings
    assert warning.startswith('geometry.crank_tangents: crank_1, crank_2')
    assert '14.1°' in warning
    assert 'vertical plane' in warning


def test_tilted_home_in_the_middle_of_its_range_is_no_warning():
    report = report_of(parse_yaml(with_level_cranks(is_mirrored=False)))
    assert (report.problems, report.warnings) == ((), ())


def bent_the_other_way(content, legs=range(6)):
    """The same machine with its tangents along the horns, as they are published; undoes itself."""
    ranges, park = content['limits']['crank_range_deg'], content['servos']['park_deg']
    tangents, joints = content['geometry']['crank_tangents'], content['servos']['joints']
    for leg in legs:
        low, high = ranges[leg]
        ranges[leg], park[leg] = [180.0 - high, 180.0 - low], 180.0 - park[leg]
        tangents[leg] = [-c for c in tangents[leg]]
        joint = joints[leg]
        joint['centre_deg'], joint['sign'] = 180.0 - joint['centre_deg'], -joint['sign']
    return content


def test_horns_as_hobbyists_enter_them_are_told_what_to_write():
    naive = bent_the_other_way(parse_yaml(BY_COORDINATES))
    (problem,) = report_of(naive).problems
    assert problem.startswith('limits: home has crank angle ')
    assert 'on legs 1, 3, 4, 6, outside [-48, 80]°; bent the other way it is 31.34°, ' in problem
    assert 'on all legs: negate their crank_tangents' in problem
    assert 'crank_range_deg: [[100, 228], [100, 250], ' in problem
    assert ', centre_deg and park_deg of these legs 180 minus' in problem
    assert report_of(bent_the_other_way(naive)).problems == ()


def test_parts_that_meet_the_same_thing_at_home_are_one_line():
    floor = changed(STEWART, ('servos:\n', 'surroundings: {floor_mm: 150}\nservos:\n'))
    assert problems_of(floor) == ['home: rods 1, 2, 3, 4, 5, 6 meet the floor by 145 mm']


def test_some_horns_entered_the_other_way_are_named():
    naive = bent_the_other_way(parse_yaml(BY_COORDINATES), (1, 4))
    (problem,) = report_of(naive).problems
    assert 'outside [-70, 80]°; bent the other way it is 39.6° on legs 2, 5: negate' in problem
    assert 'crank_range_deg: [[100, 228], [100, 250], [100, 228], ' in problem
    assert report_of(bent_the_other_way(naive, (1, 4))).problems == ()


def test_ranges_of_each_leg_are_turned_each():
    naive = bent_the_other_way(parse_yaml(BY_COORDINATES))
    naive['limits']['crank_range_deg'] = [[-80.0, 80.0]] * 5 + [[-80.0, 70.0]]
    (problem,) = report_of(naive).problems
    assert f'crank_range_deg: [{"[100, 260], " * 5}[110, 260]], ' in problem


def test_faults_of_servos_and_a_home_beyond_limits_come_together():
    found = problems_of(
        changed(ROBOCAKE, ('[30.0, 210.0]', '[130.0, 210.0]'), ('crank_3, ch', 'crank3, ch'))
    )
    assert found == [
        'limits: home has crank angle 120° on all legs, outside [130, 210]°',
        "servos.joints: none is called 'crank_3', but 'crank3'",
    ]


def test_an_arm_whose_home_is_singular_is_asked_about_it():
    content = content_of(find('arm_6r'))
    assert report_of(content).warnings == ()
    content['geometry']['home_deg'][4] = 0.0
    content['servos']['park_deg'] = content['geometry']['home_deg']
    (warning,) = report_of(content).warnings
    assert warning.startswith('geometry: home is a singular posture (singularity margin 0.000)')
