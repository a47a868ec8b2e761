"""A machine as the nodes use it: its kinematics, its limits, its jogger."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Generic, Literal, TypeVar, cast

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.config import build_both, key
from manipulator.errors import ConfigError, InvalidInput
from manipulator.frames import Frames, FramesConfig, Tool, ToolConfig
from manipulator.kinematics import Kinematics
from manipulator.limits.clearance import Clearance, ClearGroup
from manipulator.limits.constraints import Constraints
from manipulator.limits.limit import LimitOf
from manipulator.limits.machine_limits import JointRange
from manipulator.limits.surroundings import Bodies, BodiesConfig, Obstacle, SurroundingsConfig
from manipulator.limits.task_space import TaskSpaceConfig
from manipulator.limits.wording import in_words
from manipulator.motion_limits import MotionConfig, MotionLimits
from manipulator.static_deflection import StaticDeflection
from manipulator.teleop.jogger import Jogger
from manipulator.unit_hints import out_of_proportion

JOG_SINGULARITIES = ('stop', 'slide')
T = TypeVar('T')


@dataclass(frozen=True)
class MachineFile:
    """The sections of a machine file; each package checks its own against its own schema.

    geometry and limits belong to the kind of machine, servos, link and simulation to the bridge,
    dynamics to hexarm/simulation/. driver: what moves the joints, a board on a serial line
    (sections servos and link) or other software, by topics (neither).
    """

    kind: str = key('of machine')
    geometry: dict[str, Any] = key('where the joints are')
    limits: dict[str, Any] = key('what the machine may not exceed')
    motion: MotionConfig = key('how fast it may move (docs/motion.md)')
    driver: Literal['serial', 'topic'] = key(
        'what moves the joints: a board on a serial line, or other software (docs/your-arm.md)',
        default='serial',
    )
    servos: dict[str, Any] = key(
        'its servos, and the pulses for their positions; only with driver: serial',
        default_factory=dict,
    )
    link: dict[str, Any] = key(
        'the serial line to the board; only with driver: serial', default_factory=dict
    )
    description: str = key('one line, for lists', default='')
    simulation: dict[str, Any] | None = key(
        "what the fake board's servos and battery do", default=None
    )
    dynamics: dict[str, Any] | None = key('masses and drives (docs/physics.md)', default=None)
    frames: FramesConfig = key("the user's frames", default_factory=FramesConfig)
    tools: tuple[ToolConfig, ...] = key(
        'that can be on platform or arm, the first at start (docs/tools.md)', default=()
    )
    task_space: TaskSpaceConfig = key(
        'limits on position, orientation and speed of platform or tool',
        default_factory=TaskSpaceConfig,
    )
    surroundings: SurroundingsConfig = key(
        'what it may not meet: floor, boxes, the sides of a workspace',
        default_factory=SurroundingsConfig,
    )
    bodies: BodiesConfig = key(
        'how thick its parts are, which then may not meet each other',
        default_factory=BodiesConfig,
    )

    def __post_init__(self) -> None:
        """Raises ConfigError for sections of the bridge that are missing, or without a use."""
        parts = {'servos': self.servos, 'link': self.link}
        if self.driver == 'serial':
            problems = [f'{name}: missing' for name, part in parts.items() if not part]
        else:
            parts['simulation'] = self.simulation or {}
            unused = [name for name, part in parts.items() if part]
            problems = [f'{name}: without a use, driver: topic has no board' for name in unused]
        if problems:
            raise ConfigError(problems)


@dataclass(frozen=True)
class Kind(Generic[T]):
    """A kind of machine: the schemas of its sections geometry and limits, and what makes it.

    geometry may be a union of forms; make takes both sections as built by the schemas. screen
    raises ConfigError for sections whose other faults need not be listed.
    """

    geometry: Any
    limits: type
    make: Callable[[Any, Any], T]
    screen: Callable[[Mapping[str, Any], Mapping[str, Any]], None] = lambda geometry, limits: None

    def build(self, machine_file: MachineFile) -> T:
        """What a file of this kind makes; ConfigError with all problems of both sections."""
        self.screen(machine_file.geometry, machine_file.limits)
        sections: tuple[Any, Any] = build_both(
            (self.geometry, machine_file.geometry, 'geometry'),
            (self.limits, machine_file.limits, 'limits'),
        )
        doubts = out_of_proportion(*sections)
        if doubts:
            raise ConfigError(doubts)
        return self.make(*sections)


@dataclass(frozen=True)
class Machine:
    """What the nodes trajectory, ik and pose need to know of a machine.

    frames are those that its user works in; kinematics and constraints are in the base frame,
    unless the machine was made by `in_frames`. make_jogger makes the jogger of this machine, or of
    the same in other frames. deflection: of the drives under load, where it is to be compensated.
    park (n,) are the joints at which the servos are switched on and off, None where the file has
    no usable servos. resolution (n,): the steps in which joints are commanded and reported, None
    likewise. jog_singularity: one of JOG_SINGULARITIES. make_bodies: its parts as capsules;
    obstacles: what they may not meet.
    """

    kinematics: Kinematics
    constraints: Constraints
    motion: MotionLimits
    make_jogger: 'Callable[[Machine], Jogger]'
    frames: Frames = field(default_factory=Frames)
    deflection: StaticDeflection | None = None
    park: Array | None = None
    resolution: Array | None = None
    jog_singularity: str = JOG_SINGULARITIES[0]
    make_bodies: 'Callable[[BodiesConfig], Bodies] | None' = None
    obstacles: tuple[Obstacle, ...] = ()

    def __post_init__(self) -> None:
        """Raises InvalidInput for an unknown jog_singularity."""
        if self.jog_singularity not in JOG_SINGULARITIES:
            known = ' or '.join(map(repr, JOG_SINGULARITIES))
            raise InvalidInput(f'jog_singularity is {self.jog_singularity!r}, needs {known}')

    def within(self, task_space: TaskSpaceConfig) -> 'Machine':
        """With limits in task space as well; ConfigError names each beyond which home is."""
        kinematics, constraints = self.kinematics, self.constraints
        group = constraints.checks[0][0] if constraints.is_one_group else None
        try:
            added = task_space.limits(kinematics.home, group)
        except ConfigError as error:
            raise ConfigError([f'task_space.{problem}' for problem in error.problems]) from error
        at_home = kinematics.home, kinematics.inverse(kinematics.home)
        beyond = in_words(Constraints(added).violations(*at_home) if added else [])
        if beyond:
            raise ConfigError([f'task_space: home has {words}' for words in beyond])
        return replace(
            self,
            constraints=Constraints((*constraints.limits, *added)),
            motion=replace(self.motion, axis_speeds=task_space.speeds),
        )

    def among(
        self, surroundings: SurroundingsConfig, bodies: BodiesConfig, tools: Sequence[Tool] = ()
    ) -> 'Machine':
        """With clearances as limits as well; ConfigError names all that meets at home.

        The first of the tools is on it there; it holds none until `holding`.
        """
        obstacles = surroundings.obstacles()
        if not obstacles and bodies == BodiesConfig():
            return self
        if self.make_bodies is None:
            raise ConfigError(['surroundings, bodies: not known of this kind of machine'])
        tips = [tool.T_platform_tool.position for tool in tools]
        clearance = Clearance(self.make_bodies(bodies), obstacles, tips[0] if tips else None)
        kinematics = self.kinematics
        found = Constraints((clearance,)).violations(
            kinematics.home, kinematics.inverse(kinematics.home)
        )
        if found:
            raise ConfigError([f'home: {words}' for words in in_words(found)])
        if tips:
            clearance = replace(clearance, tip=frozen(np.zeros(3)))
        return replace(self, constraints=self._with_clearance(clearance), obstacles=obstacles)

    def holding(self, tip: Array) -> 'Machine':
        """With the point (3,) of the tool in force, platform frame, where clearances count it."""
        clearance = self.constraints.limits[-1] if self.constraints.limits else None
        if not isinstance(clearance, Clearance) or clearance.tip is None:
            return self
        limits = self.constraints.limits[:-1]
        if isinstance(clearance.group, ClearGroup):
            inner = clearance.group.inner
            limits = tuple(replace(cast(Any, limit), group=inner) for limit in limits)
        bare = replace(self, constraints=Constraints(limits))
        held = replace(clearance, tip=frozen(tip), group=None, columns=slice(0))
        return replace(self, constraints=bare._with_clearance(held))

    def _with_clearance(self, clearance: Clearance) -> Constraints:
        """In the group of all other limits, where there is one."""
        limits = self.constraints.limits
        if not clearance.owners:
            return self.constraints
        if not self.constraints.is_one_group:
            return Constraints((*limits, clearance))
        group = ClearGroup(self.constraints.checks[0][0], clearance, self.kinematics)
        own = [replace(cast(Any, limit), group=group) for limit in limits]
        return Constraints((*own, replace(clearance, group=group, columns=group.columns)))

    @property
    def joint_ranges(self) -> tuple[Array, Array]:
        """Where each joint's travel begins and ends, (n,) each; ±∞ where it has no end."""
        count = len(self.kinematics.joint_names)
        low, high = np.full(count, -np.inf), np.full(count, np.inf)
        for limit in self.constraints.limits:
            inner = limit.inner if isinstance(limit, LimitOf) else limit
            if isinstance(inner, JointRange):
                low, high = np.maximum(low, inner.low), np.minimum(high, inner.high)
        return low, high
