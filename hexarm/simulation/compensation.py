"""What to add to commanded joints, so that sagging drives end where they were wanted.

A drive that gives the effort τ stands off its target by τ/stiffness (docs/physics.md, section 5):
the target is moved by as much, τ being the static load.
"""

from hexarm.simulation.drives import Drives
from hexarm.simulation.model import drives_of, dynamics_of
from hexarm.simulation.static_load import StaticLoad, static_load
from manipulator.arrays import Array
from manipulator.errors import ConfigError
from manipulator.kinematics import Kinematics
from manipulator.machine import MachineFile
from manipulator.pose import Pose
from manipulator.static_deflection import StaticDeflection


class Compensation:
    """Offsets for one machine's static load and drives."""

    def __init__(self, load: StaticLoad, drives: Drives) -> None:
        self._load = load
        self._drives = drives

    def __call__(self, pose: Pose, joints: Array) -> Array:
        """Offsets (..., n) in rad or m for poses (...) with joints (..., n).

        At most the drives' band, beyond which a drive has no more effort to give. NoSolution at a
        forward singularity.
        """
        offsets = self._load(pose, joints) / self._drives.stiffness
        band = self._drives.band
        clipped: Array = offsets.clip(-band, band)
        return clipped


def deflection_of(machine_file: MachineFile, kinematics: Kinematics) -> StaticDeflection:
    """The deflection that a machine's nodes compensate; ConfigError as `dynamics_of`.

    Refused for boards with encoders: what they report is where the joints are already.
    """
    if (machine_file.simulation or {}).get('joints') == 'measured':
        raise ConfigError(
            ['dynamics.compensation: true, but joints are measured (simulation.joints)']
        )
    dynamics = dynamics_of(machine_file)
    load = static_load(kinematics, dynamics)
    return Compensation(load, drives_of(dynamics, machine_file))
