"""Every pose that six leg lengths allow: all real solutions of the general forward problem.

The equations of forward_ideal.py are multiplied up to one degree. The null space of their
coefficient matrix holds the evaluation at every solution, and on it the multiplication by e_j is a
small matrix whose eigenvectors are these evaluations: no start value, no path, no chance.
docs/forward-modes.md derives it and shows why no solution can be missed.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hexapod_control import forward_ideal as monomials
from hexapod_control.forward import rules
from hexapod_control.forward_ideal import GENERATORS, LegEquations, multiples, turned
from hexapod_control.leg_jacobian import leg_jacobian, rods, smallest_singular_value
from hexapod_control.parallel_platform import ParallelPlatform, checked_joints
from manipulator import _kernel
from manipulator import rotation as so3
from manipulator.arrays import Array, Mask, frozen, stretched
from manipulator.errors import InvalidInput, NoSolution
from manipulator.pose import Pose

DEGREE = 8
SOLUTIONS = 40  # of the general problem, with their multiplicities: Z has as many columns
GROUPS, LEADING = 252, 228  # sums of equations, of rank 244; those that are safely independent
NO_PIVOT = 1e-9  # a pivot or a singular value is zero below this part of the largest pivot
INFINITE = 1e-5  # |e·e| of a solution without a finite rotation, |e| being 1
REAL = 1e-9  # imaginary part of e, |e| being 1, that is rounding alone
NEARLY_REAL = 1e-4  # and that can come of two real solutions which almost meet
NO_PLACE = 1e-6  # of leg 1's squared length: how far below 0 is not rounding
SAME = 1e-5  # distance of two poses that are one, as part of the platform's size
TOLERANCE = 1e-10  # of the leg lengths, relative
ROUNDING = 4e-15  # and what no further step improves
NEAR = 1e-3  # from here on Newton's method is sure of its way, likewise
MOST_ITERATIONS = 30

Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class AssemblyModes:
    """All poses of the platform for one set of leg lengths.

    sigma_min is each mode's smallest singular value of the leg Jacobian about the platform's
    origin, rotations scaled by the platform joints' rms distance from their centroid; two modes
    that meet in a singular pose, where it is below 1e-5, are listed once, to about 1e-6 only.
    complex_count is the number of all solutions, each with its multiplicity; infinite_count of
    these have no finite rotation. `is_complete` is true when no solution can be missing.
    """

    poses: tuple[Pose, ...]
    sigma_min: tuple[float, ...]
    complex_count: int
    infinite_count: int
    is_complete: bool


def assembly_modes(
    base_points: ArrayLike, platform_points: ArrayLike, lengths: ArrayLike
) -> AssemblyModes:
    """Every pose (rotations proper) with joints (6, 3) and leg lengths (6,) in metres.

    Sorted by height, the highest first, then by x, y and the angle of rotation. A crank platform
    asks with the crank tips as base points and the rods as legs. Raises InvalidInput on wrong
    shapes or lengths ≤ 0, NoSolution where the lengths do not fix finitely many poses.
    """
    base, platform, legs = _checked(base_points, platform_points, lengths)
    equations = LegEquations.of(base, platform, legs)
    rows = multiples(DEGREE, GENERATORS).mixed(equations.coefficients(), GROUPS)
    null_space = _null_space(rows, LEADING)
    e, is_whole = _solutions(null_space)
    quaternions, is_real = _nearly_real(e)
    starts, has_place = _placed(equations, quaternions)
    position = starts.position + base[0] - starts.rotation @ platform[0]
    poses, closed = _polished(base, platform, legs, Pose(position, starts.rotation))
    found = np.any(closed.reshape(2, -1), axis=0)
    modes, sigma = _distinct(base, platform, poses[closed])
    return AssemblyModes(
        modes,
        sigma,
        null_space.shape[1],
        int(np.sum(np.abs(np.sum(e * e, axis=1)) < INFINITE)),
        is_whole
        and null_space.shape[1] >= SOLUTIONS
        and bool(np.all(found, where=is_real & has_place)),
    )


def modes_of(platform: ParallelPlatform, joints: Array) -> AssemblyModes:
    """Every pose that a platform's joints (6,) allow; NoSolution as its `forward`."""
    checked = checked_joints(joints)
    points = platform.geometry.platform_points
    return assembly_modes(platform.base_points(checked), points, platform.rod_lengths(checked))


def _checked(
    base_points: ArrayLike, platform_points: ArrayLike, lengths: ArrayLike
) -> tuple[Array, Array, Array]:
    wanted = {'base points': (6, 3), 'platform points': (6, 3), 'leg lengths': (6,)}
    arrays = [np.asarray(x, dtype=np.float64) for x in (base_points, platform_points, lengths)]
    for (name, shape), array in zip(wanted.items(), arrays, strict=True):
        if array.shape != shape or not np.isfinite(array).all():
            raise InvalidInput(f'{name} have shape {array.shape}, need {shape} finite numbers')
    for leg, length in enumerate(arrays[2], start=1):
        if length <= 0.0:
            raise InvalidInput(f'leg {leg}: length {length:.4g} m is not above 0')
    return arrays[0], arrays[1], arrays[2]


def _null_space(columns: Array, leading: int) -> Array:
    """A basis (n, count) of the functionals that vanish on all `columns` (n, m), consumed.

    Gauss's elimination with row pivots for the `leading` ones, P L U: with the rows [A; B] of L, A
    triangular, functionals are P [−A⁻ᵀBᵀ; 1] N, where N vanishes on what is left of the other
    columns, which are more than their rank, so that it is told without doubt. No entry of L is
    above 1. Raises NoSolution where the leading columns are dependent.
    """
    from scipy.linalg import lu_factor, solve_triangular  # noqa: PLC0415 (50 MB: for who asks)

    rest = columns[:, leading:].copy()
    factors, swaps = lu_factor(columns[:, :leading], overwrite_a=True, check_finite=False)
    pivots = np.abs(np.diag(factors))
    if not pivots.min() > NO_PIVOT * pivots.max():
        raise NoSolution('the leg lengths do not fix finitely many poses')
    order = list(range(len(columns)))
    for i, k in enumerate(swaps.tolist()):
        order[i], order[k] = order[k], order[i]
    above, below = factors[:leading], factors[leading:]
    lower = solve_triangular(
        above, below.T, trans=1, lower=True, unit_diagonal=True, check_finite=False
    )
    rest = rest[order]
    left, values, _ = np.linalg.svd(rest[leading:] - lower.T @ rest[:leading])
    free = left[:, int((values > NO_PIVOT * pivots.max()).sum()) :]
    null = np.empty((len(columns), free.shape[1]))
    null[order] = np.vstack([-lower @ free, free])
    return np.linalg.qr(null)[0]


def _solutions(null_space: Array) -> tuple[Complex, bool]:
    """Every solution's quaternion (count, 4) of length 1, and whether none can be missing."""
    shifts = list(zip(*monomials.shift_table(DEGREE), strict=True))
    by_e = [factor[:, None] * null_space[index] for index, factor in shifts]
    directions, mixture = _DIRECTION
    denominator = sum(h * z for h, z in zip(directions, by_e, strict=True))
    if null_space.shape[1] == 0:
        raise NoSolution('the leg lengths do not fix finitely many poses')
    columns, triangle = np.linalg.qr(denominator)
    values = np.linalg.svd(triangle, compute_uv=False)
    if values[-1] < 1e-9 * values[0]:
        raise NoSolution('the leg lengths do not fix finitely many poses')
    right = columns.conj().T @ sum(r * z for r, z in zip(mixture, by_e, strict=True))
    _, vectors = np.linalg.eig(np.linalg.solve(triangle, right))
    # an eigenvector is the evaluation at a solution: read e off it
    evaluations, seen = null_space @ vectors, (denominator @ vectors).conj()
    e = np.stack(
        [(seen * (factor[:, None] * evaluations[index])).sum(axis=0) for index, factor in shifts],
        axis=1,
    )
    return e / np.linalg.norm(e, axis=1)[:, None], bool(values[-1] > 1e-6 * values[0])


def _nearly_real(e: Complex) -> tuple[Array, Mask]:
    """The real unit quaternions among e, and which of them are real beyond doubt."""
    square = np.sum(e * e, axis=1)
    straight = e * np.exp(-0.5j * np.angle(square))[:, None]
    imaginary = np.linalg.norm(straight.imag, axis=1)
    near = imaginary < NEARLY_REAL
    real = straight.real[near]
    return real / np.linalg.norm(real, axis=1)[:, None], imaginary[near] < REAL


def _placed(equations: LegEquations, e: Array) -> tuple[Pose, Mask]:
    """Leg 1's platform joint from leg 1's base joint, metres, for rotations e (m, 4): 2m poses.

    And which of the m rotations may have a real place: with others, leg 1 would be too short.

    The leg equations (3) fix the place up to their weakest direction, along which leg 1's length
    leaves two points; both are kept, since they are both solutions where base and platform are
    planar and parallel.
    """
    rotation = turned(e)
    b = equations.b @ np.swapaxes(rotation, -1, -2)
    right_side = np.sum(equations.a * b, axis=-1) - equations.d
    u, s, v = np.linalg.svd(b - equations.a, full_matrices=False)
    along = np.einsum('mij,mi->mj', u, right_side)[:, :2] / np.maximum(s[:, :2], 1e-12)
    middle = np.einsum('mj,mji->mi', along, v[:, :2])
    square = equations.length**2 - np.sum(middle**2, axis=-1)
    has_place = (square > -NO_PLACE * equations.length**2) | (s[:, 1] < NO_PLACE * s[:, 0])
    height = np.sqrt(np.maximum(square, 0.0))
    offset = height[:, None] * v[:, 2]
    position = equations.scale * np.concatenate([middle + offset, middle - offset])
    return Pose(position, np.concatenate([rotation, rotation])), has_place


def _polished(base: Array, platform: Array, lengths: Array, poses: Pose) -> tuple[Pose, Mask]:
    """The poses after Newton's method, and which of them have the leg lengths wanted.

    Steps of least length, which end well even where two solutions meet. What is far from closing
    is first taken near by the ordinary method, or is none.
    """
    longest = lengths.max()
    worst = _worst(base, platform, lengths, poses)
    poses = _approached(base, platform, lengths, poses, worst > NEAR * longest)
    near = np.flatnonzero(_worst(base, platform, lengths, poses) < NEAR * longest)
    position, rotation = poses.position.copy(), poses.rotation.copy()
    closed = np.zeros(len(worst), dtype=np.bool_)
    for _ in range(MOST_ITERATIONS):
        at = Pose(position[near], rotation[near])
        error = lengths - np.linalg.norm(rods(base, platform, at), axis=-1)
        misses = np.abs(error).max(axis=-1, initial=0.0)
        closed[near] = misses < TOLERANCE * longest
        if np.all(misses < ROUNDING * longest):
            break
        inverse = np.linalg.pinv(leg_jacobian(base, platform, at), rcond=1e-12)
        at = at.moved(np.einsum('mij,mj->mi', inverse, error))
        position[near], rotation[near] = at.position, at.rotation
    return Pose(position, rotation), closed


def _worst(base: Array, platform: Array, lengths: Array, poses: Pose) -> Array:
    """By how much the worst rod of each pose (m,) misses its length, in metres."""
    error = lengths - np.linalg.norm(rods(base, platform, poses), axis=-1)
    worst: Array = np.abs(error).max(axis=-1, initial=0.0)
    return worst


def _approached(base: Array, platform: Array, lengths: Array, poses: Pose, far: Mask) -> Pose:
    """The poses, of which those that are `far` by the kernel's Newton's method."""
    position, rotation = poses.position.copy(), poses.rotation.copy()
    count = int(far.sum())
    found = np.empty((count, 3)), np.empty((count, 3, 3)), np.empty((count, 5))
    _kernel.forward_by_lengths(
        frozen(platform), rules(1.0, None, 0.0), stretched(base, (count, 6, 3)),
        stretched(lengths, (count, 6)), position[far], rotation[far], *found,
    )  # fmt: skip
    position[far], rotation[far] = found[0], found[1]
    return Pose(np.nan_to_num(position), np.where(np.isfinite(rotation), rotation, 0.0))


def _distinct(
    base: Array, platform: Array, poses: Pose
) -> tuple[tuple[Pose, ...], tuple[float, ...]]:
    """Each pose once, sorted, with its σmin."""
    size = float(np.sqrt(np.mean(np.sum((platform - platform.mean(axis=0)) ** 2, axis=1))))
    angle = np.linalg.norm(so3.log(poses.rotation), axis=-1)
    keys = np.column_stack([-poses.position[:, 2], -poses.position[:, 0], -poses.position[:, 1]])
    order = np.lexsort([angle, *np.round(keys.T[::-1] / (SAME * size))])
    apart = np.abs(poses.position[:, None] - poses.position).max(axis=-1) / size
    apart += np.abs(poses.rotation[:, None] - poses.rotation).max(axis=(-1, -2))
    chosen: list[int] = []
    for k in order.tolist():
        if (apart[k, chosen] > SAME).all():
            chosen.append(k)
    kept = poses[chosen]
    sigma = smallest_singular_value(leg_jacobian(base, platform, kept), size)
    return tuple(kept[k] for k in range(len(chosen))), tuple(float(s) for s in sigma)


def _fixed_directions() -> tuple[Complex, Array]:
    """A complex direction on which no real e is small, and a real one to tell solutions apart."""
    normal = np.random.default_rng(2).normal(size=(3, 4))
    return normal[0] + 1j * normal[1], normal[2]


_DIRECTION = _fixed_directions()
