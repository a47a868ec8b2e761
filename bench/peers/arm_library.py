"""What is asked of a library about the UR5, in turns with ours, and what counts as solved."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from arm_control.arm import SerialArm
from arm_control.geometry import DhConfig
from arm_control.numerical import Numerical
from bench.peers.published_arms import TABLES
from bench.row import Row, interleaved_medians
from hexarm.machines import load
from manipulator.arrays import Array
from manipulator.config import build
from manipulator.pose import Pose

ROUNDS, PROBLEMS = 1000, 100
STARTS = {'start within ±0.2 rad': 0.2, 'start anywhere': np.pi}
SOLVED = 1e-5  # metres, radians
SHARE = 0.15  # of another's time, that our inverse may take


@dataclass(frozen=True)
class ArmLibrary:
    """A library's UR5: joints to pose (4, 4) and Jacobian (6, 6), pose and start to joints.

    The Jacobian's rows are v of the tool point, then ω, in base axes. pose is forward into what
    ours returns, where the library holds position and rotation by themselves.
    """

    name: str
    forward: Callable[[Array], Array]
    jacobian: Callable[[Array], Array] | None
    inverse: Callable[[Array, Array], Array | None] | None
    pose: Callable[[Array], Pose] | None = None


def compared(library: ArmLibrary) -> list[Row]:
    """All that this library can do, and how far it agrees with ours."""
    found = [agreement_row(library), *speed_rows(library)]
    if library.inverse is None:
        return found
    for where, spread in STARTS.items():
        seconds, own, solved, _ = tried(library.inverse, spread)
        text = f'{1e6 * seconds:.0f} µs, {100 * solved:.1f} % solved'
        ratio = f'our closed form {1e6 * own:.1f} µs = {own / seconds:.2f}×'
        name, reached = f'{library.name}: inverse, {where}', own <= SHARE * seconds
        found.append(Row(name, f'{text}; {ratio}', f'≤ {SHARE}×', reached))
    return found


def compared_without_closed_form(
    name: str, inverse: Callable[[Array, Array], Array | None]
) -> list[Row]:
    """Another's inverse and ours of a PUMA whose wrist axes do not meet, from anywhere."""
    arm = skew_puma()
    seconds, own, solved, ours = tried(inverse, np.pi, arm)
    text = f'{1e6 * seconds:.0f} µs, {100 * solved:.1f} % solved'
    text += f'; ours {1e6 * own:.0f} µs = {own / seconds:.2f}×, {100 * ours:.1f} %'
    reached = own <= seconds and ours >= solved
    return [Row(f'{name}: inverse without a closed form', text, '≤ 1×, as many', reached)]


def skew_puma() -> SerialArm:
    """Ours, of the table that the others get, with whole turns of every joint."""
    rows = [
        {'a_mm': 1e3 * a, 'alpha_deg': np.degrees(alpha), 'd_mm': 1e3 * d}
        for a, alpha, d in TABLES['skew_puma']
    ]
    puma = load('puma560').kinematics
    chain = build(DhConfig, {'dh': rows, 'home_deg': [0.0] * 6}).chain()
    limits = replace(puma.limits, low=np.full(6, -np.pi), high=np.full(6, np.pi))
    return SerialArm(chain, limits, puma.characteristic_length, np.zeros(6))


def our_rows() -> list[Row]:
    """The same problems for our inverses."""
    arm = load('ur5').kinematics
    numerical = Numerical(arm.chain, arm.characteristic_length, arm.limits.low, arm.limits.high)

    def closed_form(pose: Array, near: Array) -> Array:
        return arm.inverse(Pose(pose[:3, 3], pose[:3, :3]), near)

    def newton(pose: Array, near: Array) -> Array:
        branches = numerical.branches(Pose(pose[:3, 3], pose[:3, :3]), near)
        return branches[np.isfinite(branches[:, 0]).argmax()]

    found = []
    for name, inverse in (
        ('ours, closed form (nearest of 8 branches)', closed_form),
        ('ours, numerical (elimination)', newton),
    ):
        for where, spread in STARTS.items():
            seconds, _, solved, _ = tried(inverse, spread)
            text = f'{1e6 * seconds:.0f} µs, {100 * solved:.1f} % solved'
            found.append(Row(f'{name}: inverse, {where}', text, '100 %', bool(solved == 1)))
    return found


def agreement_row(library: ArmLibrary) -> Row:
    arm = load('ur5').kinematics
    worst = 0.0
    for q in np.random.default_rng(1).uniform(-np.pi, np.pi, (100, 6)):
        worst = max(worst, np.abs(library.forward(q) - square(arm.chain.forward(q))).max())
        if library.jacobian is not None:
            worst = max(worst, np.abs(library.jacobian(q) - arm.chain.jacobian(q)).max())
    what = 'pose and Jacobian' if library.jacobian else 'pose'
    return Row(
        f'{library.name}: {what} against ours',
        f'{worst:.1e} m or rad',
        '≤ 1e-9',
        bool(worst <= 1e-9),
    )


def speed_rows(library: ArmLibrary) -> list[Row]:
    chain = load('ur5').kinematics.chain
    joints = np.random.default_rng(2).uniform(-np.pi, np.pi, (ROUNDS, 6))
    found = []
    for what, task, own_task, has_goal in (
        ('forward', library.forward, chain.forward, library.pose is None),
        ('forward into a Pose', library.pose, chain.forward, True),
        ('Jacobian', library.jacobian, chain.jacobian, True),
    ):
        if task is None:
            continue
        pair = task, own_task
        theirs, own = interleaved_medians([lambda k, f=f: f(joints[k]) for f in pair], ROUNDS)
        text = f'{1e6 * theirs:.1f} µs, ours {1e6 * own:.1f} µs = {own / theirs:.2f}×'
        goal, reached = ('≤ 1×', own <= theirs) if has_goal else ('', True)
        found.append(Row(f'{library.name}: {what}', text, goal, reached))
    return found


def tried(
    inverse: Callable[[Array, Array], Array | None], spread: float, arm: SerialArm | None = None
) -> tuple[float, float, float, float]:
    """Seconds of this inverse and, in turns, of our own; the shares of poses that both reached.

    Goals are anywhere; starts differ from a solution by at most `spread` (rad) in each joint.
    """
    arm, random = arm or load('ur5').kinematics, np.random.default_rng(3)
    goals = random.uniform(-np.pi, np.pi, (PROBLEMS, 6))
    starts = goals + random.uniform(-spread, spread, (PROBLEMS, 6))
    poses = arm.chain.forward(goals)
    each = [poses[k] for k in range(PROBLEMS)]
    squares = [square(pose) for pose in each]
    answers: tuple[list[Array | None], list[Array | None]] = ([], [])
    seconds, own = interleaved_medians(
        [
            lambda k: answers[0].append(inverse(squares[k], starts[k])),
            lambda k: answers[1].append(arm.inverse_or_nan(each[k], starts[k])),
        ],
        PROBLEMS,
    )
    return seconds, own, *(solved(arm, poses, joints) for joints in answers)


def solved(arm: SerialArm, poses: Pose, answers: list[Array | None]) -> float:
    """The share of the poses that the answers reach; None is no answer."""
    joints = np.array([np.zeros(6) if q is None else np.nan_to_num(q) for q in answers])
    misses = np.abs(poses.twist_to(arm.chain.forward(joints)))
    return float((misses < SOLVED).all(axis=1).mean())


def square(pose: Pose) -> Array:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = pose.rotation, pose.position
    return matrix
