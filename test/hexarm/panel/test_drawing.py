"""Bars, meshes and margins: what the page draws, without a page."""

from pathlib import Path
from types import SimpleNamespace
from unittest.mock import MagicMock

import numpy as np
import pytest

from hexarm.link_meshes import LinkMesh
from hexarm.machines import load
from hexarm.panel.body import Body
from hexarm.panel.nearness import BOX_COLOUR, Nearness
from hexarm.panel.pieces import bar, bars_between, hull, pieces, plate, sphere
from hexarm.panel.room import GOOD, NARROW, NONE_LEFT, colour, shares
from hexarm.panel.scene import Scene
from hexarm.panel.view import Stance
from manipulator.limits.clearance import Clearance
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


class PaperScene:
    """Keeps what is added, by name, as viser's handles have it."""

    def __init__(self):
        self.handles = {}

    def add_mesh_simple(self, name, vertices, faces, color, **_):
        self.handles[name] = SimpleNamespace(vertices=vertices, faces=faces, color=color)
        return self.handles[name]

    def add_batched_meshes_simple(self, name, *_, batched_scales, batched_colors, **__):
        handle = SimpleNamespace(batched_scales=batched_scales, batched_colors=batched_colors)
        self.handles[name] = handle
        return handle


def test_links_with_meshes_are_drawn_by_them_and_the_others_by_rods():
    machine, scene, size = load('puma560'), PaperScene(), 0.5
    chain, corners = machine.kinematics.chain, np.random.default_rng(4).normal(size=(5, 3, 3))
    mesh = LinkMesh(Path('a.stl'), corners.astype(np.float32))
    body = Body(
        scene, 'm', machine.kinematics, size, meshes=[mesh, None, None, mesh, None, None, mesh]
    )
    joints = np.array([0.3, -0.5, 0.7, 1.1, -0.2, 0.4])
    body.show(Stance(chain.forward(joints), joints), {'joint 3': 0.0, 'joint 1': 0.0})
    assert {name for name in scene.handles if 'mesh' in name} == {f'm/mesh_{i}' for i in (0, 3, 6)}
    for i, moved in ((0, np.eye(4)), (3, chain.displacements(joints)[3])):
        solid = scene.handles[f'm/mesh_{i}']
        turn = from_quaternion(np.roll(solid.wxyz, -1))
        here = solid.vertices[solid.faces] @ turn.T + solid.position
        expected = size * (corners @ moved[:3, :3].T + moved[:3, 3])
        np.testing.assert_allclose(here, expected, atol=1e-6)
    red, green, _ = scene.handles['m/mesh_3'].color
    assert red > 1.5 * green  # at its limit
    base = scene.handles['m/mesh_0'].color
    assert max(base) - min(base) < 20
    balls = scene.handles['m/balls'].batched_colors
    assert tuple(balls[1]) == NONE_LEFT
    assert tuple(balls[2]) == GOOD
    drawn = scene.handles['m/bars'].batched_scales.any(axis=1)
    assert drawn.tolist() == [False, True, True, False, True, True, False]
    assert (scene.handles['m/balls'].batched_scales > 0).tolist() == [*drawn, False]


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


def test_parts_and_boxes_that_are_near_to_meet_are_marked():
    plain = load('robocake')
    kinematics, home = plain.kinematics, plain.kinematics.home
    low = 1e3 * home.position[2] + 12.0
    walls = SurroundingsConfig(
        boxes=(
            BoxConfig('lamp', corners_mm=((20.0, -500.0, low), (500.0, 500.0, low + 50.0))),
            BoxConfig('roof', corners_mm=((-500.0, -500.0, 900.0), (500.0, 500.0, 950.0))),
        )
    )
    machine = plain.among(walls, BodiesConfig(rod_diameter_mm=3.0))
    limit = next(one for one in machine.constraints.limits if isinstance(one, Clearance))
    scene, boxes = PaperScene(), {i: SimpleNamespace(color=BOX_COLOUR) for i in range(2)}
    near = Nearness(scene, machine, 5.0, boxes)
    at_home = limit.values(home, kinematics.inverse(home))
    for rise in (0.0, 0.01, 0.0):
        pose = home.moved([0.0, 0.0, rise, 0.0, 0.0, 0.0])
        joints = kinematics.inverse(pose)
        near.show(Stance(pose, joints), np.zeros(3))
        is_near = limit.values(pose, joints) < 0.35 * np.minimum(at_home, 0.03)
        sentences = ' '.join(np.array(limit.owners)[is_near])
        sizes = scene.handles['/near'].batched_scales
        marked = {n for n, size in zip(limit.names, sizes, strict=True) if size.any()}
        assert marked == {name for name in limit.names if name in sentences}
        assert marked == ({'the platform', 'rod 1', 'rod 2'} if rise else set())
        assert (boxes[0].color != BOX_COLOUR) == bool(rise)
        assert boxes[1].color == BOX_COLOUR
