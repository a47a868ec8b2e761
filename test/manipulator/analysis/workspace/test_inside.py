import numpy as np
import pytest

from hexapod_control.workspace import axis_range
from manipulator.analysis.inside import conditions, joint_rates, ranges, section, surface
from manipulator.analysis.survey import survey
from manipulator.analysis.volume import Box
from manipulator.pose import Pose
from sampling import enough


def test_ranges_are_those_of_each_axis(robocake):
    found = ranges(robocake)
    for axis, name in enumerate(('x', 'y', 'z', 'roll', 'pitch', 'yaw')):
        assert found[name] == pytest.approx(axis_range(robocake, axis), abs=1e-7)


@pytest.mark.parametrize('name', ['robocake', 'stewart'])
def test_joint_rates_are_what_the_joints_do_along_a_twist(request, name):
    machine = request.getfixturevalue(name)
    pose = machine.kinematics.home.moved([3e-3, -2e-3, 4e-3, 0.03, 0.05, -0.02])
    rates = joint_rates(machine, pose)
    for column, twist in enumerate(np.eye(6) * 1e-6):
        ahead, behind = (machine.kinematics.inverse(pose.moved(s * twist)) for s in (1, -1))
        np.testing.assert_allclose(rates[:, column], (ahead - behind) / 2e-6, rtol=1e-4, atol=1e-5)


def test_the_fastest_joint_is_the_worst_over_all_directions(robocake):
    pose = robocake.kinematics.home.moved([3e-3, -2e-3, 4e-3, 0, 0, 0])
    found = conditions(robocake, Pose(pose.position[None], pose.rotation[None]))
    ways = np.random.default_rng(1).standard_normal((20_000, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    fastest = np.abs(ways @ joint_rates(robocake, pose)[:, :3].T).max()
    assert found.joint_speed[0] == pytest.approx(fastest, rel=1e-3)


def test_crank_speeds_at_30_mm_s_along_x_mirror_each_other(robocake):
    """Prokopovich 2019, fig. 9: the machine is its own mirror image in x, with other legs."""
    x = np.array([-0.012, -0.005, 0.0, 0.005, 0.012])
    poses = robocake.kinematics.home.moved(x[:, None] * np.eye(6)[0])
    speeds = np.degrees(0.03 * joint_rates(robocake, poses)[..., 0])
    assert np.sort(np.abs(speeds[0])) == pytest.approx(np.sort(np.abs(speeds[-1])))
    assert np.abs(speeds[2]).max() == pytest.approx(98.9, abs=0.5)
    assert np.abs(speeds[-1]).max() > 1.4 * np.abs(speeds[2]).max()


def test_the_surface_is_the_edge_of_what_is_admitted(robocake):
    ways = np.random.default_rng(2).standard_normal((200, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    ends, home = surface(robocake, ways), robocake.kinematics.home
    for late, expected in ((-1e-7, True), (1e-7, False)):
        places = Pose(ends + late * ways, np.tile(home.rotation, (200, 1, 1)))
        assert (conditions(robocake, places).admitted == expected).all()
    assert surface(robocake, np.array([1.0, 0, 0]))[0] == pytest.approx(0.015627, abs=1e-6)


def test_a_section_lies_in_its_plane(robocake):
    low, high = np.array([-0.02, -0.02, 0.02]), np.array([0.02, 0.02, 0.06])
    plane = section(robocake, (0, 2), low, high, 21)
    assert plane.conditions.admitted[10, 10]
    assert np.isnan(plane.conditions.sigma_min[0, 0])
    home = robocake.kinematics.home
    place = Pose([[plane.across[12], 0.0, plane.up[8]]], home.rotation[None])
    assert plane.conditions.sigma_min[8, 12] == pytest.approx(
        conditions(robocake, place).sigma_min[0]
    )


def test_a_survey_agrees_with_the_volume_under_the_surface(robocake):
    """Cones from home to the surface, integrated over all directions, fill the same volume."""
    stages = []
    positions = enough(8000, 100_000)
    found = survey(robocake, positions, 0.3, lambda stage, share: stages.append((stage, share)))
    cosines, turns = np.polynomial.legendre.leggauss(60)
    angles = np.linspace(0, 2 * np.pi, 120, endpoint=False)
    sine = np.sqrt(1 - cosines**2)[:, None]
    ways = np.stack(
        [sine * np.cos(angles), sine * np.sin(angles), np.tile(cosines[:, None], 120)], axis=-1
    )
    radii = np.linalg.norm(surface(robocake, ways) - robocake.kinematics.home.position, axis=-1)
    under = (turns[:, None] * radii**3 / 3).sum() * 2 * np.pi / 120
    constant = found.constant_orientation
    assert constant.value == pytest.approx(under, abs=constant.error + 0.003 * under)
    assert found.connected_share == 1.0
    assert found.some_orientation.value > constant.value
    assert ('volume', 1.0) in stages
    assert isinstance(found.box, Box)
