"""What the fake board moves, by name: servos by themselves, or the machine in MuJoCo."""

import time
from collections.abc import Callable
from dataclasses import replace

from bridge.calibration import Calibration
from bridge.fake.board import Board, MakeBoard
from bridge.fake.board_thread import FakeMachine
from bridge.fake.servo import PLANTS, SERVO, Plant
from bridge.servo_config import BoardConfig
from hexarm import machines
from hexarm.board.kinematics import crank_hexapod
from hexarm.simulation.model import mechanism
from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.formatting import not_one_of

TELL_EVERY = 10.0


def fake_machine(
    name: str,
    config: BoardConfig,
    boot_s: float,
    hysteresis: float,
    plant: str,
    tell: Callable[[str], object],
    make_board: MakeBoard = Board,
) -> FakeMachine:
    """The fake machine of a file; `tell` receives the real-time factor of a simulated plant.

    Hysteresis in rad (or m). Raises InvalidInput for another plant than PLANTS, ConfigError where
    the machine file has no masses for MuJoCo.
    """
    hexapod = crank_hexapod(machines.load(name), Calibration.from_config(config.servos))
    machine = FakeMachine.from_config(config, boot_s, hysteresis, hexapod, make_board)
    return _with_plant(plant, name, machine, tell)


def _with_plant(
    kind: str, name: str, machine: FakeMachine, tell: Callable[[str], object]
) -> FakeMachine:
    if kind not in PLANTS:
        raise InvalidInput(f'parameter plant: {not_one_of(kind, PLANTS)}')
    if kind == SERVO:
        return machine
    from hexarm.simulation.plant import MujocoPlant  # noqa: PLC0415 (needs mujoco)

    kinematics = machines.load(name).kinematics
    model = mechanism(machines.find(name).stem, machines.read(name), kinematics)
    calibration = machine.calibration
    simulated = MujocoPlant(model, kinematics, calibration.names, calibration.park)
    return replace(machine, servos=Timed(simulated, tell))


class Timed:
    """A plant that prints every ten simulated seconds how much faster than the clock it is."""

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
