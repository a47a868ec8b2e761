"""One jog tick of the executor with a jog mode, against one 6×6 linear solve in the same run."""

import time

import numpy as np

from bench.row import Row, interleaved_medians
from hexarm.machines import load
from manipulator.teleop.jog_modes import Feedback
from manipulator.teleop.modes import jog_mode
from manipulator.trajectory.executor import Executor
from manipulator.trajectory.jogging import JogCommand

TICK, ROUNDS, PERIOD, MOST_SOLVES = 0.01, 3000, 200, 8
MACHINES = ('robocake', 'stewart_6_3', 'arm_6r')


def rows() -> list[Row]:
    return [row for name in MACHINES for row in tick_rows(name)]


def tick_rows(name: str) -> list[Row]:
    """To and fro about home, with the orientation held; CPU time of the same ticks at p99."""
    executor, command = jogged(name)
    rng = np.random.default_rng(1)
    matrices, right = rng.normal(size=(ROUNDS, 6, 6)), rng.normal(size=6)
    taken = []

    def tick(k: int) -> None:
        before = time.thread_time_ns()
        executor.jog(command[k % PERIOD])
        executor.step()
        taken.append(time.thread_time_ns() - before)

    solve, one = interleaved_medians([lambda k: np.linalg.solve(matrices[k], right), tick], ROUNDS)
    p99 = float(np.percentile(taken, 99)) * 1e-6
    return [
        tick_row(name, one / solve),
        Row(f'{name}: one jog tick of the executor, CPU at p99', f'{p99:.3f} ms', '≤ 1', p99 <= 1),
    ]


def tick_row(name: str, ratio: float) -> Row:
    shown = f'{name}: one jog tick of the executor', f'{ratio:.0f} × a 6×6 solve'
    return Row(*shown, f'≤ {MOST_SOLVES}', ratio <= MOST_SOLVES)


def jogged(name: str) -> tuple[Executor, list[JogCommand]]:
    machine = load(name)
    home = machine.kinematics.home
    executor = Executor(machine, home, machine.kinematics.inverse(home), TICK)
    mode = jog_mode('hold_orientation', Feedback.for_delay(0.0))
    speed = 0.3 * machine.motion.linear.speed
    angles = 2 * np.pi * np.arange(PERIOD) / PERIOD
    twists = np.stack([speed * np.cos(angles), speed * np.sin(angles)] + [0 * angles] * 4, axis=1)
    return executor, [JogCommand('cmd_vel/joy', twist, '', mode) for twist in twists]
