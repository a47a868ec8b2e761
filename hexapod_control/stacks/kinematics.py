"""A stack of platforms as a `Kinematics`: 6n joints, one pose. docs/kinematics.md, 9."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from hexapod_control.geometry import LEGS
from hexapod_control.parallel_platform import ParallelPlatform
from hexapod_control.stacks.stack import FAR, Stack
from manipulator import rotation as so3
from manipulator.arrays import Array
from manipulator.errors import ConfigError, NoSolution, Unreachable
from manipulator.kinematics import ForwardSolution
from manipulator.links import PLATFORM, Link, Stroke
from manipulator.pose import Pose


@dataclass(frozen=True, eq=False)
class StackKinematics:
    """Joints (..., 6n), section by section from the ground up; poses are of the end.

    For one pose there are many sets of joints: `inverse` takes those of the rule that
    `Stack.inverse` states. `forward` takes any.
    """

    stack: Stack
    characteristic_length: float
    platforms: tuple[ParallelPlatform, ...] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Raises ConfigError for a section that is no parallel platform."""
        platforms = [machine.kinematics for machine in self.stack.sections]
        for i, platform in enumerate(platforms, 1):
            if not isinstance(platform, ParallelPlatform):
                raise ConfigError([f'section {i} is a {type(platform).__name__}, no platform'])
        object.__setattr__(self, 'platforms', tuple(platforms))

    @property
    def joint_names(self) -> tuple[str, ...]:
        """As section_2_leg_1."""
        return tuple(
            f'section_{i}_{name}'
            for i, platform in enumerate(self.platforms, 1)
            for name in platform.joint_names
        )

    @property
    def joint_unit(self) -> str:
        """That of all sections."""
        return self.platforms[0].joint_unit

    @property
    def home(self) -> Pose:
        """The end's pose when all sections are at home."""
        return self.stack.home

    @property
    def is_explicit(self) -> bool:
        """The sections are, their shares are found by descent."""
        return False

    @property
    def joins_branches(self) -> bool:
        """As a platform: never."""
        return False

    def inverse(self, pose: Pose, near: Array | None = None) -> Array:
        """See `Kinematics`; the descent starts at the sections of `near`."""
        sections = self._shared(pose, near)
        if np.isnan(sections[-1].position).any():
            raise Unreachable(FAR)
        joints = []
        for i, (platform, at) in enumerate(zip(self.platforms, sections, strict=True), 1):
            try:
                joints.append(platform.inverse(at))
            except Unreachable as error:
                raise Unreachable(f'section {i}: {error}', error.leg) from error
        return np.concatenate(joints, axis=-1)

    def inverse_or_nan(self, pose: Pose, near: Array | None = None) -> Array:
        """As `inverse`, with NaN for each leg that does not close."""
        return self._joints_at(self._shared(pose, near))

    def inverse_along(self, poses: Pose, near: Array) -> Array:
        """See `Kinematics`; where `near` has no sections, each pose is solved from home."""
        start = self.sections_or_nan(np.asarray(near, dtype=np.float64))
        if any(np.isnan(at.position).any() for at in start):
            return self.inverse_or_nan(poses)
        return self._joints_at(self.stack.rule.sections_at(poses, start, is_row=True))

    def forward(self, joints: Array, near: Pose | None = None) -> ForwardSolution:
        """See `Kinematics`; iterations of all sections, the worst residual and margin of one.

        Near a pose the sections start where the rule puts them there.
        """
        given = self._checked(joints)
        starts = None if near is None else self.stack.rule.sections_at(near)
        return self._forward(given, starts)[0]

    def forward_along(self, joints: Array, near: Pose) -> Pose:
        """See `Kinematics`."""
        starts: Sequence[Pose] = self.stack.rule.sections_at(near)
        ends = []
        for row in joints:
            found, starts = self._forward(self._checked(row), starts)
            ends.append(found.pose)
        return Pose(np.array([p.position for p in ends]), np.array([p.rotation for p in ends]))

    def jacobian(self, pose: Pose, joints: Array) -> Array:
        """The end's twist of unit joint rates, (..., 6, 6n); see `Kinematics`."""
        sections = self.sections_of(joints)
        end = self.stack.end_of(sections)
        base, columns = Pose.identity(), []
        for i, (platform, at) in enumerate(zip(self.platforms, sections, strict=True)):
            own = platform.jacobian(at, joints[..., LEGS * i : LEGS * (i + 1)])
            top = base @ at
            turn = base.rotation @ own[..., 3:, :]
            arm = so3.skew(end.position - top.position)
            columns.append(
                np.concatenate([base.rotation @ own[..., :3, :] - arm @ turn, turn], axis=-2)
            )
            base = top @ self.stack.transforms[i]
        return np.concatenate(columns, axis=-1)

    def skeleton(self, pose: Pose, joints: Array) -> tuple[Stroke, ...]:
        """Those of all sections; cranks and rods with the names of their legs."""
        strokes, base = [], Pose.identity()
        for i, at in enumerate(self.sections_of(joints)):
            counts = dict.fromkeys(('crank', 'rod'), 0)
            own = joints[LEGS * i : LEGS * (i + 1)]
            for stroke in self.platforms[i].skeleton(at, own):
                owners: tuple[str, ...] = ()
                if stroke.part in counts:
                    counts[stroke.part] += 1
                    owners = (f'section {i + 1} leg {counts[stroke.part]}',) * len(stroke.points)
                strokes.append(Stroke(stroke.part, base.transform(stroke.points), owners))
            base = base @ at @ self.stack.transforms[i]
        return tuple(strokes)

    def links(self, pose: Pose, joints: Array) -> tuple[Link, ...]:
        """The sections' platforms, section_1 and so on, then the end."""
        links, base = [], Pose.identity()
        for i, at in enumerate(self.sections_of(joints)):
            links.append(Link(f'section_{i + 1}', base @ at))
            base = base @ at @ self.stack.transforms[i]
        return (*links, Link(PLATFORM, pose))

    def sigma_min(self, pose: Pose, joints: Array) -> Array:
        """The least of the sections' margins (...): below 0 of one, the joints fix no end."""
        margins = [
            platform.sigma_min(at, joints[..., LEGS * i : LEGS * (i + 1)])
            for i, (platform, at) in enumerate(
                zip(self.platforms, self.sections_or_nan(joints), strict=True)
            )
        ]
        least: Array = np.min(margins, axis=0)
        return least

    def sections_of(self, joints: Array) -> tuple[Pose, ...]:
        """The sections' poses (...) for joints (..., 6n), found from home.

        Raises NoSolution where a section has none.
        """
        poses = self.sections_or_nan(joints)
        for i, pose in enumerate(poses, 1):
            if np.isnan(pose.position).any():
                raise NoSolution(f'section {i}: forward kinematics found no pose from home')
        return poses

    def sections_or_nan(self, joints: Array) -> tuple[Pose, ...]:
        """As `sections_of`, with NaN for a section that has none."""
        return tuple(
            platform.forward_or_nan(joints[..., LEGS * i : LEGS * (i + 1)], platform.home)
            for i, platform in enumerate(self.platforms)
        )

    def _shared(self, pose: Pose, near: Array | None) -> tuple[Pose, ...]:
        start = None
        if near is not None:
            start = self.sections_or_nan(np.asarray(near, dtype=np.float64))
            if any(np.isnan(at.position).any() for at in start):
                start = None
        return self.stack.rule.sections_at(pose, start)

    def _joints_at(self, sections: Sequence[Pose]) -> Array:
        joints = [
            platform.inverse_or_nan(at)
            for platform, at in zip(self.platforms, sections, strict=True)
        ]
        return np.concatenate(joints, axis=-1)

    def _checked(self, joints: Array) -> Array:
        given = np.asarray(joints, dtype=np.float64)
        shape = (LEGS * len(self.platforms),)
        if given.shape != shape:
            raise NoSolution(f'joints have shape {given.shape}, a pose needs {shape}')
        if not np.isfinite(given).all():
            raise NoSolution(f'joints are not finite: {given.tolist()}')
        return given

    def _forward(
        self, joints: Array, starts: Sequence[Pose] | None
    ) -> tuple[ForwardSolution, tuple[Pose, ...]]:
        found = []
        for i, platform in enumerate(self.platforms):
            own, start = joints[LEGS * i : LEGS * (i + 1)], None if starts is None else starts[i]
            try:
                found.append(platform.forward(own, start))
            except NoSolution as error:
                raise NoSolution(f'section {i + 1}: {error}') from error
        poses = tuple(solution.pose for solution in found)
        whole = ForwardSolution(
            self.stack.end_of(poses),
            sum(solution.iterations for solution in found),
            max(solution.residual for solution in found),
            min(solution.sigma_min for solution in found),
        )
        return whole, poses
