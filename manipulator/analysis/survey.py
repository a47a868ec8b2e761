"""All figures of a machine's workspace in one go: docs/workspace.md, section 3.

Among them the positions that it reaches with at least one orientation.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from manipulator import rotation as so3
from manipulator.analysis.free_paths import is_connected, is_joint_box, keeps_limits
from manipulator.analysis.inside import ranges
from manipulator.analysis.readings import readings_of
from manipulator.analysis.volume import PILOT, Box, Volume, bounding_box, volume, with_orientation
from manipulator.arrays import Array, Mask
from manipulator.machine import Machine
from manipulator.pose import Pose

STARTS = 40
ORIENTATION_SEED = 7
LAST_SPREAD = 0.03
WIDE = 0.5
"""rad: from how far the first search starts, at most; a further one starts from twice as far."""
AROUND = 2.0
"""Times its range at home, so far turns a machine elsewhere."""
STILL, SHRINK = 1e-6, 0.8
ADMITTED = 1e6
"""More than any margin: an admitted orientation is the better, the less it turns."""


@dataclass(frozen=True, eq=False)
class SomeOrientation:
    """The positions admitted with some roll, pitch and yaw from home, each within ±largest (rad).

    A search tries a few orientations of the size of own (3,), the machine's own ranges about each
    axis (rad), then, at each position, `steps` random changes of the best one so far, ever
    smaller: of the best margin, or of the smallest turn once one is admitted. It does not know
    `largest`, which only ends it: so no position is lost as `largest` grows. What is found is
    admitted for certain; what is not found may be admitted all the same.
    """

    machine: Machine
    largest: float
    own: Array
    steps: int = 60

    @classmethod
    def of(cls, machine: Machine, largest: float, steps: int = 60) -> 'SomeOrientation':
        """By the machine's ranges from home."""
        return cls(machine, largest, own_turns(ranges(machine)), steps)

    def __call__(self, positions: Array) -> Mask:
        """Which positions (N, 3) in metres were found."""
        found = np.zeros(len(positions), dtype=np.bool_)
        far, reach = WIDE, AROUND * np.maximum(self.own, STILL)
        self._search(positions, np.minimum(reach, far), found)
        while far < min(self.largest, reach.max()):
            far *= 2.0
            self._search(positions, np.minimum(reach, far), found)
        return found

    def _search(self, positions: Array, scale: Array, found: Mask) -> None:
        """One search from orientations within ±scale (3,); notes in `found` what it finds."""
        best = np.full(len(positions), -np.inf)
        angles = np.zeros((len(positions), 3))
        for start in np.vstack([np.zeros(3), Box(-scale, scale).lattice(STARTS, np.zeros(3))]):
            self._try(positions, np.tile(start, (len(positions), 1)), found, best, angles)
        generator = np.random.default_rng(ORIENTATION_SEED)
        for spread in np.geomspace(0.6, LAST_SPREAD, self.steps):
            changes = spread * scale * generator.standard_normal(angles.shape)
            kept = np.where(best > 0.0, SHRINK, 1.0)[:, None] * angles
            self._try(positions, kept + changes, found, best, angles)

    def _try(
        self, positions: Array, trial: Array, found: Mask, best: Array, angles: Array
    ) -> None:
        """Notes in the last three what the trial angles (N, 3) better."""
        rest = np.flatnonzero(~found)
        turned = so3.from_rpy(trial[rest]) @ self.machine.kinematics.home.rotation
        pose = Pose(positions[rest], turned)
        joints = self.machine.kinematics.inverse_or_nan(pose)
        inside = keeps_limits(self.machine, pose, joints)
        turned = np.abs(trial[rest]).max(axis=1)
        found[rest[inside & (turned <= self.largest)]] = True
        score = ADMITTED - turned
        score[~inside] = self._score(pose[~inside], joints[~inside])
        better = score > best[rest]
        best[rest[better]] = score[better]
        angles[rest[better]] = trial[rest[better]]

    def _score(self, pose: Pose, joints: Array) -> Array:
        """The worst margin that exists, metres by the characteristic length; (N,)."""
        readings = readings_of(self.machine, pose, joints)
        length = self.machine.kinematics.characteristic_length
        scales = np.array([length if unit == 'm' else 1.0 for _, _, unit in readings.names])
        margins = readings.margins / np.tile(scales, 2)
        worst: Array = np.nan_to_num(margins, nan=np.inf).min(axis=-1)
        return worst


def own_turns(found: Mapping[str, tuple[float, float]]) -> Array:
    """(3,): the larger of a machine's ranges each way about x, y and z, of all `ranges`."""
    return np.array(
        [max(-low, high) for low, high in (found[a] for a in ('roll', 'pitch', 'yaw'))]
    )


SEED = 1
PILOT_STEPS, PILOT_POSITIONS = 20, 4000
FEWEST_SEARCHED = 64
SEARCHED = 64  # positions with home's orientation for one position with some orientation
CONNECTION_SAMPLES = 200

OnProgress = Callable[[str, float], None]


@dataclass(frozen=True, eq=False)
class Survey:
    """Ranges from home (m, rad); volumes of positions with home's and with some orientation.

    With some orientation means roll, pitch and yaw each within ±tilt (rad). search_gain (m³) is
    what the second half of the search for orientations added: the volume is that of what was
    found, and the truth is larger, by something like this. connected_share is the part of a
    sample of the first volume to which a path from home was found. box holds that volume.
    """

    ranges: dict[str, tuple[float, float]]
    constant_orientation: Volume
    connected_share: float
    some_orientation: Volume
    search_gain: float
    tilt: float
    box: Box


def survey(machine: Machine, points: int, tilt: float, on_progress: OnProgress) -> Survey:
    """From `points` positions with home's orientation, and a 64th of them with some other.

    The box to search is found from fewer positions where few are requested.
    """
    home, length = machine.kinematics.home, machine.kinematics.characteristic_length
    found = ranges(machine, partial(on_progress, 'ranges'))
    straight = with_orientation(machine, home.rotation)
    pilot = min(PILOT, points)
    box = bounding_box(straight, home.position, length, pilot, partial(on_progress, 'box'))
    generator = np.random.default_rng(SEED)
    constant = volume(straight, box, points, generator, partial(on_progress, 'volume'))
    share = _connected_share(machine, box)
    turned = SomeOrientation(machine, tilt, own_turns(found))
    wide = bounding_box(
        replace(turned, steps=PILOT_STEPS),
        home.position,
        length,
        min(PILOT_POSITIONS, max(points // 5, 400)),
        partial(on_progress, 'orientations box'),
    )

    def added(steps: int, stage: int) -> Volume:
        """Of the positions that only a turned platform reaches."""
        some = replace(turned, steps=steps)

        def reached(positions: Array) -> Mask:
            mask = ~straight(positions)
            mask[mask] = some(positions[mask])
            return mask

        few, same = max(points // SEARCHED, FEWEST_SEARCHED), np.random.default_rng(SEED)
        return volume(reached, wide, few, same, partial(on_progress, f'orientations {stage}/2'))

    half, whole = added(turned.steps // 2, 1), added(turned.steps, 2)
    whole = max(half, whole, key=lambda found: found.value)  # the longer search may find others
    error = float(np.hypot(constant.error, whole.error))
    some = replace(whole, value=constant.value + whole.value, error=error)
    return Survey(found, constant, share, some, whole.value - half.value, tilt, box)


def _connected_share(machine: Machine, box: Box) -> float:
    """Of up to 200 admitted positions of the box, the part that is connected to home."""
    if is_joint_box(machine):
        return 1.0
    places = box.lattice(20 * CONNECTION_SAMPLES, np.full(3, 0.5))
    rotation = machine.kinematics.home.rotation
    inside = places[with_orientation(machine, rotation)(places)][:CONNECTION_SAMPLES]
    linked = [is_connected(machine, Pose(place, rotation)) for place in inside]
    return float(np.mean(linked)) if linked else 0.0
