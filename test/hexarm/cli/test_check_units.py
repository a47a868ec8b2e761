"""`hexarm check`: values that are probably in another unit."""

import re
from dataclasses import replace
from unittest.mock import ANY

import numpy as np
import pytest
from machine_texts import ARM, BY_COORDINATES, CONFIG, REAL, ROBOCAKE, STEWART, UR5, changed

from hexarm.machine_check import problems_of, report_of
from manipulator.config import parse_yaml


@pytest.mark.parametrize(
    ('text', 'key', 'value'),
    [
        (ROBOCAKE, 'body_radius_mm: 71.492', 0.071492),
        (ROBOCAKE, 'rod_length_mm: 58.0', 0.058),
        (ROBOCAKE, 'rod_length_mm: 58.0', 58000.0),
        (ROBOCAKE, 'home_height_mm: 41.19', 41190.0),
        (BY_COORDINATES, 'home_height_mm: 177.0', 0.177),
        (ROBOCAKE, 'characteristic_length_mm: 70.0', 0.07),
        (STEWART, 'base_radius_mm: 100.0', 0.1),
        (STEWART, 'stroke_range_mm: [142.0, 238.0]', [0.142, 0.238]),
        (ARM, 'L3_mm: 400.0', 0.4),
    ],
)
def test_a_length_that_contradicts_the_machines_size_is_asked_about_its_unit(text, key, value):
    name = key.split(':')[0]
    (found,) = problems_of(changed(text, (key, f'{name}: {value}')))
    assert re.match(rf'(geometry|limits)\.{name}: \S+ in a machine of about [\d.]+ mm', found)
    assert found.endswith(': is it in another unit?')


@pytest.mark.parametrize('name', ['robocake', 'stewart_6_6'])
def test_a_whole_machine_in_metres_is_asked_about_its_unit(name):
    content = parse_yaml((CONFIG / f'{name}.yaml').read_text())
    for section in ('geometry', 'limits'):
        for key, value in content[section].items():
            if key.endswith('_mm'):
                content[section][key] = (1e-3 * np.array(value)).tolist()
    (found,) = report_of(content).problems
    assert re.match(r'geometry: its lengths are about 0\.\d+ mm: is it in another unit\?', found)


@pytest.mark.parametrize(
    ('key', 'value'),
    [
        ('linear_speed_mm_s: 50.0', 0.05),
        ('linear_acceleration_mm_s2: 2942.0', 2.942),
        ('angular_speed_deg_s: 60.0', 60000.0),
    ],
)
def test_speeds_that_contradict_each_other_are_a_warning(key, value):
    report = report_of(parse_yaml(changed(ROBOCAKE, (key, f'{key.split(":")[0]}: {value}'))))
    (warning,) = report.warnings
    assert warning.startswith(f'motion: linear {key.split("_")[1]} ')
    assert warning.endswith('is one of them in another unit?')


@pytest.mark.parametrize('file', sorted(REAL.glob('*.yaml')), ids=lambda file: file.stem)
def test_large_slow_heavy_and_hanging_machines_are_asked_nothing(file):
    report = report_of(parse_yaml(file.read_text()))
    assert (report.problems, report.warnings) == ((), ())


@pytest.mark.parametrize('value', [1.5708, -1.57, 3.14, 6.283])
def test_an_angle_that_is_a_right_one_in_radians_is_a_warning(value):
    text = changed(UR5, ('a_mm: -425.0, alpha_deg: 0.0', f'a_mm: -425.0, alpha_deg: {value}'))
    (doubt,) = report_of(parse_yaml(text)).warnings
    assert doubt.startswith(f'geometry.dh.alpha_deg: {value}° would be ')
    assert doubt.endswith('in radians: is it in another unit?')


def test_an_arm_whose_joints_hardly_turn_is_asked_whether_in_radians():
    content = parse_yaml(UR5)
    content['geometry']['home_deg'] = [0.5, -1.2, 1.2, -1.2, -1.4, 0.0]
    for joint in content['limits']['joints']:
        joint['range_deg'] = [-2.8, 2.8]
    report = report_of(content)
    assert 'limits: no joint goes beyond 2.8°: are the ranges in radians?' in report.warnings


@pytest.mark.parametrize(('text', 'scale'), [(ROBOCAKE, 10.5), (UR5, 2.7), (ARM, 8.0)])
def test_half_a_pulse_scale_is_a_warning_and_none_of_the_file_itself(text, scale):
    assert report_of(parse_yaml(text)).warnings == ()
    halved = changed(text, (f'us_per_deg: {scale}', f'us_per_deg: {scale / 2}'))
    report = report_of(parse_yaml(halved))
    (warning,) = report.warnings
    assert f'{scale / 2:.3g} µs/deg' in warning


def test_pulses_beyond_what_servos_take_are_a_warning():
    wide = changed(
        ROBOCAKE,
        ('us_per_deg: 10.5', 'us_per_deg: 15.0'),
        ('[550.0, 2450.0]', '[100.0, 2900.0]'),
    )
    report = report_of(parse_yaml(wide))
    (warning,) = report.warnings
    assert '150 to 2850 µs' in warning


def test_counts_of_other_drives_than_servos_are_not_judged():
    text = (CONFIG / 'arm_6r_stepper.yaml').read_text()
    halved = changed(text, ('us_per_deg: 60.0', 'us_per_deg: 30.0'))
    assert report_of(parse_yaml(halved)) == replace(report_of(parse_yaml(text)), machine=ANY)


def test_keys_of_joints_in_the_other_unit_are_named():
    """Read as metres, 10° a second would be 0.17 m/s."""
    mixed = changed(
        STEWART,
        ('  joint_speed_mm_s:', '  joint_speed_deg_s: 10.0\n  joint_speed_mm_s:'),
        ('  park_mm:', '  speed_deg_s: 60.0\n  park_mm:'),
    )
    assert sorted(problems_of(mixed)) == [
        'motion.joint_speed_deg_s: the joints are in mm, needs joint_speed_mm_s',
        'servos: speed_deg_s: the joints are in mm',
    ]
