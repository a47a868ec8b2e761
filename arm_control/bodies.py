"""A serial arm as capsules: one a link, from a point of its joint's axis to the next joint's."""

from collections.abc import Iterator

import numpy as np

from arm_control.arm import SerialArm
from manipulator.arrays import Array, frozen
from manipulator.errors import ConfigError
from manipulator.limits.surroundings import Bodies, BodiesConfig
from manipulator.pose import Pose

NAMES = ('base', *(f'link {i}' for i in range(1, 6)), 'tool')
MOVING = tuple(range(2, len(NAMES)))
"""Not the base, and not link 1, which turns about it: they stand on the floor."""


def arm_bodies(arm: SerialArm, config: BodiesConfig) -> Bodies:
    """The parts of an arm, lines where no diameters are given; the tool with link 6.

    Raises ConfigError for diameters of other parts, or not one for each.
    """
    config.check_keys({'link_diameters_mm'}, 'an arm')
    given = config.link_diameters_mm
    if given is not None and len(given) != len(NAMES):
        raise ConfigError([f'bodies.link_diameters_mm: has {len(given)} entries, needs 7'])
    radii = np.zeros(len(NAMES)) if given is None else 0.5e-3 * np.array(given)
    pairs = () if given is None else tuple(_pairs(arm, radii))

    def segments(pose: Pose, joints: Array) -> Array:
        points = line_of(arm, joints)
        return np.concatenate([points[..., :-1, :], points[..., 1:, :]], axis=-1)

    return Bodies(NAMES, frozen(radii), pairs, MOVING, segments)


def line_of(arm: SerialArm, joints: Array) -> Array:
    """The base, a point of each joint's axis, the tool: (..., 8, 3), base frame, metres."""
    moved = arm.chain.displacements(joints)
    points = np.concatenate([arm.chain.points, arm.chain.home.position[None]])
    turned = (moved[..., :3, :3] @ points[..., None])[..., 0] + moved[..., :3, 3]
    base = np.zeros((*turned.shape[:-2], 1, 3))
    return np.concatenate([base, turned], axis=-2)


def _pairs(arm: SerialArm, radii: Array) -> Iterator[tuple[int, int]]:
    """Parts that are no neighbours: between them the arm is longer than both are wide.

    With less between them they overlap in every posture, as the links of a wrist do.
    """
    lengths = np.linalg.norm(np.diff(line_of(arm, np.zeros(6)), axis=0), axis=1)
    for i in range(len(NAMES)):
        for k in range(i + 2, len(NAMES)):
            if lengths[i + 1 : k].sum() > radii[i] + radii[k]:
                yield i, k
