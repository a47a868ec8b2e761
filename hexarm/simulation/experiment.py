"""A periodic motion in simulation, with ideal sensors: Prokopovich 2019, figs 12 and 13."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hexarm.simulation.simulation import Reading, Simulation
from manipulator.analysis.accuracy import JointErrors
from manipulator.arrays import Array, frozen
from manipulator.errors import InvalidInput
from manipulator.kinematics import Kinematics
from manipulator.planning.cycle import Cycle
from manipulator.pose import Pose

SHOWN_STEPS = 4
NOISE_STEPS = 40
"""Steps for which a servo keeps an error: 20 ms, the time between two of its pulses."""
Shift = Callable[[Pose, Array], Array]
"""What is added to the joints (N, n) of poses (N), before drives get them."""


@dataclass(frozen=True, eq=False)
class Recording:
    """What the sensors showed, one row every 2 ms; commanded are the requested poses.

    closure is how far the worst loop's ends are apart, metres; gravity the acceleration of free
    fall, (3,).
    """

    times: Array
    joints: Array
    rates: Array
    efforts: Array
    poses: Pose
    twists: Array
    accelerations: Array
    closure: Array
    commanded: Pose
    gravity: Array

    @property
    def errors(self) -> Array:
        """The twist (N, 6) from each pose to the one commanded at that moment, m and rad."""
        return self.poses.twist_to(self.commanded)


def run(
    simulation: Simulation, kinematics: Kinematics, cycle: Cycle, periods: float, shift: Shift
) -> Recording:
    """Drives the cycle with a new target at every step, after one period in which it swells.

    Raises InvalidInput for a cycle that does not repeat or periods ≤ 0, Unreachable for one that
    leaves the reach.
    """
    period = cycle.checked_duration
    if not period > 0 or not periods > 0:
        raise InvalidInput(f'{periods:g} periods of {period:g} s, both must be above 0')
    dt = simulation.step_time
    swelling, count = (round(t / dt) for t in (period, period * periods))
    times = np.linspace((1 - swelling) * dt, count * dt, swelling + count)
    poses = _swelling(cycle, times, period)
    joints = kinematics.inverse(poses, simulation.joints)
    targets = joints + shift(poses, joints)
    readings, closure, shown = [], [], []
    for k, target in enumerate(targets):
        simulation.aim(target)
        if k < swelling or (k - swelling + 1) % SHOWN_STEPS:
            simulation.step()
            continue
        readings.append(simulation.watched())
        shown.append(k)
        closure.append(simulation.closure_errors().max(initial=0.0))
    gravity = frozen(simulation.model.opt.gravity)
    return _recording(readings, frozen(closure), poses[shown], gravity)


def unshifted(pose: Pose, joints: Array) -> Array:
    """Targets as the kinematics has them."""
    return np.zeros(joints.shape)


def noisy(shift: Shift, errors: JointErrors, generator: np.random.Generator) -> Shift:
    """The same shift with errors of the servos, drawn anew for every pulse."""

    def noisy_shift(pose: Pose, joints: Array) -> Array:
        pulses = errors.drawn(-(-len(joints) // NOISE_STEPS), generator)
        return shift(pose, joints) + np.repeat(pulses, NOISE_STEPS, axis=0)[: len(joints)]

    return noisy_shift


def position_rms(quiet: Recording, other: Recording) -> float:
    """√E|Δp|² in metres between two recordings of one cycle."""
    apart = quiet.poses.position - other.poses.position
    return float(np.sqrt(np.mean(np.sum(apart**2, axis=-1))))


def _swelling(cycle: Cycle, times: Array, period: float) -> Pose:
    """The cycle from time 0 on; in the period before that, the path out from the centre."""
    part: Array = np.clip(1.0 + times / period, 0.0, 1.0)
    part = part**3 * (10 - 15 * part + 6 * part**2)
    return cycle.centre.moved(part[:, None] * cycle.centre.twist_to(cycle.at(times).pose))


def _recording(
    readings: list[Reading], closure: Array, commanded: Pose, gravity: Array
) -> Recording:
    def stacked(name: str) -> Array:
        return frozen(np.array([getattr(reading, name) for reading in readings]))

    times = stacked('time')
    positions = np.array([reading.pose.position for reading in readings])
    rotations = np.array([reading.pose.rotation for reading in readings])
    return Recording(
        frozen(times - times[0] + times[1] - times[0]),
        stacked('joints'),
        stacked('rates'),
        stacked('effort'),
        Pose(positions, rotations),
        stacked('twist'),
        stacked('acceleration'),
        closure,
        commanded,
        gravity,
    )
