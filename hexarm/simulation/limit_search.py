"""The most that a crank platform's servos can do along a straight line through home.

At every place of the line, in either direction at any speed up to the requested one, while
speeding up or slowing down: a line without a beginning or an end, harder than any real motion.

The cycle of Prokopovich 2019, fig. 12, all six axes in phase, and what of it is in reach.
"""

import itertools
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from hexapod_control.rotary import RotaryHexapod
from hexarm.simulation.drives import Drives
from hexarm.simulation.dynamics_config import RotaryDynamicsConfig
from hexarm.simulation.inverse_dynamics import InverseDynamics
from manipulator.arrays import Array, Mask
from manipulator.machine import Machine
from manipulator.planning.cycle import Cycle
from manipulator.planning.plan import MotionState
from manipulator.pose import Pose

PAPER_AMPLITUDE = (6e-3, 6e-3, 3e-3, 0.1, 0.1, 0.08)
"""x, y, z in m; about x (ψ), y (θ), z (φ) in rad."""
CHECKED, CHECKED_A_TURN = 400, 100
QUARTER = 0.25


FREQUENCY = 0.884
"""Hertz at which the paper's amplitudes, in phase, reach 50 mm/s."""


def in_phase(home: Pose, amplitude: Array, frequency: float) -> Cycle:
    """All six axes as the same sine of `frequency` hertz."""
    return Cycle(home, np.asarray(amplitude), np.full(6, frequency), np.zeros(6))


def poses_of(cycle: Cycle) -> Pose:
    """A period of the cycle, evenly in time, and so often that its fastest sine is seen."""
    period = cycle.checked_duration
    turns = float((cycle.frequency * (cycle.amplitude != 0)).max(initial=0.0)) * period
    count = max(CHECKED, int(np.ceil(CHECKED_A_TURN * turns)))
    return cycle.at(np.linspace(0.0, period, count)).pose


def inside(machine: Machine, poses: Pose) -> Mask:
    """Which of the poses (N) close and keep every limit."""
    joints = machine.kinematics.inverse_or_nan(poses)
    found = np.asarray(np.isfinite(joints).all(axis=-1), dtype=np.bool_)
    found[found] = machine.constraints.admits(poses[found], joints[found])
    return found


def share_in_reach(machine: Machine, cycle: Cycle) -> float:
    """The largest part of a cycle's amplitudes that stays in reach, to a thousandth; at most 1."""

    def holds(part: float) -> bool:
        smaller = replace(cycle, amplitude=part * cycle.amplitude)
        return bool(inside(machine, poses_of(smaller)).all())

    if holds(1.0):
        return 1.0
    low, high = 0.0, 1.0
    while high - low > 1e-3:
        middle = (low + high) / 2
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low


def corners_out(machine: Machine, amplitude: Array) -> int:
    """Of the 64 poses with each amplitude at + or −, how many the machine cannot take.

    What other phases between the axes may come to.
    """
    signs = itertools.product((-1.0, 1.0), repeat=6)
    cycles = [in_phase(machine.kinematics.home, s * amplitude, 1.0) for s in np.array(list(signs))]
    corners = [cycle.at(QUARTER).pose for cycle in cycles]
    position, rotation = ([getattr(c, n) for c in corners] for n in ('position', 'rotation'))
    return int(np.sum(~inside(machine, Pose(np.array(position), np.array(rotation)))))


PLACES = 21
RELATIVE = 1e-4


@dataclass(frozen=True)
class Demand:
    """The demands on a line: payload in kg, speed in m/s, acceleration in m/s²."""

    payload: float
    speed: float
    acceleration: float


@dataclass(frozen=True, eq=False)
class Costs:
    """The worst of a demand: the largest torque (N·m), crank rate (rad/s), and load.

    load is the torque by what the motor has left at its speed; above 1 it stalls.
    """

    torque: float
    rate: float
    load: float


@dataclass(frozen=True, eq=False)
class Line:
    """A line through home along a base axis, level; from `low` to `high` metres."""

    axis: int
    low: float
    high: float


@dataclass(frozen=True, eq=False)
class LimitSearch:
    """What one machine needs along a line; drives as its servos at some voltage."""

    kinematics: RotaryHexapod
    dynamics: RotaryDynamicsConfig
    drives: Drives
    line: Line
    _by_payload: dict[float, InverseDynamics] = field(default_factory=dict, repr=False)

    def costs(self, demand: Demand) -> Costs:
        """The worst over all places, speeds up to the requested one, and both accelerations."""
        motion = self._motions(demand)
        solver = self._solver(demand.payload)
        cranks = solver.cranks(motion)
        torques = solver.torques(motion, cranks)
        rotor = self.drives.rotor * cranks.accelerations
        helping = np.sign(torques + rotor) * cranks.rates
        left = self.drives.effort * (1 - np.maximum(helping, 0.0) / self.drives.speed)
        load = np.abs(torques + rotor) / np.maximum(left, 1e-9)
        rate = float(np.abs(cranks.rates).max())
        return Costs(float(np.abs(torques).max()), rate, float(load.max()))

    def holds_separately(self, demand: Demand) -> bool:
        """Torque below that at standstill, crank rate below the free speed; no rotors."""
        costs = self.costs(demand)
        is_slow = costs.rate <= float(self.drives.speed.min())
        return is_slow and costs.torque <= float(self.drives.effort.min())

    def holds_together(self, demand: Demand) -> bool:
        """Rotors in it, and torque falling with speed as a motor's does."""
        return self.costs(demand).load <= 1.0

    def _solver(self, payload: float) -> InverseDynamics:
        if payload not in self._by_payload:
            load = replace(self.dynamics.payload, mass_g=1e3 * payload)
            config = replace(self.dynamics, payload=load)
            self._by_payload[payload] = InverseDynamics(self.kinematics, config)
        return self._by_payload[payload]

    def _motions(self, demand: Demand) -> MotionState:
        """Every place, at rest and at full speed in either direction, with both accelerations."""
        along = np.linspace(self.line.low, self.line.high, PLACES)
        speeds = demand.speed * np.array([-1.0, 0.0, 1.0])
        accelerations = np.array([-demand.acceleration, demand.acceleration])
        grid = np.meshgrid(along, speeds, accelerations, indexing='ij')
        place, speed, acceleration = (np.ravel(g) for g in grid)
        unit = np.eye(6)[self.line.axis]
        pose = self.kinematics.home.moved(place[:, None] * unit)
        return MotionState(pose, speed[:, None] * unit, acceleration[:, None] * unit)


def largest(holds: Callable[[float], bool], first: float) -> float:
    """The largest value that holds, to a part in ten thousand; 0 where not even a trace does.

    `holds` must be true up to some value and false above it.
    """
    low, high = 0.0, first
    while holds(high):
        low, high = high, 2 * high
        if high > 1e9 * first:
            return float('inf')
    while high - low > RELATIVE * high:
        middle = (low + high) / 2
        low, high = (middle, high) if holds(middle) else (low, middle)
        if high < 1e-9 * first:
            return 0.0
    return low


def along(search: LimitSearch, demand: Demand, name: str, is_together: bool) -> float:
    """The largest payload, speed or acceleration (by name), the other two as in `demand`."""
    holds = search.holds_together if is_together else search.holds_separately
    return largest(lambda value: holds(replace(demand, **{name: value})), getattr(demand, name))


def lines(half_length: float) -> dict[str, Line]:
    """Lines along x, y and z, half_length metres to either side of home."""
    return {name: Line(axis, -half_length, half_length) for axis, name in enumerate('xyz')}
