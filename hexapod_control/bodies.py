"""A parallel platform as capsules: rods, cranks, the lines from joint to joint of its bodies."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from hexapod_control.geometry import LEGS
from hexapod_control.linear import LinearPlatform
from hexapod_control.parallel_platform import ParallelPlatform
from hexapod_control.rotary import RotaryHexapod
from hexapod_control.stacks.kinematics import StackKinematics
from manipulator import _kernel
from manipulator.arrays import Array, frozen
from manipulator.limits.surroundings import Bodies, BodiesConfig
from manipulator.pose import Pose

KEYS = {
    'rod': 'rod_diameter_mm',
    'crank': 'crank_diameter_mm',
    'platform': 'platform_thickness_mm',
    'base': 'base_thickness_mm',
}


@dataclass(frozen=True, eq=False)
class _Part:
    """One capsule: of what, of which leg; where (6,) platform and base hold it, if they do."""

    of: str
    leg: int
    on_platform: Array | None = None
    on_base: Array | None = None

    @property
    def name(self) -> str:
        """As 'rod 3'; lines of the platform are the platform."""
        return f'{self.of} {self.leg + 1}' if self.of in ('rod', 'crank') else f'the {self.of}'


def platform_bodies(kinematics: ParallelPlatform, config: BodiesConfig) -> Bodies:
    """The parts of a platform, lines where no diameters are given.

    Raises ConfigError for diameters of parts that it does not have.
    """
    parts = list(_parts(kinematics))
    known = {part.of for part in parts}
    config.check_keys({KEYS[of] for of in known}, 'this platform')
    widths = [getattr(config, KEYS[part.of]) for part in parts]
    radii = np.array([0.5e-3 * (width or 0.0) for width in widths])
    thick = [i for i, width in enumerate(widths) if width is not None]
    pairs = tuple(
        (i, k)
        for n, i in enumerate(thick)
        for k in thick[n + 1 :]
        if not _are_joined(parts[i], parts[k], radii[i] + radii[k])
    )
    moving = tuple(i for i, part in enumerate(parts) if part.of != 'base')

    def segments(pose: Pose, joints: Array) -> Array:
        return _segments(kinematics, pose, joints)

    return Bodies(tuple(part.name for part in parts), frozen(radii), pairs, moving, segments)


def stack_bodies(kinematics: StackKinematics, config: BodiesConfig) -> Bodies:
    """The parts of all sections, of which those of one section may not meet each other."""
    sections = [platform_bodies(platform, config) for platform in kinematics.platforms]
    starts = np.cumsum([0, *(len(section.names) for section in sections)])

    def segments(pose: Pose, joints: Array) -> Array:
        turn, place, pieces = np.eye(3), np.zeros(3), []
        for i, at in enumerate(kinematics.sections_or_nan(joints)):
            own = sections[i].segments(at, joints[..., LEGS * i : LEGS * (i + 1)])
            ends = own.reshape(*own.shape[:-2], -1, 3) @ np.swapaxes(turn, -1, -2)
            pieces.append((ends + place[..., None, :]).reshape(own.shape))
            for step in (at, kinematics.stack.transforms[i]):
                place = place + (turn @ step.position[..., None])[..., 0]
                turn = turn @ step.rotation
        return np.concatenate(pieces, axis=-2)

    return Bodies(
        tuple(f'section {i} {name}' for i, part in enumerate(sections, 1) for name in part.names),
        frozen(np.concatenate([section.radii for section in sections])),
        tuple(
            (int(a + start), int(b + start))
            for start, section in zip(starts, sections, strict=False)
            for a, b in section.pairs
        ),
        (*sections[0].moving, *range(int(starts[1]), int(starts[-1]))),
        segments,
    )


def _segments(kinematics: ParallelPlatform, pose: Pose, joints: Array) -> Array:
    """Rods, platform, cranks, base: as `_parts` lists them."""
    low = kinematics.base_points(joints)
    high = pose.transform(kinematics.geometry.platform_points)
    low, high = np.broadcast_arrays(low, high)
    pieces = [np.concatenate([low, high], axis=-1), _outline(high)]
    fixed = _fixed_points(kinematics)
    if isinstance(kinematics, RotaryHexapod) and fixed is not None:
        pieces.append(np.concatenate([np.broadcast_to(fixed, low.shape), low], axis=-1))
    if fixed is not None:
        outline = _outline(fixed)
        pieces.append(np.broadcast_to(outline, (*low.shape[:-2], *outline.shape)))
    return np.concatenate(pieces, axis=-2)


def _parts(kinematics: ParallelPlatform) -> Iterator[_Part]:
    top, fixed = kinematics.geometry.platform_points, _fixed_points(kinematics)
    has_cranks = isinstance(kinematics, RotaryHexapod)
    for leg in range(LEGS):
        foot = None if has_cranks or fixed is None else np.tile(fixed[leg], 2)
        yield _Part('rod', leg, np.tile(top[leg], 2), foot)
    for leg, line in enumerate(_outline(top)):
        yield _Part('platform', leg, on_platform=line)
    if fixed is None:
        return
    for leg in range(LEGS if has_cranks else 0):
        yield _Part('crank', leg, on_base=np.tile(fixed[leg], 2))
    for leg, line in enumerate(_outline(fixed)):
        yield _Part('base', leg, on_base=line)


def _fixed_points(kinematics: ParallelPlatform) -> Array | None:
    """Where the legs are fixed to the base (6, 3); None where carriages move."""
    if isinstance(kinematics, RotaryHexapod):
        return kinematics.geometry.crank_centres
    return kinematics.geometry.base_points if isinstance(kinematics, LinearPlatform) else None


def _outline(points: Array) -> Array:
    """The lines (..., 6, 6) from each point (..., 6, 3) to the next."""
    return np.concatenate([points, np.roll(points, -1, axis=-2)], axis=-1)


def _are_joined(one: _Part, other: _Part, width: float) -> bool:
    """Whether two parts overlap in every pose: one body, one joint, or joints this near."""
    if one.of == other.of and one.of in ('platform', 'base'):
        return True
    if {one.of, other.of} == {'rod', 'crank'} and one.leg == other.leg:
        return True
    return _is_near(one.on_platform, other.on_platform, width) or _is_near(
        one.on_base, other.on_base, width
    )


def _is_near(one: Array | None, other: Array | None, width: float) -> bool:
    if one is None or other is None:
        return False
    distance = np.empty(1)
    _kernel.segment_distance(np.ascontiguousarray(one), np.ascontiguousarray(other), distance)
    return bool(distance[0] < width)
