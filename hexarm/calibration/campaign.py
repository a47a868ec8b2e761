"""Machines with known errors, measured with noise and identified: what a calibration achieves.

For measurements of the identification (bench/calibration.py) and its tests.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from hexapod_control.identification.leg_model import Tolerances
from hexarm.calibration.machine_writer import MachineModel, machine_model, random_poses
from hexarm.calibration.poses import telling_poses
from hexarm.machines import load
from manipulator.analysis.device_frames import DeviceFrames
from manipulator.analysis.identify import Identification, identify
from manipulator.analysis.measurements import Measurements, Noise
from manipulator.arrays import Array
from manipulator.errors import NoSolution
from manipulator.pose import Pose

POSES, UNSEEN = 40, 1000
NOISE = Noise(position=1e-4, rotation=1e-3)
"""0.1 mm, and the same at 100 mm: 1 mrad = 0.057°."""

LARGEST = {'anchors': 5e-4, 'joints': 5e-4, 'cranks': 3e-4, 'rods': 3e-4, 'lengths': 5e-4}
LARGEST_ANGLE, LARGEST_OFFSET = np.radians(1.0), 5e-4
BUILT = Tolerances(5e-4, np.radians(1.0))
MOSTLY = 0.98
"""Share of the unseen poses that a machine with errors must be able to take."""

GOAL = 5e-5
"""Metres, rms of each axis."""


@dataclass(frozen=True)
class Run:
    """One machine: rms errors (3,) of the position, m: before, after, and by the covariance."""

    before: Array
    after: Array
    law: Array
    found: Identification


@dataclass(frozen=True)
class Campaign:
    """What is measured of a kind of machine, and what is not."""

    model: MachineModel
    joints: Array
    poses: Pose
    unseen_joints: Array
    unseen: Pose

    @classmethod
    def of(cls, name: str, count: int = POSES, unseen: int = UNSEEN) -> 'Campaign':
        """Of a shipped machine, or the path of a file."""
        machine = load(name)
        model = machine_model(machine.kinematics, BUILT)
        joints, poses = telling_poses(machine, model, NOISE, count)
        others = random_poses(machine, unseen, np.random.default_rng(99))
        return cls(model, joints, poses, *others)

    def run(self, seed: int, are_frames_known: bool = False) -> Run:
        """Builds a machine with errors, measures it with noise, identifies it."""
        generator = np.random.default_rng(seed)
        true = true_values(self.model, generator)
        frames = DeviceFrames.known() if are_frames_known else some_frames(generator)
        seen = frames.seen(self.model.predict(true, self.joints, self.poses))
        noise = generator.standard_normal((len(self.joints), 6)) / NOISE.weights
        free = {p.group for p in self.model.parameters}
        free |= set() if are_frames_known else {'device', 'marker'}
        measured = Measurements(self.joints, seen.moved(noise))
        found = identify(self.model, measured, NOISE, self.poses, free)
        truth, predicted, plain = self._unseen(true, found, frames)
        law = self._law(found)
        return Run(_rms(truth - plain), _rms(truth - predicted), law, found)

    def _unseen(self, true: Array, found: Identification, frames: DeviceFrames) -> list[Array]:
        """Positions of the marker in the device's frame: true, identified, by the file."""
        both = [
            set(closing(self.model, values, self.unseen_joints, self.unseen))
            for values in (true, found.model_values)
        ]
        kept = sorted(both[0] & both[1])
        if len(kept) < MOSTLY * len(self.unseen_joints):
            raise NoSolution(f'closes at {len(kept)} of {len(self.unseen_joints)} poses only')
        joints, near = self.unseen_joints[kept], self.unseen[kept]
        truth = self.model.predict(true, joints, near)
        predicted = self.model.predict(found.model_values, joints, near)
        seen = (frames.seen(truth), found.frames.seen(predicted), frames.seen(near))
        return [pose.position for pose in seen]

    def _law(self, found: Identification) -> Array:
        """The errors to be expected by the covariance of what was found."""
        own = self.model.slopes(0 * found.model_values, self.unseen_joints, self.unseen)
        zero = np.zeros(12)
        slopes = found.frames.slopes(zero, self.unseen, own)[:, :3]
        spread = np.einsum('nij,jk,nik->ni', slopes, found.covariance, slopes)
        return np.asarray(np.sqrt(spread.mean(axis=0)))


def true_values(model: MachineModel, generator: np.random.Generator) -> Array:
    """Even errors: joints, leg offsets, links ± 0.5 mm, cranks, rods ± 0.3 mm, angles ± 1°."""
    largest = [
        LARGEST.get(p.group, LARGEST_ANGLE if p.unit == 'rad' else LARGEST_OFFSET)
        for p in model.parameters
    ]
    return np.array(largest) * generator.uniform(-1.0, 1.0, len(largest))


def some_frames(generator: np.random.Generator) -> DeviceFrames:
    """A device somewhere within a metre, turned at will; a marker within 50 mm."""
    place, turn = generator.uniform(-1, 1, (2, 3)), generator.uniform(-1, 1, (2, 3))
    return DeviceFrames(
        Pose.from_xyz_rpy(place[0], 3 * turn[0]), Pose.from_xyz_rpy(0.05 * place[1], turn[1])
    )


def closing(model: MachineModel, values: Array, joints: Array, near: Pose) -> Iterator[int]:
    """Which joints the machine can have: near a singularity, errors can leave none."""
    parts = [np.arange(len(joints))]
    while parts:
        part = parts.pop()
        try:
            model.predict(values, joints[part], near[part])
            yield from part.tolist()
        except NoSolution:
            if len(part) > 1:
                parts += [part[: len(part) // 2], part[len(part) // 2 :]]


def _rms(errors: Array) -> Array:
    return np.asarray(np.sqrt((errors**2).mean(axis=0)))
