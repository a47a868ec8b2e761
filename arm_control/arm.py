"""The serial arm as a `Kinematics`: six joint angles, one pose of the tool."""

from dataclasses import dataclass, field

import numpy as np

from arm_control.chain import JOINTS, Chain, aligned, flat, in_parts
from arm_control.closed_forms import BRANCHES
from arm_control.inverse_method import InverseMethod, fitting_method
from arm_control.joint_limits import JointLimits
from arm_control.numerical import arm_branches
from manipulator import _kernel
from manipulator.arrays import Array, adjacent, frozen
from manipulator.errors import ConfigError, InvalidInput, NoSolution, Unreachable
from manipulator.kinematics import ForwardSolution
from manipulator.links import PLATFORM, Link, Stroke
from manipulator.pose import Pose


@dataclass(frozen=True, eq=False)
class SerialArm:
    """Kinematics of six revolute joints in radians; the moving frame is the tool's.

    characteristic_length (metres) divides linear velocities in σmin; rest (6,) are the joints at
    home.
    """

    chain: Chain
    limits: JointLimits
    characteristic_length: float
    rest: Array
    home: Pose = field(init=False)
    method: InverseMethod = field(init=False)
    _numbers: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Raises ConfigError when home lies outside the joint ranges."""
        rest = frozen(self.rest)
        outside = np.flatnonzero((rest < self.limits.low) | (rest > self.limits.high))
        if outside.size:
            low, high = np.degrees(self.limits.low), np.degrees(self.limits.high)
            raise ConfigError(
                [
                    f'home_deg[{i}]: {np.degrees(rest[i]):.4g} outside [{low[i]:g}, {high[i]:g}]'
                    for i in outside
                ]
            )
        object.__setattr__(self, 'rest', rest)
        object.__setattr__(self, 'home', self.chain.forward(rest))
        length, low, high = self.characteristic_length, self.limits.low, self.limits.high
        method = fitting_method(self.chain, self.limits, length)
        numbers = method.arm_numbers(length, low, high)
        object.__setattr__(self, 'method', method)
        object.__setattr__(self, '_numbers', numbers)

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Those of the machine file, or joint_1 to joint_6; base first."""
        return self.limits.names

    @property
    def joint_unit(self) -> str:
        """Radians."""
        return 'rad'

    @property
    def joins_branches(self) -> bool:
        """A jog drives from branch to branch where they meet, as with a stretched elbow."""
        return True

    @property
    def is_explicit(self) -> bool:
        """Whether the axes allow a closed form."""
        return self.method.is_explicit

    def inverse_all(self, pose: Pose, near: Array | None = None) -> Array:
        """Every branch (..., k, 6), by whole turns nearest to `near` within the joint ranges.

        NaN rows are branches that do not close. k is 8 where there is a closed form; without one
        it is 16, and a branch may be missing.
        """
        start = self.rest if near is None else self._checked(near, finite=False)
        found, unknown = arm_branches(self._numbers, pose, start)
        if unknown:
            self._checked(start)
        return found[..., :BRANCHES, :] if self.is_explicit else found

    def inverse(self, pose: Pose, near: Array | None = None) -> Array:
        """Joints (..., 6) on the branch nearest to `near` (default: home's joints).

        Branches within the joint ranges come first. Raises Unreachable with what does not reach,
        by how much, where no branch closes.
        """
        joints, lost = self._nearest(pose, near)
        if lost:
            index = tuple(int(i) for i in np.argwhere(np.isnan(joints[..., 0]))[0])
            place = f'pose {list(index)}: ' if index else ''
            raise Unreachable(place + self.method.refusal(pose[index] if index else pose))
        return joints

    def inverse_or_nan(self, pose: Pose, near: Array | None = None) -> Array:
        """As `inverse`, with NaN for poses out of reach."""
        return self._nearest(pose, near)[0]

    def _nearest(self, pose: Pose, near: Array | None) -> tuple[Array, int]:
        """Joints (..., 6), and how many of them are NaN: as all are near what is not finite."""
        start = self.rest if near is None else self._checked(near, finite=False)
        if start.ndim == 1 and pose.position.ndim == 1:
            joints = np.empty(JOINTS)
            lost = _kernel.arm_inverse(self._numbers, pose.position, pose.rotation, start, joints)
        else:
            poses = aligned(pose, start)
            joints = np.empty(poses[-1].shape)
            lost = in_parts(_kernel.arm_inverse, self._numbers, *flat(poses), *flat((joints,)))
        if lost:
            self._checked(start)
        return joints, lost

    def inverse_along(self, poses: Pose, near: Array) -> Array:
        """See `Kinematics`: joints go on beyond their ranges, without turning back by 360°."""
        joints = np.empty((len(poses.position), JOINTS))
        _kernel.arm_along(
            self._numbers, self._checked(near), poses.position, poses.rotation, joints
        )
        return joints

    def forward(self, joints: Array, near: Pose | None = None) -> ForwardSolution:
        """The tool's pose: explicit, so that `near` changes nothing.

        Raises NoSolution unless joints are six finite numbers.
        """
        checked = adjacent(joints)
        if checked.shape != (JOINTS,) or not np.isfinite(checked).all():
            raise NoSolution(f'joints {checked.tolist()} are not six finite angles')
        pose = self.chain.forward(checked)
        return ForwardSolution(pose, 0, 0.0, float(self.sigma_min(pose, checked)))

    def forward_along(self, joints: Array, near: Pose) -> Pose:
        """See `Kinematics`: explicit, so that `near` changes nothing."""
        return self.chain.forward(self._checked(joints))

    def jacobian(self, pose: Pose, joints: Array) -> Array:
        """The tool's twist of unit joint rates (..., 6, 6), from the joints alone.

        It exists in singular postures too, where its rank falls: never raises NoSolution.
        """
        return self.chain.jacobian(self._checked(joints))

    def skeleton(self, pose: Pose, joints: Array) -> tuple[Stroke, ...]:
        """One line from the base through a point of each joint's axis to the tool point."""
        moved = self.chain.displacements(self._checked(joints))[:-1]
        points = np.einsum('nij,nj->ni', moved[:, :3, :3], self.chain.points) + moved[:, :3, 3]
        line = np.vstack([np.zeros(3), points, pose.position])
        return (Stroke('link', line, ('', *self.limits.owners, '')),)

    def links(self, pose: Pose, joints: Array) -> tuple[Link, ...]:
        """link_1 to link_6, each on its joint's axis, with base axes at zero; then the tool."""
        moved = self.chain.displacements(self._checked(joints))[1:]
        points = np.einsum('nij,nj->ni', moved[:, :3, :3], self.chain.points) + moved[:, :3, 3]
        frames = zip(points, moved[:, :3, :3], strict=True)
        links = (Link(f'link_{i}', Pose(p, R)) for i, (p, R) in enumerate(frames, start=1))
        return *links, Link(PLATFORM, pose)

    def sigma_min(self, pose: Pose, joints: Array) -> Array:
        """The smallest singular value (...) of the Jacobian in characteristic lengths."""
        return self.chain.sigma_min(
            self._checked(joints, finite=False), self.characteristic_length
        )

    def _checked(self, joints: Array, finite: bool = True) -> Array:
        array = adjacent(joints)
        if array.shape[-1:] != (JOINTS,):
            raise InvalidInput(f'joints have shape {array.shape}, needs (..., 6)')
        if finite and not np.isfinite(array).all():
            raise InvalidInput(f'joints are not finite: {array.ravel()[:6].tolist()}')
        return array
