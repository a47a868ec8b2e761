"""Inverse of any chain by elimination and damped Newton steps (docs/arm-kinematics.md, 6).

A calibrated arm, built almost as one with a closed form, starts at that one's branches. The search
is in kernel/arm.c. Here an arm is prepared for it: loops to eliminate, mirrored joints, ideal
axes.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from arm_control.chain import JOINTS, Chain, aligned, flat, in_parts
from arm_control.closed_forms import MOST_LOOPS, NO_LOOP, ClosedForm, arm_numbers
from manipulator import _kernel
from manipulator.arrays import Array
from manipulator.pose import Pose

STARTS = 33
"""From which damped steps look for a pose that is refused: kernel/arm.c."""

MOST_BRANCHES = 16
"""Of any arm with six joints."""


@dataclass(frozen=True, eq=False)
class Numerical:
    """Elimination (section 6.1), refined by Levenberg–Marquardt steps (6.2).

    length (m) scales metres against radians; low and high (6,), rad, are the joint ranges, over
    which the starts of an arm without elimination are spread. loops, general and numbers are what
    the kernel needs: the loops of the elimination, best first; these with `mirror` and the chain
    that is eliminated; `struct arm`.
    """

    chain: Chain
    length: float
    low: Array
    high: Array
    loops: tuple[int, ...] = field(init=False)
    general: Array = field(init=False, repr=False)
    numbers: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Prepares what the kernel is given."""
        solved, loops = eliminated(self.chain, self.length)
        general = np.array([*loops, *mirror(self.chain, self.length), *solved.numbers])
        numbers = arm_numbers(self.chain, None, self.length, self.low, self.high, general)
        object.__setattr__(self, 'loops', loops)
        object.__setattr__(self, 'general', general)
        object.__setattr__(self, 'numbers', numbers)

    @property
    def is_explicit(self) -> bool:
        """See `InverseMethod`."""
        return False

    @property
    def form(self) -> None:
        """See `InverseMethod`."""
        return None

    def arm_numbers(self, length: float, low: Array, high: Array) -> Array:
        """See `InverseMethod`."""
        return self.numbers

    def branches(self, pose: Pose, near: Array) -> Array:
        """What was found from `near`, which comes first, and by elimination: (..., 16, 6).

        NaN rows follow. Next to a singularity a branch may be missed.
        """
        return arm_branches(self.numbers, pose, near)[0]

    def refusal(self, pose: Pose) -> str:
        """How near the best attempt came."""
        miss = np.empty(6)
        _kernel.arm_miss(self.numbers, pose.position, pose.rotation, miss)
        distance, angle = np.linalg.norm(miss[:3]), np.degrees(np.linalg.norm(miss[3:]))
        return f'no joint angles found: the best of {STARTS} starts missed by ' + (
            f'{distance:.4g} m and {angle:.3g}°'
        )


@dataclass(frozen=True, eq=False)
class AlmostClosed:
    """From `near` and the eight branches of the ideal arm by damped steps, then by elimination.

    docs/arm-kinematics.md, 6.4.
    """

    ideal: ClosedForm
    numerical: Numerical
    numbers: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Prepares what the kernel is given."""
        own = self.numerical
        numbers = arm_numbers(own.chain, self.ideal, own.length, own.low, own.high, own.general)
        object.__setattr__(self, 'numbers', numbers)

    @property
    def is_explicit(self) -> bool:
        """See `InverseMethod`."""
        return False

    @property
    def form(self) -> ClosedForm:
        """See `InverseMethod`."""
        return self.ideal

    def arm_numbers(self, length: float, low: Array, high: Array) -> Array:
        """See `InverseMethod`."""
        return self.numbers

    def branches(self, pose: Pose, near: Array) -> Array:
        """All that were found, by whole turns nearest to `near`, then NaN rows: (..., 16, 6)."""
        return arm_branches(self.numbers, pose, near)[0]

    def refusal(self, pose: Pose) -> str:
        """Which triangle of the ideal arm does not close, or how near the real one comes."""
        is_out_of_reach = np.isnan(self.ideal.branches(pose, np.zeros(JOINTS))).all()
        return (self.ideal if is_out_of_reach else self.numerical).refusal(pose)


def arm_branches(numbers: Array, pose: Pose, near: Array) -> tuple[Array, int]:
    """All branches (..., 16, 6) of an arm, by whole turns nearest to `near` within its ranges.

    And how many of the joints to be near to are not finite.
    """
    start = np.ascontiguousarray(near, np.float64)
    if start.ndim == 1 and pose.position.ndim == 1:
        found = np.empty((MOST_BRANCHES, JOINTS))
        return found, _kernel.arm_branches(numbers, pose.position, pose.rotation, start, found)
    poses = aligned(pose, start)
    found = np.empty((*poses[-1].shape[:-1], MOST_BRANCHES, JOINTS))
    rows = found.reshape(-1, MOST_BRANCHES, JOINTS)
    return found, in_parts(_kernel.arm_branches, numbers, *flat(poses), rows)


TRIED = 48
"""Postures on which each loop of an elimination is tried."""

LOOPS, CANDIDATES = 12, 48
"""Loops that an arm has, and candidates of one: kernel/elimination.h and general.h."""

ROUNDING, ACCURATE, USEFUL = 1e-9, 1e-6, 0.03
"""Radians from a posture at which a candidate is as good as exact, and at which an accurate and a
useful loop have their candidates, in the geometric mean."""

ASIDE = 1e-4
"""Of an arm's length: how far axes are moved aside where no loop has a use."""


def eliminated(chain: Chain, length: float) -> tuple[Chain, tuple[int, ...]]:
    """The chain, or almost, and its loops.

    Of some arms, as one with no offset but between axes 4 and 6, every determinant is 0. With its
    axes a little aside it is not; from there the damped steps lead back.
    """
    loops = best_loops(chain, chain, length)
    if loops[0] != NO_LOOP:
        return chain, loops
    moved = np.random.default_rng(0).uniform(-ASIDE, ASIDE, (JOINTS, 3)) * length
    aside = Chain(chain.axes, chain.points + moved, chain.home)
    return aside, best_loops(chain, aside, length)


def best_loops(chain: Chain, solved: Chain, length: float) -> tuple[int, ...]:
    """The loops that have their candidates nearest, best first; NO_LOOP where none has a use.

    Which determinant tells an arm's branches depends on which of its axes are parallel or meet. Of
    those that do, the one is best that is certain most often: where two branches always share
    an angle, it never is. The second loop solves for another joint than the first: branches that
    have almost the same angle there, which hides them, have others here.
    """
    joints = np.random.default_rng(0).uniform(-np.pi, np.pi, (TRIED, JOINTS))
    poses, missed, certain = chain.forward(joints), np.empty(LOOPS), np.empty(LOOPS)
    for loop in range(LOOPS):
        found, how = np.empty((TRIED, CANDIDATES, JOINTS)), np.array([length, loop])
        certain[loop] = _kernel.general_candidates(
            solved.numbers, how, poses.position, poses.rotation, found
        )
        apart = np.abs(np.exp(1j * found) - np.exp(1j * joints)[:, None]).max(axis=-1)
        nearest = np.nan_to_num(apart, nan=np.inf).min(axis=-1).clip(ROUNDING, 1.0)
        missed[loop] = np.exp(np.log(nearest).mean())
    order = np.lexsort((missed, -certain, missed > ACCURATE))
    useful = [int(loop) for loop in order if missed[loop] < USEFUL]
    useful[1:] = sorted(useful[1:], key=lambda loop: solved_joint(loop) == solved_joint(useful[0]))
    return tuple([*useful, *[NO_LOOP] * MOST_LOOPS][:MOST_LOOPS])


def solved_joint(loop: int) -> int:
    """The joint, 0 to 5, whose angle a loop's determinant tells."""
    return (loop + 2) % JOINTS if loop < JOINTS else JOINTS - 1 - (loop + 2) % JOINTS


ALMOST_MIRRORED = 0.01
"""Of the size of an arm, and radians: how far a branch's image may be from the pose."""


def mirror(chain: Chain, length: float) -> tuple[float, float, float]:
    """The first of four joints that mirror branches, and two sums of angles: `struct mirror`.

    Without an offset at the shoulder or the elbow, half a turn of the first, and of the fourth, is
    the mirror image of the two between, whose axes are parallel. NO_LOOP where there is none.
    """
    joints = np.random.default_rng(0).uniform(-np.pi, np.pi, (1, JOINTS))
    for first in range(JOINTS - 3):
        upright, hinge, elbow, forearm = chain.axes[first : first + 4]
        arm = chain.points[first + 2] - chain.points[first + 1]
        angles = _angle(hinge, arm, upright), _angle(elbow, forearm, arm)
        sums = 2.0 * np.array(angles)
        image = joints.copy()
        image[0, [first, first + 3]] += np.pi
        image[0, first + 1 : first + 3] = sums - joints[0, first + 1 : first + 3]
        missed = chain.forward(image).twist_to(chain.forward(joints)) / ([length] * 3 + [1.0] * 3)
        if np.abs(missed).max() < ALMOST_MIRRORED:
            return float(first), *sums.tolist()
    return NO_LOOP, 0.0, 0.0


def _angle(axis: Array, start: Array, end: Array) -> float:
    """By which a turn about the axis takes one direction to another, as seen along the axis."""
    across = start - axis * (axis @ start)
    return float(np.arctan2(np.cross(axis, across) @ end, across @ end))


ALMOST_PARALLEL, ALMOST_MEETING = np.radians(5.0), 0.005
"""How far axes may be from parallel (rad), and from meeting in one point (m)."""


def idealised(chain: Chain) -> Iterator[Chain]:
    """The chain with axes made parallel, and made to meet, where they almost are and do."""
    axes, points = chain.axes, chain.points
    for parallel, meeting in (((1, 2), (3, 4, 5)), ((1, 2, 3), (4, 5))):
        common, centre = _common(axes[list(parallel)]), _nearest(axes, points, meeting)
        if common is None or centre is None:
            continue
        directions, places = axes.copy(), points.copy()
        directions[list(parallel)] = np.sign(axes[list(parallel)] @ common)[:, None] * common
        places[list(meeting)] = centre
        yield Chain(directions, places, chain.home)


def _common(axes: Array) -> Array | None:
    """The mean direction (3,) of axes that are almost parallel, whichever way they point."""
    signs = np.sign(axes @ axes[0])
    total: Array = (signs[:, None] * axes).sum(axis=0)
    mean: Array = total / np.linalg.norm(total)
    sines = np.linalg.norm(np.cross(axes, mean), axis=1)
    return mean if sines.max() < np.sin(ALMOST_PARALLEL) else None


def _nearest(axes: Array, points: Array, which: Sequence[int]) -> Array | None:
    """The point (3,) nearest to some axes; None where they pass it too far away."""
    chosen, through = axes[list(which)], points[list(which)]
    across = np.eye(3) - chosen[:, :, None] * chosen[:, None, :]
    offsets = np.einsum('nij,nj->ni', across, through)
    point: Array = np.linalg.lstsq(across.reshape(-1, 3), offsets.ravel(), rcond=None)[0]
    missed = np.linalg.norm(np.einsum('nij,nj->ni', across, point - through), axis=1)
    return point if missed.max() < ALMOST_MEETING else None
