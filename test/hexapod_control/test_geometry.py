import dataclasses

import numpy as np
import pytest

from hexapod_control.geometry import HexagonConfig, JointsConfig
from hexapod_control.rotary import RotaryHexapod
from manipulator.config import build
from manipulator.errors import ConfigError


@pytest.fixture
def hexagon(robocake_content):
    return build(HexagonConfig, robocake_content['geometry'])


@pytest.fixture
def measured(hexagon):
    """The same machine, written down by coordinates."""
    g = hexagon.geometry()
    return {
        'crank_centres_mm': (g.crank_centres * 1e3).tolist(),
        'crank_tangents': (g.tangents * 3).tolist(),
        'platform_joints_mm': (g.platform_points * 1e3).tolist(),
        'crank_length_mm': 17.5,
        'rod_length_mm': [58.0] * 6,
        'home_height_mm': 41.19,
    }


def test_first_and_second_leg_stand_where_the_paper_puts_them(hexagon):
    g = hexagon.geometry()
    np.testing.assert_allclose(g.crank_centres[0], [0.096492, -0.00579, 0.0], atol=1e-12)
    np.testing.assert_allclose(g.platform_points[0], [0.069992, 0.030, 0.0], atol=1e-12)
    turned = [
        0.5 * 0.096492 - np.sqrt(0.75) * 0.00579,
        np.sqrt(0.75) * 0.096492 + 0.5 * 0.00579,
        0.0,
    ]
    np.testing.assert_allclose(g.crank_centres[1], turned, atol=1e-12)


def test_odd_and_even_legs_mirror_each_other(hexagon):
    g = hexagon.geometry()
    for points in (g.crank_centres, g.platform_points):
        # The mirror plane between legs 1 and 6 stands at −30°.
        angle = -np.pi / 3
        mirror = np.array([[np.cos(angle), np.sin(angle)], [np.sin(angle), -np.cos(angle)]])
        np.testing.assert_allclose(points[0, :2] @ mirror, points[5, :2], atol=1e-12)


def test_crank_planes_are_vertical_and_right_angled(hexagon):
    g = hexagon.geometry()
    frames = np.stack([g.tangents, g.ups, g.normals], axis=1)
    np.testing.assert_allclose(
        frames @ np.swapaxes(frames, 1, 2), np.broadcast_to(np.eye(3), (6, 3, 3)), atol=1e-12
    )
    np.testing.assert_allclose(g.ups, np.broadcast_to([0, 0, 1], (6, 3)), atol=1e-12)


def test_coordinates_describe_the_same_machine_as_the_parameters(hexagon, measured):
    a, b = hexagon.geometry(), build(JointsConfig, measured).geometry()
    for field in dataclasses.fields(a):
        np.testing.assert_allclose(getattr(a, field.name), getattr(b, field.name), atol=1e-12)


def test_a_tilted_crank_plane_contains_its_tangent_and_leans_up(measured):
    measured['crank_tangents'][0] = [0.0, 1.0, 0.5]
    g = build(JointsConfig, measured).geometry()
    assert g.ups[0] @ g.tangents[0] == pytest.approx(0.0, abs=1e-12)
    assert g.ups[0, 2] > 0.8


def test_axes_and_tangents_are_taken_as_they_are(measured):
    level = np.cross(measured['crank_tangents'], [0.0, 0.0, 1.0]).tolist()
    measured['crank_axes'] = [[2.0, 0.0, 1.0], [0.0, 0.0, -1.0], *level[2:]]
    measured['crank_tangents'][0] = [-1.0, 5.0, 2.0]
    g = build(JointsConfig, measured).geometry()
    np.testing.assert_allclose(g.normals[0], np.array([2.0, 0.0, 1.0]) / 5**0.5, atol=1e-12)
    np.testing.assert_allclose(g.tangents[0], np.array([-1.0, 5.0, 2.0]) / 30**0.5, atol=1e-12)
    np.testing.assert_allclose(g.ups, np.cross(g.normals, g.tangents), atol=1e-12)


@pytest.mark.parametrize(
    ('axis', 'words'),
    [
        ([0.1, -1.0, 0.0], r'leg 1: crank_axes\[0\] is at 17\d\.\d° to its crank_tang.*90° ± 1°'),
        ([0.0, 0.0, 0.0], r'leg 1: crank_axes\[0\] has no direction'),
    ],
)
def test_an_axis_that_makes_no_plane_is_named(measured, axis, words):
    measured['crank_tangents'][0] = [0.0, 1.0, 0.0]
    measured['crank_axes'] = [axis, *measured['crank_centres_mm'][1:]]
    with pytest.raises(ConfigError, match=words):
        build(JointsConfig, measured).geometry()


def test_an_axis_within_a_degree_of_square_moves_the_tangent_into_its_plane(measured):
    measured['crank_tangents'] = [[0.0, 1.0, 0.01]] * 6
    measured['crank_axes'] = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]] * 3
    g = build(JointsConfig, measured).geometry()
    np.testing.assert_allclose(g.tangents[1], [0.0, 1.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(g.normals[1], [0.0, 0.0, 1.0], atol=1e-12)


@pytest.mark.parametrize('tangent', [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
def test_a_tangent_that_spans_no_plane_names_its_leg(measured, tangent):
    measured['crank_tangents'][3] = tangent
    with pytest.raises(ConfigError, match='leg 4'):
        build(JointsConfig, measured).geometry()


def test_lengths_are_one_number_or_six(robocake_content):
    robocake_content['geometry']['rod_length_mm'] = [58.0, 58.1, 58.2, 58.3, 58.4, 58.5]
    g = build(HexagonConfig, robocake_content['geometry']).geometry()
    np.testing.assert_allclose(g.rod_lengths, np.linspace(0.058, 0.0585, 6), atol=1e-12)
    robocake_content['geometry']['rod_length_mm'] = [58.0] * 5
    with pytest.raises(ConfigError, match='5 entries, needs 6'):
        build(HexagonConfig, robocake_content['geometry'])


def test_a_hexagon_that_hangs_is_upside_down_with_the_same_crank_angles(robocake_content):
    upside_down = np.diag([1.0, 1.0, -1.0])
    above = build(HexagonConfig, robocake_content['geometry']).geometry()
    below = build(
        HexagonConfig, {**robocake_content['geometry'], 'home_height_mm': -41.19}
    ).geometry()
    for name in ('crank_centres', 'tangents', 'ups', 'platform_points'):
        np.testing.assert_allclose(getattr(below, name), getattr(above, name) @ upside_down)
    machine = RotaryHexapod(below, 0.07, 0.3, np.radians(120.0))
    np.testing.assert_allclose(np.degrees(machine.inverse(machine.home)), 120.0045, atol=5e-5)
