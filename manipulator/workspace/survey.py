"""All figures of a machine's workspace in one go."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.reach.way import is_connected, is_joint_box
from manipulator.workspace.inside import ranges
from manipulator.workspace.some_orientation import SomeOrientation
from manipulator.workspace.volume import PILOT, Box, Volume, bounding_box, volume, with_orientation

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
    sample of the first volume to which a way from home was found. box holds that volume.
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

    Where they are to be looked for is found from fewer positions where few are asked for.
    """
    home, length = machine.kinematics.home, machine.kinematics.characteristic_length
    found = ranges(machine, partial(on_progress, 'ranges'))
    straight = with_orientation(machine, home.rotation)
    pilot = min(PILOT, points)
    box = bounding_box(straight, home.position, length, pilot, partial(on_progress, 'box'))
    generator = np.random.default_rng(SEED)
    constant = volume(straight, box, points, generator, partial(on_progress, 'volume'))
    share = _connected_share(machine, box)
    wide = bounding_box(
        SomeOrientation(machine, tilt, PILOT_STEPS),
        home.position,
        length,
        min(PILOT_POSITIONS, max(points // 5, 400)),
        partial(on_progress, 'orientations box'),
    )
    few = max(points // SEARCHED, FEWEST_SEARCHED)
    steps = SomeOrientation(machine, tilt).steps
    half, some = (
        volume(
            SomeOrientation(machine, tilt, n),
            wide,
            few,
            np.random.default_rng(SEED),
            partial(on_progress, f'orientations {stage}/2'),
        )
        for stage, n in ((1, steps // 2), (2, steps))
    )
    return Survey(found, constant, share, some, some.value - half.value, tilt, box)


def _connected_share(machine: Machine, box: Box) -> float:
    """Of up to 200 admitted positions of the box, the part that is connected to home."""
    if is_joint_box(machine):
        return 1.0
    places = box.lattice(20 * CONNECTION_SAMPLES, np.full(3, 0.5))
    rotation = machine.kinematics.home.rotation
    inside = places[with_orientation(machine, rotation)(places)][:CONNECTION_SAMPLES]
    linked = [is_connected(machine, Pose(place, rotation)) for place in inside]
    return float(np.mean(linked)) if linked else 0.0
