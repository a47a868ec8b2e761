"""From a machine file's sections to a parallel platform that the nodes can use."""

from functools import partial

import numpy as np

from hexapod_control.bodies import platform_bodies
from hexapod_control.geometry import LEGS, HexagonConfig, JointsConfig, check_architecture
from hexapod_control.home import home_problems
from hexapod_control.leg_limits import LinearLimits, RailLimits, RotaryLimits
from hexapod_control.linear import LinearPlatform
from hexapod_control.linear_geometry import PlatesConfig, PointsConfig
from hexapod_control.parallel_platform import ParallelPlatform
from hexapod_control.rails import RailPlatform, RailsConfig
from hexapod_control.rotary import RotaryHexapod
from manipulator.arrays import Array
from manipulator.errors import ConfigError
from manipulator.formatting import not_one_of
from manipulator.limits.constraints import Constraints
from manipulator.machine import Kind, Machine, MachineFile
from manipulator.motion_limits import MotionLimits
from manipulator.teleop.platform_jogger import PlatformJogger

Parts = tuple[ParallelPlatform, Constraints]
SETTINGS = 8
"""How many settings of the joints must all be singular for the architecture to be so."""


def hexapod(machine_file: MachineFile) -> Machine:
    """The machine of one file; ConfigError names each fault, also a home beyond a limit."""
    machine = platform(machine_file)
    beyond = home_problems(machine, 'crank_tangents' in machine_file.geometry)
    if beyond:
        raise ConfigError(beyond)
    return machine


def platform(machine_file: MachineFile) -> Machine:
    """The same, but that its home may be beyond limits."""
    kind = machine_file.kind
    if kind not in KINDS:
        raise ConfigError([f'kind: {not_one_of(kind, sorted(KINDS))}'])
    kinematics, constraints = KINDS[kind].build(machine_file)
    motion = MotionLimits.from_config(machine_file.motion, kinematics.joint_unit)
    return Machine(
        kinematics,
        constraints,
        motion,
        make_jogger=PlatformJogger,
        make_bodies=partial(platform_bodies, kinematics),
    )


def rotary_hexapod(geometry: JointsConfig | HexagonConfig, limits: RotaryLimits) -> Parts:
    """A crank platform; its geometry by the paper's parameters, or by joint coordinates."""
    kinematics = RotaryHexapod(
        geometry.geometry(),
        limits.characteristic_length_mm * 1e-3,
        limits.singularity_margin,
        limits.crank_middles,
    )
    _check_architecture(kinematics, limits.crank_ranges)
    return kinematics, limits.constraints(kinematics)


def linear_hexapod(geometry: PointsConfig | PlatesConfig, limits: LinearLimits) -> Parts:
    """A platform on linear legs; its geometry by the paper's parameters, or by coordinates."""
    kinematics = LinearPlatform(
        geometry.geometry(), limits.characteristic_length_mm * 1e-3, limits.singularity_margin
    )
    return kinematics, limits.constraints(kinematics)


def rail_hexapod(geometry: RailsConfig, limits: RailLimits) -> Parts:
    """A platform on struts whose lower ends slide on rails."""
    kinematics = RailPlatform(
        geometry.geometry(),
        limits.characteristic_length_mm * 1e-3,
        limits.singularity_margin,
        limits.rail_ranges,
    )
    _check_architecture(kinematics, limits.rail_ranges)
    return kinematics, limits.constraints(kinematics)


def _check_architecture(kinematics: ParallelPlatform, ranges: tuple[Array, Array]) -> None:
    """As `check_architecture`, with the joints anywhere in their ranges."""
    joints = np.random.default_rng(1).uniform(*ranges, (SETTINGS, LEGS))
    points = kinematics.geometry.platform_points
    check_architecture(kinematics.base_points(joints), points)


KINDS = {
    'rotary_hexapod': Kind(HexagonConfig | JointsConfig, RotaryLimits, rotary_hexapod),
    'linear_hexapod': Kind(PlatesConfig | PointsConfig, LinearLimits, linear_hexapod),
    'rail_hexapod': Kind(RailsConfig, RailLimits, rail_hexapod),
}
