"""Methods of the source papers: the plane of the platform, the arm's step on a controller."""

import numpy as np

from arm_control.load import jogging
from arm_control.resolved_rate import JogState
from bench.row import Row, interleaved_medians
from firmware.simulator import cycles
from hexapod_control.linear_geometry import PlatesConfig
from hexapod_control.workspace import sample
from hexarm import machines
from hexarm.board import build as firmware_build
from hexarm.papers.paper_arm import PaperArm, joint_rates
from hexarm.papers.plane_method import PlaneMethod
from manipulator.config import build

ROUNDS = 500
PLATFORMS = ('stewart_6_3', 'stewart_6_6')
C167_MS, MF167_MS = 20.0, 1.0  # Fadeev and Loginov: one step, without and with the coprocessor


def rows() -> list[Row]:
    planes = [row for name in PLATFORMS for row in plane_rows(name)]
    return [*planes, *arm_step_rows(), *board_rows()]


def plane_rows(name: str) -> list[Row]:
    """From home to poses of the whole workspace, as our Newton's method starts, too."""
    plates = build(PlatesConfig, machines.read(name).geometry)
    method, machine = PlaneMethod.of(plates), machines.load(name)
    kinematics = machine.kinematics
    poses = sample(machine, ROUNDS, np.random.default_rng(1))
    lengths = kinematics.inverse(poses)
    plane, newton = interleaved_medians(
        [
            lambda k: method.solve(lengths[k], kinematics.home),
            lambda k: kinematics.forward(lengths[k]),
        ],
        ROUNDS,
    )
    some = range(0, ROUNDS, 5)
    asked = np.mean([method.solve(lengths[k], kinematics.home).evaluations for k in some])
    newton_steps = np.mean([kinematics.forward(lengths[k]).iterations for k in some])
    text = f'{1e6 * plane:.0f} µs, ours {1e6 * newton:.0f} µs = {newton / plane:.2f}×'
    return [
        Row(f'{name}, forward from home: plane method', text, '≤ 1×', newton <= plane),
        Row(
            f'{name}, forward from home: evaluations of the equations',
            f'{asked:.1f}, ours {newton_steps:.1f} (means)',
        ),
    ]


def arm_step_rows() -> list[Row]:
    """The paper's differential step in Python, and our jog tick with all its limits."""
    jog = jogging(machines.read('arm_6r'))
    joints = np.array([0.1, 0.4, 1.2, 0.3, 0.9, 0.2])
    paper, velocity = PaperArm(0.3, 0.4, 0.4), np.array([0.1, -0.05, 0.02])
    state, twist = JogState.at_rest(joints), np.concatenate([velocity, np.zeros(3)])
    step, tick = interleaved_medians(
        [lambda _: joint_rates(paper, joints, velocity), lambda _: jog.step(state, twist, 0.02)],
        ROUNDS,
    )
    return [step_row('its method here, in Python', step), step_row('our jog tick here', tick)]


def board_rows() -> list[Row]:
    """The same step in C on the simulated board, where its compiler and simulator are."""
    missing = firmware_build.missing_tools()
    if missing:
        return [Row('arm step on the board', f'not built: no {", ".join(missing)}')]
    costs = cycles.costs()
    sine = costs[cycles.SINE].milliseconds
    return [
        step_row('on the simulated ATmega2560', 1e-3 * costs[cycles.ARM_STEP].milliseconds),
        Row('one sine: paper 2 ms on a C167', f'ATmega2560 {sine:.2f} ms', '≤ 2 ms', sine <= 2),
    ]


def step_row(where: str, seconds: float) -> Row:
    ms = 1e3 * seconds
    text = f'{ms:.3f} ms = {ms / C167_MS:.3f} of a C167, {ms / MF167_MS:.2f} of an MF167'
    return Row(f'arm step (paper: 20 ms, 1 ms): {where}', text, f'< {C167_MS:g} ms', ms < C167_MS)
