"""Largest payload, speed and acceleration of Prokopovich 2019 together, and fig. 13 as a table.

By inverse dynamics along lines of ±10 mm on x, y and z through home, at every place of them: at
rest and at full speed either way, with both signs of the acceleration.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hexapod_control.rotary import RotaryHexapod
from hexarm import machines
from hexarm.cli.export import modelled
from hexarm.papers.crank_kinematics import MACHINE
from hexarm.papers.finding import ROTARY, Claim, Finding, Table, unstated
from hexarm.simulation.drives import Drives
from hexarm.simulation.dynamics_config import RotaryDynamicsConfig
from hexarm.simulation.limit_search import Costs, Demand, LimitSearch, along, lines
from hexarm.simulation.model import dynamics_of
from hexarm.simulation.static_load import static_load
from manipulator.errors import InvalidInput

G, KG_CM, N_CM = 9.80665, 0.0980665, 0.01
PAPER = Demand(payload=0.150, speed=0.050, acceleration=0.3 * G)
TOGETHER = '50 mm/s, 0.3 g and 150 g together'
SERVO = (1.8, 2.5)
"""What an SG90 gives at 4.8 V and at 6 V, in kg·cm."""
HALF_LENGTH = 0.010
PAYLOADS_G, SPEEDS_MM_S = (0.0, 150.0, 300.0), (25.0, 50.0, 100.0)
ACCELERATIONS_G = (0.1, 0.3, 1.0)
HEAD = (
    'payload (g)', 'speed (mm/s)', 'acceleration (g)', 'torque, x line (N·cm)', 'y (N·cm)',
    'z (N·cm)', 'largest (kg·cm)', 'fastest crank (°/s)',
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Searches:
    """Of RoboCake, along x, y and z; drives are those of its machine file."""

    @cached_property
    def drives(self) -> Drives:
        """SG90 at 4.8 V."""
        return modelled(MACHINE).drives

    def of(self, torque: float) -> list[LimitSearch]:
        """With servos of `torque` N·m at standstill."""
        kinematics = machines.load(MACHINE).kinematics
        dynamics = dynamics_of(machines.read(MACHINE))
        if not (
            isinstance(kinematics, RotaryHexapod) and isinstance(dynamics, RotaryDynamicsConfig)
        ):
            raise InvalidInput(f'{MACHINE} is no crank platform')
        servos = self.drives.stronger(torque)
        return [LimitSearch(kinematics, dynamics, servos, x) for x in lines(HALF_LENGTH).values()]

    @cached_property
    def _plain(self) -> list[LimitSearch]:
        return self.of(SERVO[0] * KG_CM)

    def costs(self, demand: Demand) -> list[Costs]:
        """Along x, y and z."""
        return [search.costs(demand) for search in self._plain]


def findings() -> Iterator[Finding]:
    """Gravity alone; the paper's three limits together; the most of each."""
    searches = Searches()
    yield standing()
    yield from together(searches)
    yield from largest(searches)


def standing() -> Finding:
    """Gravity alone, at home."""
    machine, dynamics = machines.load(MACHINE), dynamics_of(machines.read(MACHINE))
    home = machine.kinematics.home
    load = static_load(machine.kinematics, dynamics)(home, machine.kinematics.inverse(home))
    torque = float(np.abs(load).max()) / N_CM
    return Finding(
        'static', ROTARY, 'torque at rest at home with 150 g', unstated(), both_units(torque),
        (torque,), 'N·cm', 1e-3, 'virtual work; MuJoCo’s drives need the same',
    )  # fmt: skip


def together(searches: Searches) -> Iterator[Finding]:
    """The torque and crank speed at the paper's own operating point, in both units."""
    costs = searches.costs(PAPER)
    torques = [c.torque / N_CM for c in costs]
    worst, rate = max(torques), float(np.degrees(max(c.rate for c in costs)))
    shown = ', '.join(f'{t:.2f}' for t in torques)
    middle, half = sum(SERVO) / 2, (SERVO[1] - SERVO[0]) / 2
    yield Finding(
        'operating_torque', ROTARY, f'torque at {TOGETHER} (fig. 13 a)',
        Claim('as near to 1.8 … 2.5 kg·cm as may be', (middle,), half, 2 * half),
        f'≤ {worst * N_CM / KG_CM:.3f} kg·cm', (worst * N_CM / KG_CM,), 'kg·cm', 1e-3,
        f'{shown} N·cm on x, y, z: a tenth of what the servos give',
    )  # fmt: skip
    yield Finding(
        'operating_torque_n_cm', ROTARY, 'the same torque, if the servo’s 1.8 … 2.5 are N·cm',
        Claim('as near to 1.8 … 2.5 N·cm as may be (our reading)', (middle,), half, 2 * half),
        f'≤ {worst:.2f} N·cm', (worst,), 'N·cm', 1e-2,
        'a slip of units is likely: N·cm in the model’s output, kg·cm in the servo’s data sheet',
    )  # fmt: skip
    weak = searches.of(SERVO[1] * N_CM)
    payload = 1e3 * min(along(s, PAPER, 'payload', False) for s in weak)
    yield Finding(
        'payload_n_cm', ROTARY, 'largest payload at 50 mm/s and 0.3 g with 2.5 N·cm',
        Claim('150 g', (150.0,), 15.0, 75.0), f'{payload:.0f} g', (payload,), 'g', 1.0,
        'the same slip of units; the platform’s 100 g are our estimate',
    )  # fmt: skip
    yield Finding(
        'operating_speed', ROTARY, f'crank speed at {TOGETHER} (fig. 13 b)',
        Claim('below 600 °/s, with a margin', (600.0,), side='at most'), f'≤ {rate:.0f} °/s',
        (rate,), '°/s', 0.5, 'within ±10 mm of home',
    )  # fmt: skip


def largest(searches: Searches) -> Iterator[Finding]:
    """The most of each, the paper's other two kept, if the servo gives its torque in kg·cm."""
    rows = (
        ('payload', '150 g', 150.0, 1e3, 'g', 0),
        ('speed', '50 mm/s', 50.0, 1e3, 'mm/s', 0),
        ('acceleration', '0.3 g', 0.3, 1 / G, 'g', 1),
    )
    for name, text, paper, factor, unit, digits in rows:
        found = [
            factor * min(along(s, PAPER, name, True) for s in searches.of(torque * KG_CM))
            for torque in SERVO
        ]
        yield Finding(
            f'largest_{name}', ROTARY, f'largest {name} with 1.8 kg·cm, the other two as above',
            Claim(text, (paper,), 0.1 * paper, paper),
            f'{found[0]:.{digits}f} {unit} (2.5 kg·cm: {found[1]:.{digits}f})', (found[0],), unit,
            0.01 * found[0], 'torque falls with speed; the paper’s limits are possible, not the '
            'largest',
        )  # fmt: skip


def grid(searches: Searches) -> list[tuple[Demand, list[Costs]]]:
    """Every combination of the payloads, speeds and accelerations of the table."""
    demands = [
        Demand(1e-3 * payload, 1e-3 * speed, G * acceleration)
        for payload in PAYLOADS_G
        for speed in SPEEDS_MM_S
        for acceleration in ACCELERATIONS_G
    ]
    return [(demand, searches.costs(demand)) for demand in demands]


def table(searches: Searches) -> Table:
    """Torque and crank speed over payload, speed and acceleration: fig. 13 for all of them."""
    rows = []
    for demand, costs in grid(searches):
        asked = (1e3 * demand.payload, 1e3 * demand.speed, demand.acceleration / G)
        torques = [c.torque / N_CM for c in costs]
        rate = float(np.degrees(max(c.rate for c in costs)))
        numbers = (*asked, *torques, max(torques) * N_CM / KG_CM, rate)
        rows.append(tuple(float(f'{v:.5g}') for v in numbers))
    title = 'Torque and crank speed over payload, speed and acceleration (fig. 13)'
    return Table('fig_13', title, HEAD, tuple(rows), 1e-3)


def both_units(torque: float) -> str:
    """A torque in N·cm, in words with both units."""
    return f'{torque:.3f} N·cm = {torque * N_CM / KG_CM:.4f} kg·cm'
