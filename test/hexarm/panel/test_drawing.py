"""Bars, meshes and margins: what the page draws, without a page."""

from unittest.mock import MagicMock

import numpy as np
import pytest

from hexarm.machines import load
from hexarm.panel.pieces import bar, bars_between, hull, pieces, plate, sphere
from hexarm.panel.room import GOOD, NARROW, NONE_LEFT, colour, shares
from hexarm.panel.scene import Scene
from manipulator.limits.surroundings import BodiesConfig, BoxConfig, SurroundingsConfig
from manipulator.rotation import from_quaternion


def volume(mesh):
    """Enclosed by outward faces; wrong where one is missing or inside out."""
    vertices, faces = mesh
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return float(np.einsum('ni,ni->', a, np.cross(b, c)) / 6)


def test_solids_are_closed_and_face_outwards():
    n = 20
    disc = n / 2 * np.sin(2 * np.pi / n)
    assert volume(bar()) == pytest.approx(disc)
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
    assert volume(plate(square, 0.5)) == pytest.approx(0.5)
    assert volume(hull(sphere(41, 80))) == pytest.approx(4 / 3 * np.pi, rel=0.01)


def test_a_bar_reaches_from_its_start_to_its_end():
    starts = np.array([[0.0, 0, 0], [1, 2, 3], [0, 0, 1], [0, 0, 0]])
    ends = np.array([[0.3, -0.2, 0.5], [1, 2, 5], [0, 0, -1], [0, 0, 0]])
    found = bars_between(starts, ends, np.full(4, 0.1))
    for start, end, wxyz, size in zip(starts, ends, found.wxyz, found.sizes, strict=True):
        turn = from_quaternion(np.roll(wxyz, -1))
        np.testing.assert_allclose(start + turn @ [0, 0, size[2]], end, atol=1e-8)


@pytest.mark.parametrize(
    ('name', 'count'),
    [('robocake', 6), ('stewart_6_6', 6), ('stack_6_6', 18), ('arm_6r', 6), ('puma560', 6)],
)
def test_every_leg_or_joint_shows_its_margin(name, count):
    machine = load(name)
    home = machine.kinematics.home
    joints = machine.kinematics.inverse(home)
    found = pieces(machine.kinematics.skeleton(home, joints))
    owners = {o for o in (*found.owners, *found.ball_owners) if o}
    assert len(owners) == count
    assert owners <= set(shares(machine, home, joints))


def test_margins_shrink_towards_a_limit():
    machine = load('robocake')
    home = machine.kinematics.home
    low = home.moved([0.0, 0.0, -0.0177, 0.0, 0.0, 0.0])
    left = [shares(machine, pose, machine.kinematics.inverse(pose)) for pose in (home, low)]
    assert left[0][''] > 0.5
    assert 0.0 < left[1][''] < 0.01
    assert all(share > 0.0 for share in left[0].values())


def test_colours_go_from_red_over_amber_to_green():
    assert colour(-1.0) == colour(0.0) == NONE_LEFT
    assert colour(0.175) == NARROW
    assert colour(1.0) == GOOD


def test_the_page_draws_the_surroundings_where_they_are():
    walls = SurroundingsConfig(
        floor_mm=-50.0,
        boxes=(BoxConfig('table', centre_mm=(0.0, 0.0, 900.0), size_mm=(400.0, 300.0, 20.0)),),
        workspace_mm=((-2000.0, -2000.0, -60.0), (2000.0, 2000.0, 2000.0)),
    )
    machine = load('arm_6r').among(walls, BodiesConfig())
    server = MagicMock()
    Scene(server, machine, has_gripper=False)
    kinematics = machine.kinematics
    strokes = kinematics.skeleton(kinematics.home, kinematics.inverse(kinematics.home))
    size = float(np.ptp(strokes[0].points, axis=0).max())
    (table, workspace) = server.scene.add_box.call_args_list
    np.testing.assert_allclose(np.array(table.args[2]) * size, [0.4, 0.3, 0.02])
    np.testing.assert_allclose(table.kwargs['position'] * size, [0.0, 0.0, 0.9])
    assert workspace.kwargs['wireframe']
    assert not table.kwargs['wireframe']
    grid = server.scene.add_grid.call_args.kwargs
    assert grid['position'][2] * size == pytest.approx(-0.05)
