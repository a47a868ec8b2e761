"""A machine in MuJoCo as what a board's pulses move: servos with torque, load and gravity."""

import numpy as np

from hexarm.simulation.rigid_body import Mechanism
from hexarm.simulation.simulation import Simulation
from manipulator.arrays import Array, frozen
from manipulator.errors import InvalidInput
from manipulator.kinematics import Kinematics

MOST_STEPS = 100
"""What is simulated at once; time that a busy computer missed is not made up for."""


class MujocoPlant:
    """Follows targets as far as its drives can; positions in the order of `names`.

    names may hold more than the machine's joints (a gripper): these follow at once. Without a
    pulse a drive holds where it is, with what its gears hold. Raises NoSolution for a park
    position that is no pose, InvalidInput where a joint is missing from names.
    """

    def __init__(
        self, mechanism: Mechanism, kinematics: Kinematics, names: tuple[str, ...], park: Array
    ) -> None:
        missing = set(mechanism.joints) - set(names)
        if missing:
            raise InvalidInput(f'no servo is called {", ".join(sorted(missing))}')
        self._order = [names.index(name) for name in mechanism.joints]
        joints = np.asarray(park)[self._order]
        self.simulation = Simulation(mechanism, kinematics.forward(joints).pose, joints)
        self._drives = mechanism.drives
        self._others = np.array(park, dtype=np.float64)
        self._aims = joints.copy()
        self._has_pulse = np.zeros(len(joints), dtype=bool)
        self._due = 0.0
        self._empower(self._has_pulse)

    @property
    def positions(self) -> Array:
        """Where everything in names is, rad or m."""
        positions = self._others.copy()
        positions[self._order] = self.simulation.joints
        return frozen(positions)

    def step(self, targets: Array, dt: float) -> None:
        """Goes on for dt seconds; NaN in targets (names,) means no pulse."""
        has_pulse = ~np.isnan(targets)
        self._others = np.where(has_pulse, targets, self._others)
        commanded, is_driven = targets[self._order], has_pulse[self._order]
        released = self._has_pulse & ~is_driven
        self._aims = np.where(is_driven, commanded, self._aims)
        self._aims[released] = self.simulation.joints[released]
        if (is_driven != self._has_pulse).any():
            self._empower(is_driven)
        self.simulation.aim(self._aims)
        step_time = self.simulation.step_time
        self._due = min(self._due + dt, MOST_STEPS * step_time)
        count = int(self._due / step_time)
        self._due -= count * step_time
        if count:
            self.simulation.step(count)

    def _empower(self, is_driven: Array) -> None:
        self._has_pulse = np.asarray(is_driven, dtype=bool)
        drives = self._drives
        self.simulation.allow(np.where(self._has_pulse, drives.effort, drives.backdrive))
