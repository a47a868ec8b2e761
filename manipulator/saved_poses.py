"""Poses that a user has taught, by name, and sequences of them: the text of a YAML file.

The file (docs/teach.md) has the sections `poses` and `sequences`. Poses are those of the platform
or tool in the base frame. A change rewrites the section `poses` alone: comments on lines of their
own and the sequences stay as the user wrote them.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import yaml

from manipulator.arrays import Array, frozen
from manipulator.config import NAME, NAME_RULE, build, parse_yaml, quantity
from manipulator.errors import ConfigError, InvalidInput
from manipulator.formatting import shown
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.yaml_edit import flow_list, with_section

MOST_POSES = 300
"""As many as a machine file's length allows."""
MOST_STEPS = 1000
PER_UNIT = {'rad': ('deg', 180.0 / np.pi), 'm': ('mm', 1e3)}
"""Units of the file by those of the joints, and how many make one."""
DIGITS = 6
"""Of mm and °: a millionth, far below what any servo resolves."""


@dataclass(frozen=True, eq=False)
class SavedPose:
    """A pose in the base frame, and the joints (n,) that took it, rad or m; None: not known."""

    pose: Pose
    joints: Array | None = None


@dataclass(frozen=True)
class Step:
    """One step of a sequence: to a saved pose, at a speed (None: the machine's), then a pause."""

    pose: str
    speed_mm_s: float | None = quantity(0.01, 10_000.0, default=None)
    pause_s: float = quantity(0.0, 3600.0, default=0.0)

    @property
    def speed(self) -> float | None:
        """m/s."""
        return None if self.speed_mm_s is None else self.speed_mm_s / 1e3


@dataclass(frozen=True)
class _Entry:
    xyz_mm: tuple[float, float, float] = quantity(-1e5, 1e5)
    rpy_deg: tuple[float, float, float] = quantity(-360.0, 360.0)
    joints_deg: tuple[float, ...] | None = quantity(-1e5, 1e5, default=None)
    joints_mm: tuple[float, ...] | None = quantity(-1e5, 1e5, default=None)


@dataclass(frozen=True)
class _Sections:
    poses: dict[str, Any] | None = None
    sequences: dict[str, Any] | None = None


@dataclass(frozen=True, eq=False)
class SavedPoses:
    """What a file of saved poses holds, and its text; a value: changes make another one."""

    joint_names: tuple[str, ...]
    joint_unit: str
    poses: Mapping[str, SavedPose] = field(default_factory=dict)
    sequences: Mapping[str, tuple[Step, ...]] = field(default_factory=dict)
    text: str = ''

    @classmethod
    def none_of(cls, machine: Machine) -> 'SavedPoses':
        """Of a machine without a file."""
        kinematics = machine.kinematics
        text = '# Saved poses of the platform or tool in the base frame: docs/teach.md\nposes:\n'
        return cls(kinematics.joint_names, kinematics.joint_unit, text=text)

    def read(self, text: str, source: str = '') -> 'SavedPoses':
        """What a text holds for the same machine; ConfigError lists all that is wrong."""
        sections = build(_Sections, parse_yaml(text, source), source=source)
        problems: list[str] = []
        poses = {}
        for name, entry in (sections.poses or {}).items():
            with _collected(problems, f'poses.{name}'):
                poses[checked_name(name)] = self._saved(build(_Entry, entry))
        sequences = {}
        for name, steps in (sections.sequences or {}).items():
            with _collected(problems, f'sequences.{name}'):
                sequences[checked_name(name)] = _steps(steps, poses)
        if len(poses) > MOST_POSES:
            problems.append(f'poses: {len(poses)}, at most {MOST_POSES}')
        if problems:
            raise ConfigError(problems, source)
        return replace(self, poses=poses, sequences=sequences, text=text)

    def with_pose(self, name: str, saved: SavedPose) -> 'SavedPoses':
        """With a pose under a name, also in place of another; InvalidInput for a bad name."""
        checked_name(name)
        poses = {**self.poses, name: saved}
        if len(poses) > MOST_POSES:
            raise InvalidInput(f'{MOST_POSES} poses are saved already: delete one first')
        return self._with(poses)

    def without(self, name: str) -> 'SavedPoses':
        """Without the pose of a name; InvalidInput where there is none, or a sequence needs it."""
        self.of(name)
        users = [key for key, steps in self.sequences.items() if name in {s.pose for s in steps}]
        if users:
            raise InvalidInput(f'{name} is a step of the sequence {users[0]}')
        return self._with({key: saved for key, saved in self.poses.items() if key != name})

    def of(self, name: str) -> SavedPose:
        """The pose of a name; InvalidInput names those that there are."""
        if checked_name(name) not in self.poses:
            known = ', '.join(self.poses) or 'none'
            raise InvalidInput(f'no saved pose is called {shown(name)} (there are: {known})')
        return self.poses[name]

    def steps(self, names: Sequence[str]) -> tuple[Step, ...]:
        """What names of sequences and poses mean, one after the other; InvalidInput as `of`."""
        found: list[Step] = []
        for name in map(checked_name, names):
            if name in self.sequences:
                found += self.sequences[name]
            else:
                self.of(name)
                found.append(Step(name))
        return tuple(found)

    def free_name(self) -> str:
        """pose_1, or the first of its kind that is free."""
        numbers = range(1, len(self.poses) + 2)
        return next(name for k in numbers if (name := f'pose_{k}') not in self.poses)

    def _with(self, poses: Mapping[str, SavedPose]) -> 'SavedPoses':
        lines = [f'  {_key(name)}: {self._line(saved)}' for name, saved in poses.items()]
        text = self.text if self.text.endswith('\n') else f'{self.text}\n'
        if re.search(r'^poses\s*:', text, re.MULTILINE) is None:
            text = f'{text}poses:\n'
        return replace(self, poses=dict(poses), text=with_section(text, 'poses', lines))

    def _line(self, saved: SavedPose) -> str:
        unit, scale = PER_UNIT[self.joint_unit]
        xyz = flow_list(1e3 * saved.pose.position, DIGITS)
        rpy = flow_list(np.degrees(saved.pose.rpy), DIGITS)
        entry = f'xyz_mm: {xyz}, rpy_deg: {rpy}'
        if saved.joints is not None:
            entry += f', joints_{unit}: {flow_list(scale * saved.joints, DIGITS)}'
        return f'{{{entry}}}'

    def _saved(self, entry: _Entry) -> SavedPose:
        unit, scale = PER_UNIT[self.joint_unit]
        joints = getattr(entry, f'joints_{unit}')
        if joints is None and (entry.joints_deg or entry.joints_mm):
            raise ConfigError([f'the joints need the key joints_{unit}'])
        if joints is not None and len(joints) != len(self.joint_names):
            raise ConfigError([f'joints_{unit}: needs {len(self.joint_names)} numbers'])
        position = np.asarray(entry.xyz_mm) / 1e3
        pose = Pose.from_xyz_rpy(position, np.radians(entry.rpy_deg))
        return SavedPose(pose, None if joints is None else frozen(np.asarray(joints) / scale))


def checked_name(name: object) -> str:
    """The name of a pose or a sequence; InvalidInput says what one is made of."""
    if not isinstance(name, str) or NAME.fullmatch(name) is None:
        raise InvalidInput(f'{shown(name)} is not a name of a pose: {NAME_RULE}')
    return name


def _steps(steps: object, poses: Mapping[str, SavedPose]) -> tuple[Step, ...]:
    if not isinstance(steps, list) or not 0 < len(steps) <= MOST_STEPS:
        raise InvalidInput(f'needs a list of 1 to {MOST_STEPS} steps')
    found = tuple(
        build(Step, {'pose': step} if isinstance(step, str) else step, f'[{i}]')
        for i, step in enumerate(steps)
    )
    for i, step in enumerate(found):
        if step.pose not in poses:
            raise InvalidInput(f'[{i}].pose: no saved pose is called {shown(step.pose)}')
    return found


def _key(name: str) -> str:
    """The name as a YAML key: quoted where it would be read as something else, as in `yes`."""
    return yaml.safe_dump(name, allow_unicode=True).split('\n')[0]


@contextmanager
def _collected(problems: list[str], where: str) -> Iterator[None]:
    """Collects what is wrong in one entry, so that all problems are reported at once."""
    try:
        yield
    except ConfigError as error:
        problems += [f'{where}: {problem}' for problem in error.problems]
    except InvalidInput as error:
        problems.append(f'{where}: {error}')
