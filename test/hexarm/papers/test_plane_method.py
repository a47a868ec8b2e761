import numpy as np
import pytest

from hexapod_control.assembly_modes import assembly_modes
from hexapod_control.linear_geometry import PlatesConfig
from hexarm.papers.plane_method import PlaneMethod
from manipulator import rotation as so3
from manipulator.errors import NoSolution
from manipulator.pose import Pose
from newton import Newton

START = Pose(np.array([0, 0, 0.17]), np.eye(3))
PLATES = {
    '6-6': PlatesConfig(100, 50, 50, 10, 5, 5, 170),
    '6-6 even': PlatesConfig(100, 10, 50, 30, 5, 8, 170),
    '6-3': PlatesConfig(100, 50, 50, 0, 5, 5, 170),
}


def lengths_at(plates, pose):
    geometry = plates.geometry()
    return np.linalg.norm(pose.transform(geometry.platform_points) - geometry.base_points, axis=1)


def random_pose(random):
    return Pose(
        random.uniform([-0.03, -0.03, 0.14], [0.03, 0.03, 0.2]),
        so3.exp(random.uniform(-0.25, 0.25, 3)),
    )


@pytest.mark.parametrize('name', PLATES)
def test_the_pose_that_made_the_lengths_is_found(name):
    random, plates = np.random.default_rng(2), PLATES[name]
    method = PlaneMethod.of(plates)
    for _ in range(30):
        pose = random_pose(random)
        found = method.solve(lengths_at(plates, pose), START)
        assert np.allclose(found.pose.position, pose.position, atol=1e-11)
        assert np.allclose(found.pose.rotation, pose.rotation, atol=1e-10)
        assert found.residual < 1e-12
        assert 0 < found.evaluations < 40


@pytest.mark.parametrize('name', PLATES)
def test_three_forward_methods_agree(name):
    random, plates = np.random.default_rng(3), PLATES[name]
    geometry = plates.geometry()
    newton = Newton(geometry.platform_points, 0.05)
    for _ in range(10):
        lengths = lengths_at(plates, random_pose(random))
        plane = PlaneMethod.of(plates).solve(lengths, START).pose
        direct = newton.solve(geometry.base_points, lengths, START).pose
        modes = assembly_modes(geometry.base_points, geometry.platform_points, lengths)
        for pose in (direct, plane):
            nearest = min(np.abs(m.twist_to(pose)).max() for m in modes.poses)
            assert nearest < 1e-9


@pytest.mark.parametrize('name', PLATES)
def test_the_virtual_triangle_joins_the_prolonged_sides(name):
    plates = PLATES[name]
    points = plates.geometry().platform_points
    method = PlaneMethod.of(plates)
    corners = method._corners(Pose.identity())
    assert np.allclose(method._joints(corners), points, atol=1e-15)
    sides = np.linalg.norm(corners - corners[[1, 2, 0]], axis=1)
    assert np.allclose(sides, method.side)


def test_the_jacobian_is_the_derivative_of_the_equations():
    plates = PLATES['6-6']
    method, random = PlaneMethod.of(plates), np.random.default_rng(5)
    x = random.normal(size=9) * 0.1
    lengths = lengths_at(plates, START)
    jacobian = method._equations(x, lengths)[1]
    for k, unit in enumerate(np.eye(9)):
        ends = [method._equations(x + h * unit, lengths)[0] for h in (1e-6, -1e-6)]
        assert np.allclose(jacobian[:, k], (ends[0] - ends[1]) / 2e-6, atol=1e-7)


def test_lengths_that_do_not_close_raise():
    with pytest.raises(NoSolution, match='plane method'):
        PlaneMethod.of(PLATES['6-6']).solve(np.array([0.6, 0.1, 0.1, 0.1, 0.1, 0.1]), START)
