"""Legs that do not close: what is wrong with the rod, and by how much, by its two ends."""

import numpy as np
import pytest

from hexarm.machines import load
from manipulator.pose import Pose

MACHINE = load('robocake')
G = MACHINE.kinematics.geometry
LIMITS = {limit.quantity: limit for limit in MACHINE.constraints.limits}
ANGLES = np.linspace(-np.pi, np.pi, 20_001)[:, None]


def farthest_and_nearest(pose, leg):
    """How far the platform's joint of a leg is from its crank's tip, at most and at least."""
    tips = G.crank_centres[leg] + G.crank_lengths[leg] * (
        np.cos(ANGLES) * G.tangents[leg] + np.sin(ANGLES) * G.ups[leg]
    )
    distances = np.linalg.norm(pose.transform(G.platform_points)[leg] - tips, axis=1)
    return distances.max(), distances.min()


@pytest.mark.parametrize('quantity', ['rod shortfall', 'rod surplus'])
def test_values_are_by_how_much_a_rod_fails_to_join_crank_and_platform(quantity):
    inside_leg_3 = Pose.from_xyz_rpy(G.crank_centres[2] - G.platform_points[2] + [0, 0, 1e-3])
    above = Pose.from_xyz_rpy([0.0, 0.0, 0.065])
    for pose, leg, wrong in ((above, 0, 'rod shortfall'), (inside_leg_3, 2, 'rod surplus')):
        farthest, nearest = farthest_and_nearest(pose, leg)
        by_definition = {
            'rod shortfall': nearest - G.rod_lengths[leg],
            'rod surplus': G.rod_lengths[leg] - farthest,
        }
        value = LIMITS[quantity].values(pose, MACHINE.kinematics.inverse_or_nan(pose))[leg]
        assert value == pytest.approx(by_definition[quantity], abs=1e-6)
        assert (value > 0.0) == (quantity == wrong)
