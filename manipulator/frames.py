"""The user's frames: a work frame on the base, a pivot or a tool on the platform."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.config import NAME, NAME_RULE, PLACE_MM, TURN_DEG, key, quantity
from manipulator.errors import ConfigError, InvalidInput
from manipulator.formatting import shown
from manipulator.pose import Pose

ORIGIN = (0.0, 0.0, 0.0)
NO_TOOL = ''
"""In place of a tool's name: the pivot has the platform's axes."""


@dataclass(frozen=True)
class FramesConfig:
    """The `frames` section of a machine file: where the work frame and the pivot are."""

    work_xyz_mm: tuple[float, float, float] = quantity(
        *PLACE_MM, 'origin of the work frame, base frame', default=ORIGIN
    )
    work_rpy_deg: tuple[float, float, float] = quantity(
        *TURN_DEG, 'its roll, pitch and yaw', default=ORIGIN
    )
    pivot_xyz_mm: tuple[float, float, float] = quantity(
        *PLACE_MM, 'the tool point, platform frame; of a machine without `tools`', default=ORIGIN
    )


@dataclass(frozen=True)
class ToolConfig:
    """An entry of the section `tools` of a machine file; the first tool is in force at start."""

    name: str = key(f'of the tool: {NAME_RULE}')
    xyz_mm: tuple[float, float, float] = quantity(*PLACE_MM, 'its point, platform frame')
    rpy_deg: tuple[float, float, float] = quantity(
        *TURN_DEG, 'roll, pitch and yaw of its axes', default=ORIGIN
    )
    mass_g: float = quantity(
        0, 1e9, 'with what it holds; beside the payload of `dynamics`', default=0.0
    )
    centre_mm: tuple[float, float, float] | None = quantity(
        *PLACE_MM, 'of mass, platform frame; else half-way to its point', default=None
    )

    def __post_init__(self) -> None:
        """Raises ConfigError for what is no name."""
        if NAME.fullmatch(self.name) is None:
            raise ConfigError([f'name: {shown(self.name)} is not a name of a tool: {NAME_RULE}'])

    @property
    def load(self) -> tuple[float, float, float, float]:
        """Its mass (g), and the centre of that (mm, platform frame); zeros without mass."""
        x, y, z = self.centre_mm or [0.5 * c for c in self.xyz_mm]
        return (self.mass_g, x, y, z) if self.mass_g > 0.0 else (0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class Tool:
    """A tool by name, its frame on the platform, and its load as in `ToolConfig`."""

    name: str
    T_platform_tool: Pose
    load: tuple[float, float, float, float]

    @classmethod
    def from_config(cls, config: ToolConfig) -> 'Tool':
        """In metres and radians."""
        position, turn = 1e-3 * np.array(config.xyz_mm), np.radians(config.rpy_deg)
        return cls(config.name, Pose.from_xyz_rpy(position, turn), config.load)


@dataclass(frozen=True, eq=False)
class Frames:
    """T_base_work, and T_platform_pivot: the frame of the tool in force, or a point.

    tools: those that can be chosen; tool: the name of the one in force, NO_TOOL where the pivot is
    a point with the platform's axes. is_load_fixed: only tools of the first one's load can be
    chosen, because the static deflection under that one is compensated. are_plain: work is base
    and the pivot is the platform's frame. arm (3,): from the platform's origin to the pivot, in
    the pivot's axes.
    """

    T_base_work: Pose = field(default_factory=Pose.identity)
    T_platform_pivot: Pose = field(default_factory=Pose.identity)
    tools: tuple[Tool, ...] = ()
    tool: str = NO_TOOL
    is_load_fixed: bool = False
    are_plain: bool = field(init=False)
    arm: Array = field(init=False)

    def __post_init__(self) -> None:
        """Finds once whether there is anything to convert."""
        both = (self.T_base_work, self.T_platform_pivot)
        offsets = [Pose.identity().twist_to(pose) for pose in both]
        object.__setattr__(self, 'are_plain', not np.any(offsets))
        object.__setattr__(self, 'arm', frozen(-self.T_platform_pivot.inverse().position))

    @classmethod
    def from_config(cls, config: FramesConfig, tools: Sequence[ToolConfig] = ()) -> 'Frames':
        """In metres and radians; ConfigError for tools of one name, or a pivot beside them."""
        work = Pose.from_xyz_rpy(
            np.array(config.work_xyz_mm) * 1e-3, np.radians(config.work_rpy_deg)
        )
        frames = cls(work, tools=tuple(map(Tool.from_config, tools)))
        if not tools:
            return frames.with_pivot([1e-3 * c for c in config.pivot_xyz_mm])
        names = [tool.name for tool in tools]
        problems = [
            f'tools[{i}].name: {name!r} is the name of tools[{names.index(name)}]'
            for i, name in enumerate(names)
            if names.index(name) < i
        ]
        if any(config.pivot_xyz_mm):
            problems.append('frames.pivot_xyz_mm: without a use beside tools, which have points')
        if problems:
            raise ConfigError(problems)
        return frames.with_tool(names[0])

    def with_pivot(self, point: Sequence[float]) -> 'Frames':
        """Another pivot, platform frame, metres; InvalidInput where it is not finite."""
        position = np.array(point, dtype=np.float64)
        if not np.isfinite(position).all():
            raise InvalidInput(f'pivot {position.tolist()} is not finite')
        return replace(self, T_platform_pivot=Pose(position, np.eye(3)), tool=NO_TOOL)

    def with_tool(self, name: str) -> 'Frames':
        """Another tool in force, NO_TOOL: none, the platform's own frame.

        InvalidInput for a name that no tool has, or that of one whose load is not compensated.
        """
        if name == NO_TOOL:
            return self.with_pivot(ORIGIN)
        for tool in self.tools:
            if tool.name == name:
                self._check_load(tool)
                return replace(self, T_platform_pivot=tool.T_platform_tool, tool=name)
        known = ', '.join(tool.name for tool in self.tools) or 'none'
        raise InvalidInput(f'no tool is called {shown(name)} (of this machine: {known})')

    def _check_load(self, tool: Tool) -> None:
        first = self.tools[0]
        if self.is_load_fixed and tool.load != first.load:
            mass, *centre = tool.load
            raise InvalidInput(
                f'tool {tool.name!r} has {mass:g} g at {centre} mm, and dynamics.compensation is '
                f'for {first.name!r}, {first.load[0]:g} g at {list(first.load[1:])} mm: list it '
                'first, and start again'
            )

    def platform(self, T_work_pivot: Pose) -> Pose:
        """T_base_platform when the pivot is there."""
        if self.are_plain:
            return T_work_pivot
        return self.T_base_work @ T_work_pivot @ self.T_platform_pivot.inverse()

    def pivot(self, T_base_platform: Pose) -> Pose:
        """T_work_pivot when the platform is there."""
        if self.are_plain:
            return T_base_platform
        return self.T_base_work.inverse() @ T_base_platform @ self.T_platform_pivot
