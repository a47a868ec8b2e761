"""What the fake board moves, by name: servos by themselves, or the machine in MuJoCo."""

import time
from collections.abc import Callable
from dataclasses import replace

from bridge.board_thread import FakeMachine
from bridge.plant import Plant
from hexarm import machines
from hexarm.simulation.model import mechanism
from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.words import shown

TELL_EVERY = 10.0
PLANTS = ('servo', 'mujoco')


def plant(
    kind: str, name: str, machine: FakeMachine, tell: Callable[[str], object]
) -> FakeMachine:
    """The fake machine with the plant asked for; `tell` hears the real-time factor.

    Raises InvalidInput for another kind, ConfigError where the machine file has no masses.
    """
    if kind not in PLANTS:
        raise InvalidInput(f'parameter plant: {shown(kind)} is not one of {list(PLANTS)}')
    if kind == 'servo':
        return machine
    from hexarm.simulation.plant import MujocoPlant  # noqa: PLC0415 (needs mujoco)

    kinematics = machines.load(name).kinematics
    model = mechanism(machines.find(name).stem, machines.read(name), kinematics)
    calibration = machine.calibration
    simulated = MujocoPlant(model, kinematics, calibration.names, calibration.park)
    return replace(machine, servos=Timed(simulated, tell))


class Timed:
    """A plant that says every ten simulated seconds how much faster than the clock it is."""

    def __init__(self, inner: Plant, tell: Callable[[str], object]) -> None:
        self._inner = inner
        self._tell = tell
        self._simulated = self._taken = 0.0

    @property
    def positions(self) -> Array:
        """The plant's."""
        return self._inner.positions

    def step(self, targets: Array, dt: float) -> None:
        """The plant's, timed."""
        before = time.monotonic()
        self._inner.step(targets, dt)
        self._taken += time.monotonic() - before
        self._simulated += dt
        if self._simulated >= TELL_EVERY:
            factor = self._simulated / self._taken
            self._tell(f'mujoco: {factor:.0f} times as fast as real time')
            self._simulated = self._taken = 0.0
