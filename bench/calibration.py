"""Geometry identification on simulated machines with known errors, at poses never measured."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from bench.row import Row
from hexapod_control.identification.leg_model import Tolerances
from hexarm.calibration.machine_model import MachineModel, machine_model, random_poses
from hexarm.calibration.poses import telling_poses
from hexarm.machines import load
from manipulator.errors import NoSolution
from manipulator.identification.device_frames import DeviceFrames
from manipulator.identification.identify import Identification, identify
from manipulator.identification.measurements import Measurements, Noise
from manipulator.pose import Pose

POSES, UNSEEN, MACHINES = 40, 1000, 12
NOISE = Noise(position=1e-4, rotation=1e-3)
"""0.1 mm, and the same at 100 mm: 1 mrad = 0.057°."""

LARGEST = {'anchors': 5e-4, 'joints': 5e-4, 'cranks': 3e-4, 'rods': 3e-4, 'lengths': 5e-4}
LARGEST_ANGLE, LARGEST_OFFSET = np.radians(1.0), 5e-4
BUILT = Tolerances(5e-4, np.radians(1.0))
GOAL = 5e-5


def rows() -> list[Row]:
    found = []
    for name in ('robocake', 'stewart_6_6', 'arm_6r', 'ur5'):
        campaign = Campaign.of(name)
        for is_known in (False, True):
            where = 'frames known' if is_known else 'unknown frames'
            runs = [campaign.run(seed, is_known) for seed in range(MACHINES)]
            after = np.array([run.after for run in runs])
            rms = np.sqrt((after**2).mean(axis=0))
            within = int((after.max(axis=1) <= GOAL).sum())
            title = f'calibration of {name}, {where}'
            before = 1e3 * np.sqrt(np.mean([run.before**2 for run in runs]))
            text = ', '.join(f'{axis} {1e3 * e:.3f}' for axis, e in zip('xyz', rms, strict=True))
            found.append(
                Row(f'{title}: rms at {UNSEEN} unseen poses, {MACHINES} machines',
                    f'{before:.2f} mm → {text} mm', '0.05 mm', bool(rms.max() <= GOAL))
            )  # fmt: skip
            found.append(
                Row(f'{title}: worst axis of a machine, machines within',
                    f'{1e3 * after.max():.3f} mm, {within} of {MACHINES}')
            )  # fmt: skip
            law = 1e3 * np.sqrt(np.mean([run.law**2 for run in runs], axis=0))
            text = ', '.join(f'{axis} {e:.3f}' for axis, e in zip('xyz', law, strict=True))
            found.append(Row(f'{title}: what the covariance says', f'{text} mm'))
    return found


@dataclass(frozen=True)
class Run:
    """One machine: rms errors (3,) of the position, m: before, after, and by the covariance."""

    before: np.ndarray
    after: np.ndarray
    law: np.ndarray
    found: Identification


@dataclass(frozen=True)
class Campaign:
    """What is measured of a kind of machine, and what is not."""

    model: MachineModel
    joints: np.ndarray
    poses: Pose
    unseen_joints: np.ndarray
    unseen: Pose

    @classmethod
    def of(cls, name: str, count: int = POSES, unseen: int = UNSEEN) -> 'Campaign':
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
        truth, told, plain = self._unseen(true, found, frames)
        law = self._law(found)
        return Run(_rms(truth - plain), _rms(truth - told), law, found)

    def _unseen(self, true, found, frames):
        """Positions of the marker in the device's frame: true, identified, by the file."""
        both = [
            set(closing(self.model, values, self.unseen_joints, self.unseen))
            for values in (true, found.model_values)
        ]
        kept = sorted(both[0] & both[1])
        assert len(kept) > 0.98 * len(self.unseen_joints)
        joints, near = self.unseen_joints[kept], self.unseen[kept]
        truth = self.model.predict(true, joints, near)
        told = self.model.predict(found.model_values, joints, near)
        seen = (frames.seen(truth), found.frames.seen(told), frames.seen(near))
        return [pose.position for pose in seen]

    def _law(self, found):
        """The errors to be expected by the covariance of what was found."""
        own = self.model.slopes(0 * found.model_values, self.unseen_joints, self.unseen)
        zero = np.zeros(12)
        slopes = found.frames.slopes(zero, self.unseen, own)[:, :3]
        spread = np.einsum('nij,jk,nik->ni', slopes, found.covariance, slopes)
        return np.sqrt(spread.mean(axis=0))


def true_values(model: MachineModel, generator: np.random.Generator) -> np.ndarray:
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


def closing(
    model: MachineModel, values: np.ndarray, joints: np.ndarray, near: Pose
) -> Iterator[int]:
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


def _rms(errors: np.ndarray) -> np.ndarray:
    return np.sqrt((errors**2).mean(axis=0))
