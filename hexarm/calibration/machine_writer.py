"""Identified values written to a machine file: only what has changed, all of it or nothing.

Before that, the machine of a file as a model to identify, and poses at which to measure it.
"""

import contextlib
import os
import tempfile
from pathlib import Path
from typing import Protocol

import numpy as np

from arm_control.arm import SerialArm
from arm_control.chain import JOINTS
from arm_control.identification.arm_model import ArmModel
from arm_control.identification.arm_model import geometry_lines as arm_lines
from hexapod_control.identification.leg_model import LegModel, Tolerances
from hexapod_control.identification.models import geometry_lines, model_of
from hexapod_control.workspace import sample
from hexarm.machine_check import problems_of
from hexarm.machines import find, shipped, text_of
from manipulator.analysis.measurements import Model
from manipulator.arrays import Array
from manipulator.errors import ConfigError
from manipulator.kinematics import Kinematics
from manipulator.machine import Machine
from manipulator.pose import Pose

SHARE_OF_RANGE = 0.8
"""Of an arm's joint ranges: near their ends a joint may be at its stop."""


class MachineModel(Model, Protocol):
    """A model whose joints have servos."""

    def joint_offsets(self, values: Array) -> Array:
        """(6,): true position less the commanded one, rad or m."""
        ...


def machine_model(kinematics: Kinematics, tolerances: Tolerances) -> MachineModel:
    """InvalidInput for a kind of machine that cannot be identified."""
    if isinstance(kinematics, SerialArm):
        return ArmModel(kinematics, tolerances.length, tolerances.angle)
    return model_of(kinematics, tolerances)


def new_geometry(model: MachineModel, values: Array) -> list[str]:
    """The lines of the machine file's `geometry`; none where all of it is in the servos."""
    if isinstance(model, ArmModel):
        is_as_told = not values[JOINTS:].any()
        return [] if is_as_told else arm_lines(model.identified(values), model.arm.rest)
    return geometry_lines(model.identified(values)) if isinstance(model, LegModel) else []


def random_poses(
    machine: Machine, count: int, generator: np.random.Generator
) -> tuple[Array, Pose]:
    """Joints (count, m) and poses over the whole workspace.

    Of an arm those above its base plane; where it would touch itself or a table is unknown.
    """
    kinematics = machine.kinematics
    if not isinstance(kinematics, SerialArm):
        poses = sample(machine, count, generator)
        return kinematics.inverse(poses), poses
    low, high = kinematics.limits.sampled
    middle, half = (low + high) / 2, SHARE_OF_RANGE * (high - low) / 2
    joints = middle + half * generator.uniform(-1.0, 1.0, (4 * count, len(low)))
    poses = kinematics.chain.forward(joints)
    above = np.flatnonzero(poses.position[:, 2] > 0.0)[:count]
    return joints[above], poses[above]


class MachineWriter:
    """The file that a calibration reads, and the one that it writes to."""

    def __init__(self, machine: str, output: str | None) -> None:
        """ConfigError where it could not be written later: checked before any work is done."""
        self.source = find(machine).resolve()
        self.target = Path(output).expanduser() if output else self.source
        self.text = text_of(self.source)
        if output is None and self.source in {path.resolve() for path in shipped().values()}:
            raise ConfigError(
                [
                    f'{self.source.name} came with the package and stays as it is: '
                    f'name a file of your own with --output my_{self.source.name}'
                ]
            )
        if output is not None and self.target.exists():
            raise ConfigError([f'{self.target} exists already: it is not overwritten'])
        folder = self.target.parent
        if not folder.is_dir():
            raise ConfigError([f'{folder} is not a folder'])
        if not os.access(folder, os.W_OK) or (
            output is None and not os.access(self.target, os.W_OK)
        ):
            raise ConfigError([f'{self.target} cannot be written: name another with --output'])

    def write(self, text: str) -> list[str]:
        """Puts the new text in place at once; returns the findings of `hexarm check`.

        ConfigError where the file was changed meanwhile.
        """
        if text_of(self.source) != self.text:
            raise ConfigError([f'{self.source} was changed meanwhile: nothing was written'])
        if self.target != self.source and self.target.exists():
            raise ConfigError([f'{self.target} was made meanwhile: it is not overwritten'])
        found = self._new_problems(text)
        try:
            self._replace(text)
        except OSError as error:
            raise ConfigError([f'{self.target} cannot be written: {error.strerror}']) from error
        return found

    def _new_problems(self, text: str) -> list[str]:
        """What is wrong with the machine file after the change and was not before."""
        before = set(problems_of(self.text, self.source.parent))
        return [p for p in problems_of(text, self.target.parent) if p not in before]

    def _replace(self, text: str) -> None:
        number, name = tempfile.mkstemp(prefix=f'.{self.target.name}.', dir=self.target.parent)
        try:
            with os.fdopen(number, 'w', encoding='utf-8', newline='') as file:
                file.write(text)
                file.flush()
                os.fsync(file.fileno())
            Path(name).chmod(self.source.stat().st_mode & 0o777 | 0o600)
            os.replace(name, self.target)
        except BaseException:
            with contextlib.suppress(OSError):
                os.unlink(name)
            raise
