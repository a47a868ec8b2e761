"""The moving model of Prokopovich 2019, figs 12 and 13: sinusoids, sensors, servo noise."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from hexarm import machines
from hexarm.cli.export import modelled
from hexarm.papers.crank_kinematics import MACHINE
from hexarm.papers.crank_limits import N_CM, PAPER, G, both_units
from hexarm.papers.crank_noise import (
    AS_UNIFORM,
    HALF,
    NAMES,
    PAPER_UM,
    SAME,
    Laws,
    conclusion,
    subsets,
    words,
)
from hexarm.papers.finding import ROTARY, Claim, Finding, unstated
from hexarm.simulation.experiment import Recording, noisy, position_rms, run, unshifted
from hexarm.simulation.limit_search import FREQUENCY, PAPER_AMPLITUDE, corners_out, in_phase
from hexarm.simulation.simulation import Simulation
from manipulator.planning.cycle import Cycle

DRAWS = {1: 12, 3: 20, 6: 12}
"""How many motions with noise are simulated on one, three and six servos."""


@dataclass(frozen=True, eq=False)
class Dynamics:
    """What was found, with the recording for fig. 13."""

    findings: list[Finding]
    recording: Recording


def reproduced(with_noise: bool) -> Dynamics:
    """The sinusoids of fig. 12, one at the paper's limits, the same with noise if asked for."""
    machine = machines.load(MACHINE)
    amplitude = np.array(PAPER_AMPLITUDE)
    cycle = in_phase(machine.kinematics.home, amplitude, FREQUENCY)
    recording = simulated(cycle, 2.0)
    found = [
        *sinusoid(recording, corners_out(machine, amplitude)),
        at_the_limits(),
        *(noise_in_motion(cycle) if with_noise else ()),
    ]
    return Dynamics(found, recording)


def simulated(cycle: Cycle, periods: float) -> Recording:
    """RoboCake's model in this motion."""
    kinematics = machines.load(MACHINE).kinematics
    home = kinematics.home
    simulation = Simulation(modelled(MACHINE), home, kinematics.inverse(home))
    return run(simulation, kinematics, cycle, periods, unshifted)


def sinusoid(recording: Recording, out: int) -> Iterator[Finding]:
    """Fig. 12 in phase, fast enough for 50 mm/s."""
    speed, acceleration, torque, rate = _largest(recording)
    yield Finding(
        'fig_12', ROTARY, 'sinusoids of fig. 12',
        unstated('frequencies and phases not in the text'),
        f'all in phase at {FREQUENCY} Hz: {speed:.1f} mm/s, {acceleration:.4f} g',
        (speed, acceleration), 'mm/s and g', 2e-2,
        f'of the 64 corners that other phases may reach, {out} are outside the workspace',
    )  # fmt: skip
    yield Finding(
        'fig_12_torque', ROTARY, 'torque in this motion with 150 g', unstated(),
        f'≤ {both_units(torque)}', (torque,), 'N·cm', 0.02,
        'a tenth of the acceleration at which the paper gives its limits',
    )  # fmt: skip
    yield Finding(
        'fig_12_speed', ROTARY, 'crank speed in this motion',
        Claim('below 600 °/s, with a margin', (600.0,), side='at most'), f'≤ {rate:.0f} °/s',
        (rate,), '°/s', 1.0, 'the fastest crank',
    )  # fmt: skip


def at_the_limits() -> Finding:
    """A sine on z alone that reaches both 50 mm/s and 0.3 g, with 150 g, in simulation."""
    frequency = round(PAPER.acceleration / PAPER.speed / (2 * np.pi), 3)
    height = PAPER.speed / (2 * np.pi * frequency)
    home = machines.load(MACHINE).kinematics.home
    speed, acceleration, torque, _ = _largest(
        simulated(in_phase(home, height * np.eye(6)[2], frequency), 8.0)
    )
    return Finding(
        'operating_simulated', ROTARY, 'torque of a sine on z with 50 mm/s, 0.3 g, 150 g',
        unstated(), f'≤ {both_units(torque)} at {speed:.1f} mm/s, {acceleration:.2f} g',
        (torque,), 'N·cm', 0.02,
        f'{frequency:.2f} Hz, ±{1e3 * height:.2f} mm about home, in simulation',
    )  # fmt: skip


def noise_in_motion(cycle: Cycle) -> Iterator[Finding]:
    """The accuracy experiment in the moving model: what the platform is off by at each moment."""
    kinematics = machines.load(MACHINE).kinematics
    home = kinematics.home
    simulation = Simulation(modelled(MACHINE), home, kinematics.inverse(home))
    quiet, laws = run(simulation, kinematics, cycle, 1.0, unshifted), Laws(AS_UNIFORM)
    for law, errors in (('common', laws.common), ('independent', laws.independent)):
        means = {}
        for count, paper in PAPER_UM.items():
            squares = []
            for draw in range(DRAWS[count]):
                chosen = subsets(count)[draw % len(subsets(count))]
                shift = noisy(unshifted, errors.on(chosen), np.random.default_rng(draw))
                simulation.reset(home, kinematics.inverse(home))
                other = run(simulation, kinematics, cycle, 1.0, shift)
                squares.append(position_rms(quiet, other) ** 2)
            means[count] = 1e6 * float(np.sqrt(np.mean(squares)))
            yield Finding(
                f'noise_moving_{law}_{count}', ROTARY,
                f'{words(law)} on {NAMES[count]}, in the moving model',
                Claim(f'{paper} µm', (paper,), SAME * paper, HALF * paper),
                f'{means[count]:.1f} µm rms', (means[count],), 'µm', 0.02 * means[count],
                f'{DRAWS[count]} motions of fig. 12, new errors with every pulse (20 ms)',
            )  # fmt: skip
        yield conclusion(f'moving_{law}', means)


def _largest(recording: Recording) -> tuple[float, float, float, float]:
    """Speed in mm/s, acceleration in g, torque in N·cm, crank speed in °/s."""
    speed = np.linalg.norm(recording.twists[:, :3], axis=1).max()
    acceleration = np.linalg.norm(recording.accelerations[:, :3], axis=1).max()
    torque, rate = np.abs(recording.efforts).max(), np.abs(recording.rates).max()
    return (
        1e3 * float(speed), float(acceleration) / G, float(torque) / N_CM,
        float(np.degrees(rate)),
    )  # fmt: skip
