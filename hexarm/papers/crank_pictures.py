"""Figures of Prokopovich 2019: kinematics, workspace, crank speeds, the model, noise, limits."""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D

from hexapod_control.geometry import LEGS
from hexapod_control.rotary import RotaryHexapod
from hexarm import machines
from hexarm.cli.export import modelled
from hexarm.papers.crank_kinematics import MACHINE, SPEED, along_x, crank_speeds, free
from hexarm.papers.crank_limits import N_CM, SERVO, G, Searches
from hexarm.papers.crank_noise import AS_UNIFORM, NAMES, PAPER_UM, Laws, subsets
from hexarm.pictures import style
from hexarm.pictures.style import JOINTS
from hexarm.simulation.limit_search import (
    FREQUENCY,
    PAPER_AMPLITUDE,
    Demand,
    in_phase,
    poses_of,
)
from manipulator.analysis.accuracy import JointErrors, linear_spread
from manipulator.analysis.inside import surface
from manipulator.arrays import Array
from manipulator.kinematics import Kinematics
from manipulator.pose import Pose

if TYPE_CHECKING:
    from hexarm.simulation.experiment import Recording

DPI, SENSORS_DPI = 90, 75
BLUE, RED, INK = '#0b6e99', '#b3261e', '#22313f'
REACH = 0.015
"""To either side of home along x, metres: the amplitude of fig. 9 is not in the text."""
RINGS, SECTORS = 31, 61
STEPS = 400
CAPTIONS = {
    'fig-8.png': 'RoboCake as plane figures, with the body’s upper edge in red, and the positions '
    'that its centre reaches level, by geometry alone (Prokopovich 2019, fig. 8)',
    'fig-9.png': 'Crank angles and speeds over a cycle of x at 30 mm/s, ±15 mm (Prokopovich 2019, '
    'fig. 9)',
    'fig-11.png': 'The rigid-body model at home, in MuJoCo (Prokopovich 2019, fig. 11)',
    'noise.png': 'Position error along the sinusoids of fig. 12, σ = 1/6° on one, three and six '
    'servos: mean over the choices of servos, dotted the paper’s figures',
    'fig-13.png': 'Sensors on the sinusoids of fig. 12 in phase, with 150 g (Prokopovich 2019, '
    'figs 12 d and 13)',
    'limits.png': 'Torque and crank speed over payload, speed and acceleration, ±10 mm on x, y, z '
    '(Prokopovich 2019, fig. 13)',
}


def _kinematics() -> RotaryHexapod:
    kinematics = machines.load(MACHINE).kinematics
    assert isinstance(kinematics, RotaryHexapod)
    return kinematics


def kinematic_scheme(path: Path) -> None:
    """Fig. 8."""
    kinematics = _kinematics()
    figure: Figure = plt.figure(figsize=(9, 4.2), dpi=DPI)
    scheme: Axes3D = figure.add_axes((0.0, 0.0, 0.52, 0.95), projection='3d')
    radius = machines.read(MACHINE).geometry['body_radius_mm']
    lid = machines.read(MACHINE).limits['minimum_height_mm']
    angles = kinematics.inverse(kinematics.home)
    centres, tips = kinematics.geometry.crank_centres, kinematics.crank_tips(angles)
    ends = kinematics.home.transform(kinematics.geometry.platform_points)
    _outline(scheme, _hexagon(radius, 0.0), BLUE)
    _outline(scheme, _hexagon(radius, lid), RED)
    _outline(scheme, 1e3 * ends, INK)
    for leg, colour in enumerate(JOINTS):
        bars = 1e3 * np.array([centres[leg], tips[leg], ends[leg]])
        scheme.plot(*bars.T, color=colour, lw=2.0, marker='o', ms=3)
    scheme.set(xlabel='x (mm)', ylabel='y (mm)', zlabel='z (mm)')
    scheme.set_aspect('equal', adjustable='box')
    scheme.set_zticks([0, 20, 40])
    scheme.view_init(elev=28, azim=-60)
    _drop(figure.add_axes((0.54, 0.06, 0.4, 0.9), projection='3d'))
    _saved(figure, path)


def _drop(axes: Axes3D) -> None:
    """The surface to which level straight ways from home lead, by closed legs and z ≥ 0."""
    polar, turn = np.meshgrid(
        np.linspace(0, np.pi, RINGS), np.linspace(0, 2 * np.pi, SECTORS), indexing='ij'
    )
    directions = np.stack(
        [np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar)], axis=-1
    )
    ends = surface(free(machines.load(MACHINE), 0.0), directions)
    x, y, z = np.moveaxis(1e3 * ends, -1, 0)
    axes.plot_surface(
        x, y, z, cmap='YlGnBu_r', rstride=1, cstride=1, lw=0.1, edgecolor='#ffffff90'
    )
    axes.set(xlabel='x (mm)', ylabel='y (mm)', zlabel='z (mm)')
    axes.set_aspect('equal', adjustable='box')
    axes.set(xticks=[-20, 0, 20], yticks=[-20, 0, 20])
    axes.view_init(elev=18, azim=-60)


def _hexagon(inradius: float, height: float) -> Array:
    corners = (np.arange(6) + 0.5) * np.pi / 3
    outer = 2 * inradius / np.sqrt(3)
    return np.column_stack([outer * np.cos(corners), outer * np.sin(corners), np.full(6, height)])


def _outline(axes: Axes3D, corners: Array, colour: str) -> None:
    closed = np.vstack([corners, corners[:1]])
    axes.plot(*closed.T, color=colour, lw=1.4)


def crank_cycle(path: Path) -> None:
    """Fig. 9: one cycle of x to and fro at 30 mm/s, over time."""
    machine = machines.load(MACHINE)
    period = 4 * REACH / SPEED
    times = np.linspace(0.0, period, STEPS, endpoint=False) + period / STEPS / 2
    turn = (times / period + 0.25) % 1.0
    places = REACH * (1.0 - 4.0 * np.abs(turn - 0.5))
    going = np.where(turn < 0.5, 1.0, -1.0)
    angles = np.degrees(machine.kinematics.inverse(along_x(machine, places)))
    speeds = going[:, None] * crank_speeds(machine, places)
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.4), dpi=DPI, layout='constrained')
    for k in range(LEGS):
        axes[0].plot(times, angles[:, k], label=f'crank {k + 1}', **style.curve(k))
        axes[1].plot(times, speeds[:, k], **style.curve(k))
    axes[0].set(xlabel='time (s)', ylabel='crank angle (°)', xlim=(0, period))
    axes[1].set(xlabel='time (s)', ylabel='crank speed (°/s)', xlim=(0, period))
    figure.legend(frameon=False, ncols=6, loc='outside upper center')
    _finished(figure, axes, path)


def model_scene(path: Path) -> None:
    """Fig. 11; needs MuJoCo."""
    from hexarm.pictures.animation import (  # noqa: PLC0415 (needs mujoco)
        bounds_of,
        draw_scene,
        shapes,
    )
    from hexarm.simulation.simulation import Simulation  # noqa: PLC0415

    kinematics = _kinematics()
    home = kinematics.home
    scene = shapes(Simulation(modelled(MACHINE), home, kinematics.inverse(home)))
    figure: Figure = plt.figure(figsize=(5.4, 4.2), dpi=DPI)
    draw_scene(figure.add_axes((0, 0, 1, 1), projection='3d'), scene, bounds_of([scene]))
    _saved(figure, path)


def noise(path: Path) -> None:
    """The position error of one, three and six servos over a period, by both laws."""
    kinematics, laws = machines.load(MACHINE).kinematics, Laws(AS_UNIFORM)
    poses = poses_of(in_phase(kinematics.home, np.array(PAPER_AMPLITUDE), FREQUENCY))
    times = np.linspace(0.0, 1.0 / FREQUENCY, len(poses.position))
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.4), dpi=DPI, sharey=True, layout='constrained')
    for each, title, errors in (
        (axes[0], 'one signal on all servos', laws.common),
        (axes[1], 'a signal of its own for each servo', laws.independent),
    ):
        for (count, paper), colour in zip(PAPER_UM.items(), style.AXES, strict=True):
            label = NAMES[count] if each is axes[0] else None
            curve = _mean_error(kinematics, poses, errors, count)
            each.plot(times, curve, color=colour, lw=1.4, label=label)
            each.axhline(paper, color=colour, lw=0.9, ls=':')
        each.set_title(title, size=10)
        each.set(xlabel='time (s)', xlim=(0, times[-1]))
    axes[0].set(ylabel='position error, rms (µm)', ylim=(0, None))
    figure.legend(frameon=False, ncols=3, loc='outside upper center')
    _finished(figure, axes, path)


def _mean_error(kinematics: Kinematics, poses: Pose, errors: JointErrors, count: int) -> Array:
    """Rms position error (N,) in µm at each pose, the mean over the choices of servos."""
    each = [linear_spread(kinematics, poses, errors.on(s)).position_rms for s in subsets(count)]
    return np.asarray(1e6 * np.mean(each, axis=0))


def limits(path: Path) -> None:
    """Fig. 13 for every payload, acceleration and speed."""
    searches = Searches()
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.6), dpi=DPI, layout='constrained')
    payloads, speeds = np.linspace(0.0, 0.4, 21), np.linspace(0.0, 0.15, 16)
    for acceleration, colour in zip((0.1, 0.3, 1.0), style.AXES, strict=True):
        demands = [Demand(p, 0.05, acceleration * G) for p in payloads]
        torques = [max(c.torque for c in searches.costs(d)) / N_CM for d in demands]
        axes[0].plot(1e3 * payloads, torques, color=colour, lw=1.4, label=f'{acceleration:g} g')
    axes[0].axhspan(*SERVO, color=RED, alpha=0.12, label='1.8 … 2.5 N·cm')
    axes[0].plot([150.0], [_at_paper(searches)], 'o', color=RED, ms=5, label='the paper’s limits')
    axes[0].set(xlabel='payload (g)', ylabel='torque (N·cm)', xlim=(0, 400), ylim=(0, None))
    axes[0].set_title('at 50 mm/s; the servo gives 17.7 … 24.5 N·cm = 1.8 … 2.5 kg·cm', size=9)
    for k, name in enumerate('xyz'):
        rates = [searches.costs(Demand(0.15, v, 0.3 * G))[k].rate for v in speeds]
        axes[1].plot(1e3 * speeds, np.degrees(rates), label=f'{name} line', **style.axis(k))
    axes[1].axhline(600.0, color=RED, lw=0.9, ls='--')
    axes[1].set(xlabel='platform speed (mm/s)', ylabel='fastest crank (°/s)', xlim=(0, 150))
    for each in axes:
        each.legend(frameon=False, fontsize=8)
    _finished(figure, axes, path)


def _at_paper(searches: Searches) -> float:
    demand = Demand(0.15, 0.05, 0.3 * G)
    return max(c.torque for c in searches.costs(demand)) / N_CM


def sensors(recording: 'Recording', path: Path) -> None:
    """Figs 12 d and 13; needs MuJoCo."""
    from hexarm.pictures.simulation import draw  # noqa: PLC0415 (needs mujoco)
    from hexarm.simulation.model import dynamics_of  # noqa: PLC0415
    from hexarm.simulation.rigid_body import payload  # noqa: PLC0415

    load = payload(dynamics_of(machines.read(MACHINE)).payload)
    draw(recording, modelled(MACHINE), path, load, dpi=SENSORS_DPI)


PLAIN: dict[str, Callable[[Path], None]] = {
    'fig-8.png': kinematic_scheme,
    'fig-9.png': crank_cycle,
    'fig-11.png': model_scene,
    'noise.png': noise,
    'limits.png': limits,
}


def _finished(figure: Figure, axes: Iterable[Axes], path: Path) -> None:
    for each in axes:
        each.grid(True)
    _saved(figure, path)


def _saved(figure: Figure, path: Path) -> None:
    style.save(figure, path)
