import numpy as np
import pytest

from hexapod_control.geometry import HexagonConfig, architecture_sigma, check_architecture
from hexapod_control.linear_geometry import PlatesConfig, joint_circle
from manipulator.errors import ConfigError


@pytest.mark.parametrize('degrees', [5, 10, 20, 30, 45, 55])
def test_the_papers_equal_joint_angles_are_refused_on_loading(degrees):
    with pytest.raises(ConfigError, match='no leg lengths fix a pose'):
        PlatesConfig(100, degrees, 50, degrees, 5, 5, 150).geometry()


@pytest.mark.parametrize('angles', [(50, 10), (50, 0), (30, 0), (0, 30), (10, 50), (31, 29)])
def test_unlike_joint_angles_pass(angles):
    base, platform = (joint_circle(0.1, np.radians(a)) for a in angles)
    check_architecture(base, platform)
    assert architecture_sigma(base, platform) > 0.01


def test_a_nearly_singular_architecture_passes_with_a_small_figure():
    base, platform = joint_circle(0.1, np.radians(30.0)), joint_circle(0.05, np.radians(30.01))
    check_architecture(base, platform)
    assert architecture_sigma(base, platform) < 1e-3


def test_the_figure_does_not_depend_on_size():
    base, platform = joint_circle(0.1, 0.9), joint_circle(0.05, 0.2)
    large = architecture_sigma(30 * base, 30 * platform)
    assert large == pytest.approx(architecture_sigma(base, platform), rel=1e-9)


def test_random_joints_pass():
    random = np.random.default_rng(4)
    for _ in range(20):
        check_architecture(random.normal(size=(6, 3)), random.normal(size=(6, 3)))


def test_crank_tips_are_judged_over_all_settings_given():
    machine = HexagonConfig(71.492, 25.0, 5.79, 17.5, 58.0, 1.5, 30.0, 41.19).geometry()
    angles = np.radians(np.full((3, 6, 1), 120) + np.array([0, 20, -20]).reshape(3, 1, 1))
    crank = np.cos(angles) * machine.tangents + np.sin(angles) * machine.ups
    tips = machine.crank_centres + machine.crank_lengths[:, None] * crank
    check_architecture(tips, machine.platform_points)
    similar = np.stack([joint_circle(0.1, 0.5), joint_circle(0.2, 0.5)])
    with pytest.raises(ConfigError):
        check_architecture(similar, joint_circle(0.05, 0.5))
    check_architecture(np.stack([similar[0], joint_circle(0.2, 0.9)]), joint_circle(0.05, 0.5))


def test_joints_all_in_one_point_are_refused():
    with pytest.raises(ConfigError):
        check_architecture(joint_circle(0.1, 0.9), np.zeros((6, 3)))
