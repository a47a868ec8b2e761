import numpy as np
import pytest

from hexapod_control.geometry_errors import GeometryErrors, geometry_slopes, with_errors
from hexarm.machines import load
from manipulator.analysis.accuracy import JointErrors, drawn_spread, linear_spread
from manipulator.errors import InvalidInput

DEGREE = np.radians(1.0)
MACHINES = ['robocake', 'stewart_6_3', 'arm_6r']


@pytest.fixture(scope='module', params=MACHINES)
def kinematics(request):
    return load(request.param).kinematics


@pytest.fixture(scope='module', params=MACHINES[:2])
def platform(request):
    return load(request.param).kinematics


@pytest.mark.parametrize(
    ('chosen', 'millimetres'),
    [(tuple(range(6)), 0.205), ((0,), 0.082), ((0, 2, 4), 0.144)],
)
def test_one_degree_of_servo_noise_moves_the_platform_as_checked(chosen, millimetres):
    """An independent check's figures; the paper's are 9.9, 24.7 and 30.0 µm."""
    hexapod = load('robocake').kinematics
    errors = JointErrors.of(6, noise=DEGREE).on(chosen)
    drawn = drawn_spread(hexapod, hexapod.home, errors, 3000, np.random.default_rng(1))
    assert 1e3 * linear_spread(hexapod, hexapod.home, errors).position_rms == pytest.approx(
        millimetres, rel=0.015
    )
    assert 1e3 * drawn.position_rms == pytest.approx(millimetres, rel=drawn.relative_error)


@pytest.mark.parametrize('kind', ['noise', 'dead_band', 'hysteresis'])
def test_law_and_drawing_agree_on_the_whole_second_moment(kinematics, kind):
    size = 2e-3 if kinematics.joint_unit == 'rad' else 1e-4
    errors = JointErrors.of(6, **{kind: size})
    pose = kinematics.home.moved([2e-3, 1e-3, -1e-3, 0.02, 0.01, 0.03])
    law = linear_spread(kinematics, pose, errors)
    drawn = drawn_spread(kinematics, pose, errors, 1500, np.random.default_rng(2))
    scale = np.sqrt(np.outer(*2 * [np.diag(law.second_moments)]))
    assert np.abs((drawn.second_moments - law.second_moments) / scale).max() < 0.15
    assert drawn.angle_rms == pytest.approx(law.angle_rms, rel=drawn.relative_error)


def test_draws_have_the_variance_stated():
    generator = np.random.default_rng(3)
    errors = JointErrors(np.full(2, 0.3), np.array([0.0, 0.5]), np.array([0.2, 0.0]))
    drawn = errors.drawn(200_000, generator)
    np.testing.assert_allclose(drawn.var(axis=0), np.diag(errors.covariance), rtol=0.01)
    assert np.abs(drawn[:, 0]).max() <= 0.4
    assert np.abs(drawn[:, 1]).max() <= 0.55
    assert np.diag(errors.covariance) == pytest.approx([0.03 + 0.01, 0.03 + 0.25 / 12])


def test_shared_signals_have_the_covariance_stated():
    """Two signals over three joints: the third has a noise of its own, too."""
    weights = np.array([[0.2, -0.2, 0.0], [0.1, 0.1, 0.3]])
    errors = JointErrors(np.array([0.0, 0.0, 0.1]), np.zeros(3), np.zeros(3), weights)
    drawn = errors.drawn(200_000, np.random.default_rng(6))
    np.testing.assert_allclose(np.cov(drawn.T), errors.covariance, atol=1e-4)
    assert errors.covariance[0, 1] == pytest.approx((0.01 - 0.04) / 3)
    np.testing.assert_array_equal(errors.on((0,)).shared, weights * [1, 0, 0])


def test_one_signal_on_all_mirrored_servos_cancels_and_independent_noise_does_not():
    """±1° at home: 82.6 µm on one servo; of all six only the second order is left, 0.41 µm."""
    hexapod = load('robocake').kinematics
    common = JointErrors.common(DEGREE * np.array([1.0, -1.0] * 3))
    generator = np.random.default_rng(7)
    six = drawn_spread(hexapod, hexapod.home, common, 500, generator)
    one = drawn_spread(hexapod, hexapod.home, common.on((0,)), 500, generator)
    assert 1e6 * float(linear_spread(hexapod, hexapod.home, common).position_rms) < 1e-6
    assert 1e6 * six.position_rms == pytest.approx(0.41, abs=0.02)
    assert 1e6 * one.position_rms == pytest.approx(82.6, rel=0.06)


def test_shared_errors_of_another_number_of_joints_are_refused():
    with pytest.raises(InvalidInput, match=r'\(1, 2\), needs \(signals, 3\)'):
        JointErrors(np.zeros(3), np.zeros(3), np.zeros(3), np.zeros((1, 2)))


def test_spreads_of_many_poses_are_those_of_each(kinematics):
    errors = JointErrors.of(6, noise=1e-3)
    poses = kinematics.home.moved(np.random.default_rng(4).uniform(-2e-3, 2e-3, (5, 6)))
    together = linear_spread(kinematics, poses, errors).position_rms
    for k in range(5):
        alone = linear_spread(kinematics, poses[k], errors).position_rms
        assert together[k] == pytest.approx(alone, rel=1e-9)


def test_geometry_errors_by_law_and_by_machines_built_with_them(platform):
    errors = GeometryErrors(1e-4)
    law = errors.linear_spread(platform, platform.home)
    built = errors.drawn_spread(platform, platform.home, 600, np.random.default_rng(5))
    assert built.position_rms == pytest.approx(law.position_rms, rel=built.relative_error)
    assert built.angle_rms == pytest.approx(law.angle_rms, rel=built.relative_error)


def test_a_base_moved_as_a_whole_moves_the_platform_with_it(platform):
    """All base points by one vector: the slopes of these parameters add up to that vector."""
    slopes = geometry_slopes(platform, platform.home)
    for axis in range(3):
        total = slopes[:, axis:18:3].sum(axis=1)
        np.testing.assert_allclose(total, np.eye(6)[axis], atol=1e-5)


def test_a_machine_with_errors_has_other_joints_in_place(platform):
    errors = np.zeros(geometry_slopes(platform, platform.home).shape[1])
    errors[20] = 1e-3
    expected = np.zeros((6, 3))
    expected[0, 2] = 1e-3
    changed = with_errors(platform, errors).geometry.platform_points
    assert changed - platform.geometry.platform_points == pytest.approx(expected)
