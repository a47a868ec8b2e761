"""Machines whose leg lengths never fix the pose, recognised by their joints alone."""

import numpy as np

from hexapod_control.leg_jacobian import leg_jacobian, smallest_singular_value
from manipulator import rotation as so3
from manipulator.arrays import Array
from manipulator.errors import ConfigError
from manipulator.pose import Pose

SAMPLES = 24
LEAST_SIGMA = 1e-7


def architecture_sigma(base_points: Array, platform_points: Array) -> float:
    """The largest σmin of the leg Jacobian over a fixed set of poses: 0 if always singular.

    base_points (6, 3) or (k, 6, 3), as for k settings of the cranks, in the base frame;
    platform_points (6, 3) in the platform frame; rotations scaled by the platform's rms radius.
    The samples are general poses, turned by up to 1 rad about each axis and shifted by up to half
    the base's radius: a regular architecture is singular on a surface at most, which these miss.
    """
    base = np.reshape(base_points, (-1, 1, 6, 3))
    centre = platform_points.mean(axis=0)
    size = _radius(platform_points)
    random = np.random.default_rng(3)
    rotation = so3.exp(random.uniform(-1.0, 1.0, (SAMPLES, 3)))
    low, high = (-0.5, -0.5, 0.7), (0.5, 0.5, 2.5)
    shift = random.uniform(low, high, (SAMPLES, 3)) * _radius(base[0, 0])
    poses = Pose(base[:, 0].mean(axis=1)[:, None] + shift, np.stack([rotation] * len(base)))
    jacobian = leg_jacobian(base, platform_points - centre, poses)
    return float(np.max(smallest_singular_value(jacobian, size)))


def check_architecture(base_points: Array, platform_points: Array) -> None:
    """Raises ConfigError where the leg Jacobian is singular in every sampled pose.

    The shapes are those of `architecture_sigma`. The best known case is a platform whose hexagon
    is similar to the base's, as in Lapikov et al. 2014, section 4, where φb = φmp.
    """
    if _radius(platform_points) == 0.0 or architecture_sigma(base_points, platform_points) < (
        LEAST_SIGMA
    ):
        raise ConfigError(
            [
                'the joints of base and platform are placed so that no leg lengths fix a pose: '
                'the platform can give way without any leg changing its length, wherever it '
                'stands (as when both hexagons are similar; give them different joint angles)'
            ]
        )


def _radius(points: Array) -> float:
    """The points' rms distance from their centroid."""
    return float(np.sqrt(np.mean(np.sum((points - points.mean(axis=0)) ** 2, axis=-1))))
