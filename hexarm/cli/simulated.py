"""An experiment of `hexarm simulate`, and the largest values of its sensors."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from hexarm.simulation.compensation import Compensation
from hexarm.simulation.rigid_body import Mechanism, RigidBody
from manipulator.analysis.accuracy import JointErrors
from manipulator.arrays import Array
from manipulator.formatting import plain
from manipulator.machine import Machine
from manipulator.planning.cycle import Cycle

if TYPE_CHECKING:
    from hexarm.simulation.experiment import Recording

KG_CM, N_CM = 0.0980665, 0.01
G = 9.80665
ALL_OF_IT = 0.95
"""Share of a drive's free speed above which nothing is left to follow a faster motion."""


@dataclass(frozen=True)
class Experiment:
    """A machine, its model, and the cycle that it is to do: `part` of the amplitudes requested.

    corners_out is how many of the 64 poses with every amplitude at + or − are out of reach. load
    is what the moving frame carries, noise what the servos are off by, None for exact ones.
    """

    machine: Machine
    mechanism: Mechanism
    cycle: Cycle
    part: float
    corners_out: int
    compensation: Compensation
    is_compensated: bool
    load: RigidBody
    noise: JointErrors | None


def summary(this: Experiment, recording: 'Recording') -> dict[str, Any]:
    """Numbers for programs: SI units and radians."""
    errors = recording.errors
    speed = np.linalg.norm(recording.twists[:, :3], axis=1)
    acceleration = np.linalg.norm(recording.accelerations[:, :3], axis=1)
    return {
        'part_in_reach': this.part,
        'corners_out_of_reach': this.corners_out,
        'platform_speed': float(speed.max()),
        'platform_acceleration': float(acceleration.max()),
        'axis_speed': np.abs(recording.twists[:, :3]).max(axis=0).tolist(),
        'axis_acceleration': np.abs(recording.accelerations[:, :3]).max(axis=0).tolist(),
        'joint_speed': np.abs(recording.rates).max(axis=0).tolist(),
        'joint_effort': np.abs(recording.efforts).max(axis=0).tolist(),
        'is_compensated': this.is_compensated,
        'position_error': float(np.linalg.norm(errors[:, :3], axis=1).max()),
        'angle_error': float(np.linalg.norm(errors[:, 3:], axis=1).max()),
        'closure_error': float(recording.closure.max()),
    }


def in_words(this: Experiment, numbers: dict[str, Any]) -> list[str]:
    """The same for people."""
    drives, is_rotary = this.mechanism.drives, this.machine.kinematics.joint_unit == 'rad'
    effort, most = nearest_to(np.array(numbers['joint_effort']), drives.effort)
    speed, fastest = nearest_to(np.array(numbers['joint_speed']), drives.speed)
    factor, unit = (np.degrees(1.0), '°/s') if is_rotary else (1e3, 'mm/s')
    forces = f'{plain(effort)} {"N·m" if is_rotary else "N"} of {plain(most)}'
    if is_rotary and drives.effort.max() < 1.0:
        forces += f' ({effort / N_CM:.3g} N·cm, {effort / KG_CM:.3g} kg·cm of {most / KG_CM:.3g})'
    reach = f'of the 64 corners of the amplitudes {this.corners_out} are out of reach'
    if this.part < 1.0:
        reach += f'; the motion is done with {100 * this.part:.1f} % of the amplitudes'
    speeds = ', '.join(plain(1e3 * v, 3) for v in numbers['axis_speed'])
    accelerations = ', '.join(f'{v:.3g}' for v in numbers['axis_acceleration'])
    loops = f'loops        open by at most {1e3 * numbers["closure_error"]:.2g} mm'
    end, closed = ('platform', [loops]) if this.mechanism.closures else ('tool', [])
    noise = []
    if 'noise_position_rms' in numbers:
        moved = 1e6 * numbers['noise_position_rms']
        noise = [f'servo noise  moves the {end} by {moved:.1f} µm rms']
    return [
        reach,
        f'{end:<12} at most {plain(1e3 * numbers["platform_speed"], 3)} mm/s and '
        f'{numbers["platform_acceleration"]:.3g} m/s² = '
        f'{numbers["platform_acceleration"] / G:.3g} g',
        f'  on x, y, z at most {speeds} mm/s and {accelerations} m/s²',
        f'joint speed  at most {plain(factor * speed)} {unit} of {plain(factor * fastest)}',
        f'joint effort at most {forces}',
        _behind(numbers, speed > ALL_OF_IT * fastest),
        *closed,
        *noise,
    ]


def _behind(numbers: dict[str, Any], is_at_full_speed: bool) -> str:
    """The following error, and why where the drives have no speed left."""
    lag = 1e3 * numbers['position_error'], np.degrees(numbers['angle_error'])
    text = 'behind by    at most {:.3f} mm and {:.3f}°'.format(*lag)
    if not is_at_full_speed:
        return text
    return f'{text}: too fast for the drives, try a lower --frequency or --amplitude'


def nearest_to(values: Array, limits: Array) -> tuple[float, float]:
    """The value nearest to its limit, and that limit."""
    worst = int(np.argmax(values / limits))
    return float(values[worst]), float(limits[worst])
