"""Torques, speeds and largest loads of Prokopovich 2019, figs 12 and 13."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from hexapod_control.rotary import RotaryHexapod
from hexarm import machines
from hexarm.cli.export import modelled
from hexarm.papers.crank_kinematics import MACHINE
from hexarm.papers.finding import ROTARY, Finding
from hexarm.simulation.dynamics_config import RotaryDynamicsConfig
from hexarm.simulation.experiment import Recording, run, unshifted
from hexarm.simulation.limit_search import (
    PAPER_AMPLITUDE,
    Demand,
    LimitSearch,
    along,
    corners_out,
    in_phase,
    lines,
)
from hexarm.simulation.model import dynamics_of
from hexarm.simulation.simulation import Simulation
from hexarm.simulation.static_load import static_load
from manipulator.errors import InvalidInput

G, KG_CM = 9.80665, 0.0980665
PAPER = Demand(payload=0.150, speed=0.050, acceleration=0.3 * G)
FREQUENCY = 0.884
HALF_LENGTH = 0.010


@dataclass(frozen=True, eq=False)
class Dynamics:
    """What was found, with the recording for fig. 13."""

    findings: list[Finding]
    recording: Recording


def reproduced() -> Dynamics:
    """The sinusoid in simulation; the limits along lines by inverse dynamics."""
    machine = machines.load(MACHINE)
    kinematics = machine.kinematics
    simulation = Simulation(
        modelled(MACHINE), kinematics.home, kinematics.inverse(kinematics.home)
    )
    cycle = in_phase(kinematics.home, np.array(PAPER_AMPLITUDE), FREQUENCY)
    recording = run(simulation, kinematics, cycle, 2.0, unshifted)
    out = corners_out(machine, np.array(PAPER_AMPLITUDE))
    found = [*sinusoid(recording, out), standing(), *limits()]
    return Dynamics(found, recording)


def sinusoid(recording: Recording, out: int) -> Iterator[Finding]:
    """Fig. 12 in phase, fast enough for 50 mm/s."""
    speed = 1e3 * float(np.linalg.norm(recording.twists[:, :3], axis=1).max())
    torque = float(np.abs(recording.efforts).max()) / KG_CM
    rate = float(np.degrees(np.abs(recording.rates).max()))
    yield Finding(
        'fig_12', ROTARY, 'sinusoids of fig. 12', 'frequency and phase not in the text',
        f'all in phase at {FREQUENCY} Hz: {speed:.1f} mm/s', speed, 0.3, 'not stated',
        f'of the 64 corners that other phases may reach, {out} are outside the workspace',
    )  # fmt: skip
    yield Finding(
        'fig_13_torque', ROTARY, 'torque in this motion with 150 g (fig. 13 a)',
        'as close to 1.8 kg·cm as possible', f'≤ {torque:.3f} kg·cm', torque, 0.005, 'contradicts',
        'an eighth of the servo’s: torque does not limit this motion',
    )  # fmt: skip
    yield Finding(
        'fig_13_speed', ROTARY, 'crank speed in this motion (fig. 13 b)',
        'below 600 °/s, with a margin', f'≤ {rate:.0f} °/s', rate, 3.0, 'agrees',
        'half of the servo’s speed',
    )  # fmt: skip


def standing() -> Finding:
    """Gravity alone, at home."""
    machine, dynamics = machines.load(MACHINE), dynamics_of(machines.read(MACHINE))
    home = machine.kinematics.home
    load = static_load(machine.kinematics, dynamics)(home, machine.kinematics.inverse(home))
    torque = float(np.abs(load).max()) / KG_CM
    return Finding(
        'static', ROTARY, 'torque at rest at home with 150 g', 'not given',
        f'{torque:.4f} kg·cm', torque, 1e-4, 'not stated',
        'virtual work; MuJoCo’s drives need the same',
    )  # fmt: skip


def limits() -> Iterator[Finding]:
    """The most of each, the paper's other two kept, along lines of ±10 mm on x, y and z."""
    machine, file = machines.load(MACHINE), machines.read(MACHINE)
    kinematics, dynamics = machine.kinematics, dynamics_of(file)
    if not isinstance(kinematics, RotaryHexapod) or not isinstance(dynamics, RotaryDynamicsConfig):
        raise InvalidInput(f'{MACHINE} is no crank platform')
    drives = modelled(MACHINE).drives
    told = (
        ('payload', '150 g', 1e3, 'g', 0),
        ('speed', '50 mm/s', 1e3, 'mm/s', 0),
        ('acceleration', '0.3 g', 1 / G, 'g', 1),
    )
    for name, paper, factor, unit, digits in told:
        found = []
        for torque in (1.8, 2.5):
            servos = drives.stronger(torque * KG_CM)
            searches = [
                LimitSearch(kinematics, dynamics, servos, line)
                for line in lines(HALF_LENGTH).values()
            ]
            found.append(factor * min(along(s, PAPER, name, True) for s in searches))
        yield Finding(
            f'largest_{name}', ROTARY, f'largest {name}, the other two as in the paper', paper,
            f'{found[0]:.{digits}f} {unit} (2.5 kg·cm: {found[1]:.{digits}f})', found[0],
            0.01 * found[0], 'partly',
            'lines of ±10 mm, torque falls with speed: the paper’s is possible, not the maximum',
        )  # fmt: skip
