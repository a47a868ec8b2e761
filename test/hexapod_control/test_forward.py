"""Forward kinematics by lengths, on random machines with known poses."""

import numpy as np
import pytest

from hexapod_control.leg_jacobian import leg_jacobian, smallest_singular_value
from manipulator.errors import NoSolution
from manipulator.pose import Pose
from newton import Newton, lengths_at

HEIGHT = 0.15


def ring(radius, half_gap, z=0.0):
    """Six points in pairs about 0°, 120° and 240°."""
    angles = [t + s * half_gap for t in np.radians([0, 120, 240]) for s in (-1, 1)]
    return np.array([[radius * np.cos(a), radius * np.sin(a), z] for a in angles])


@pytest.fixture
def base():
    return ring(0.1, np.radians(50), 0.005)


@pytest.fixture
def platform():
    return ring(0.05, np.radians(10), -0.005)


@pytest.fixture
def solver(platform):
    return Newton(platform, 0.05)


def home():
    return Pose.from_xyz_rpy([0.0, 0.0, HEIGHT])


@pytest.mark.parametrize('seed', range(30))
def test_the_pose_that_made_the_lengths_is_found(base, platform, solver, seed):
    generator = np.random.default_rng(seed)
    pose = home().moved(generator.uniform(-1, 1, 6) * ([0.02] * 3 + [0.2] * 3))
    solution = solver.solve(base, lengths_at(base, platform, pose), home())
    assert np.abs(pose.twist_to(solution.pose)).max() < 1e-9
    assert solution.iterations <= 6


def test_the_solution_reports_its_closure_and_margin(base, platform, solver):
    pose = home().moved([0.01, 0.0, 0.01, 0.1, 0.0, 0.1])
    lengths = lengths_at(base, platform, pose)
    solution = solver.solve(base, lengths, home())
    closure = np.abs(lengths_at(base, platform, solution.pose) - lengths).max()
    assert solution.residual == pytest.approx(closure, abs=1e-15)
    jacobian = leg_jacobian(base, platform, pose) / ([1.0] * 3 + [0.05] * 3)
    assert solution.sigma_min == pytest.approx(np.linalg.norm(jacobian @ weakest(jacobian)))


def weakest(matrix):
    values, vectors = np.linalg.eigh(matrix.T @ matrix)
    return vectors[:, np.argmin(values)]


def test_the_jacobian_is_how_lengths_follow_the_pose(base, platform):
    pose = home().moved([0.01, -0.02, 0.01, 0.1, -0.2, 0.3])
    for axis, twist in enumerate(np.eye(6) * 1e-6):
        ahead = lengths_at(base, platform, pose.moved(twist))
        behind = lengths_at(base, platform, pose.moved(-twist))
        column = leg_jacobian(base, platform, pose)[:, axis]
        np.testing.assert_allclose((ahead - behind) / 2e-6, column, atol=1e-9)


def test_a_far_start_is_approached_in_bounded_turns(base, platform, solver):
    # Full Newton steps from here end beyond a singularity.
    start = home().moved([0.0, 0.0, 0.03, 0.0, 0.0, 1.1])
    solution = solver.solve(base, lengths_at(base, platform, home()), start)
    assert np.abs(home().twist_to(solution.pose)).max() < 1e-9


def test_lengths_that_no_pose_has_are_refused(base, solver):
    with pytest.raises(NoSolution):
        solver.solve(base, np.array([0.3, 0.05, 0.3, 0.05, 0.3, 0.05]), home())
    with pytest.raises(NoSolution):
        solver.solve(base, np.full(6, np.nan), home())


@pytest.mark.parametrize('length', [np.nan, np.inf, -np.inf])
def test_lengths_that_are_not_finite_end_at_the_first_step(base, solver, length):
    lengths = np.array([0.1] * 5 + [length])
    with np.errstate(invalid='ignore'), pytest.raises(NoSolution, match='met a singular pose'):
        solver.solve(base, lengths, home())


def test_a_singular_architecture_is_refused(platform):
    solver = Newton(platform, 0.05)
    similar = platform * [2.0, 2.0, 1.0]
    pose = home().moved([0.005, 0.0, 0.0, 0.0, 0.0, 0.05])
    assert smallest_singular_value(leg_jacobian(similar, platform, pose), 0.05) < 1e-12
    with pytest.raises(NoSolution):
        solver.solve(similar, lengths_at(similar, platform, pose), home(), margin=0.01)


def test_an_answer_on_the_other_side_of_a_singularity_is_refused(base, platform, solver):
    below = Pose.from_xyz_rpy([0.0, 0.0, -HEIGHT])
    lengths = lengths_at(base, platform, below)
    side = np.linalg.det(leg_jacobian(base, platform, home()))
    assert side * np.linalg.det(leg_jacobian(base, platform, below)) < 0
    assert np.abs(below.twist_to(solver.solve(base, lengths, below).pose)).max() < 1e-9
    with pytest.raises(NoSolution, match='beyond a singularity'):
        solver.solve(base, lengths, below, side=side)


def test_an_answer_is_on_the_side_of_its_start_however_far_that_is(base, platform, solver):
    generator, refused = np.random.default_rng(8), 0
    for _ in range(1000):
        pose, start = (home().moved(generator.normal(0, 1, 6) * [0.08] * 6) for _ in range(2))
        start = start.moved([0, 0, 0, *generator.normal(0, 1.0, 3)])
        side = np.linalg.det(leg_jacobian(base, platform, start))
        try:
            found = solver.solve(base, lengths_at(base, platform, pose), start).pose
        except NoSolution as error:
            refused += 'beyond a singularity' in str(error)
            continue
        assert np.linalg.det(leg_jacobian(base, platform, found)) * side > 0.0
    assert refused > 20


def test_a_pose_below_the_margin_is_refused(base, platform, solver):
    lengths = lengths_at(base, platform, home())
    margin = solver.solve(base, lengths, home()).sigma_min
    with pytest.raises(NoSolution, match='margin'):
        solver.solve(base, lengths, home(), margin=1.01 * margin)


def test_the_result_cannot_be_written(base, platform, solver):
    pose = solver.solve(base, lengths_at(base, platform, home()), home()).pose
    with pytest.raises(ValueError, match='read-only'):
        pose.position[0] = 1.0
