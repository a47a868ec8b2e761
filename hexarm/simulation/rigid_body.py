"""Rigid bodies: mass, centre and inertia, and those of the shapes that estimates are made of."""

from dataclasses import dataclass

import numpy as np

from hexarm.simulation.dynamics_config import LinkConfig, PayloadConfig, PlateConfig
from manipulator.arrays import Array, frozen


@dataclass(frozen=True, eq=False)
class RigidBody:
    """mass in kg, centre (3,) in m, inertia (3, 3) about the centre in kg·m²; one frame's axes."""

    mass: float
    centre: Array
    inertia: Array

    def __post_init__(self) -> None:
        """Freezes the arrays."""
        object.__setattr__(self, 'centre', frozen(self.centre))
        object.__setattr__(self, 'inertia', frozen(self.inertia))

    def with_body(self, other: 'RigidBody') -> 'RigidBody':
        """Both as one body (Steiner's theorem); both in the same frame."""
        mass = self.mass + other.mass
        centre = (self.mass * self.centre + other.mass * other.centre) / mass
        inertia = sum(b.inertia + _steiner(b.mass, b.centre - centre) for b in (self, other))
        return RigidBody(mass, centre, np.asarray(inertia))


def plate(config: PlateConfig, inradius: float) -> RigidBody:
    """The platform in its frame; without an inertia of its own, a hexagon of `inradius` metres."""
    mass, thickness = 1e-3 * config.mass_g, 1e-3 * config.thickness_mm
    if config.inertia_g_mm2 is not None:
        moments = 1e-9 * np.array(config.inertia_g_mm2)
    else:
        side = 2 * inradius / np.sqrt(3)
        across = mass * (5 / 24 * side**2 + thickness**2 / 12)
        moments = np.array([across, across, mass * 5 / 12 * side**2])
    return RigidBody(mass, 1e-3 * np.array(config.centre_mm), np.diag(moments))


def payload(config: PayloadConfig) -> RigidBody:
    """A cylinder that stands on the moving frame's xy plane."""
    mass, radius, height = (1e-3 * v for v in (config.mass_g, config.radius_mm, config.height_mm))
    across = mass * (3 * radius**2 + height**2) / 12
    inertia = np.diag([across, across, mass * radius**2 / 2])
    return RigidBody(mass, np.array([0.0, 0.0, height / 2]), inertia)


def rod(mass: float, radius: float, begin: Array, end: Array) -> RigidBody:
    """A round rod of even density between two points; a ball where they coincide."""
    along = np.asarray(end) - np.asarray(begin)
    length = float(np.sqrt(along @ along))
    centre = (np.asarray(begin) + np.asarray(end)) / 2
    if length < radius:
        return RigidBody(mass, centre, 0.4 * mass * radius**2 * np.eye(3))
    axis = np.outer(along, along) / length**2
    across = mass * (3 * radius**2 + length**2) / 12
    inertia = across * (np.eye(3) - axis) + mass * radius**2 / 2 * axis
    return RigidBody(mass, centre, inertia)


def link(config: LinkConfig, begin: Array, end: Array) -> RigidBody:
    """An arm's link between two joints, in base axes at zero angles."""
    body = rod(1e-3 * config.mass_g, 1e-3 * config.radius_mm, begin, end)
    centre, inertia = body.centre, body.inertia
    if config.centre_mm is not None:
        centre = 1e-3 * np.array(config.centre_mm)
    if config.inertia_g_mm2 is not None:
        inertia = np.diag(1e-9 * np.array(config.inertia_g_mm2))
    return RigidBody(body.mass, centre, inertia)


def _steiner(mass: float, offset: Array) -> Array:
    result: Array = mass * (offset @ offset * np.eye(3) - np.outer(offset, offset))
    return result
