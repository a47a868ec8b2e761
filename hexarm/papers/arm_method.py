"""The method of Fadeev and Loginov on their arm: eq. (1), velocities, the three projections."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from arm_control.arm import SerialArm
from arm_control.load import jogging
from hexarm import machines
from hexarm.papers.arm_ways import Trigonometry, by_equations, by_triangles, by_velocities
from hexarm.papers.finding import ARM, Claim, Finding, unstated
from hexarm.papers.paper_arm import (
    PaperArm,
    joint_rates,
    nine_projections,
    projection_rates,
    projections,
    velocity_towards,
    wrist_factors,
)
from manipulator import rotation as so3
from manipulator.arrays import Array
from manipulator.errors import InvalidInput, NoSolution

MACHINE = 'arm_6r'
PAPER_ARM = PaperArm(0.3, 0.4, 0.4)
TOOL = 0.12
"""From the wrist centre to the tool's point, metres."""
START = np.radians([10.0, 20.0, 80.0, 20.0, 50.0, 30.0])
TICK, SECONDS = 0.01, 2.0
VELOCITY = np.array([0.1, -0.05, 0.05])
EXACT = 1e-12
FOLLOWS_UM, ROUGHLY_UM = 10.0, 1000.0
HELD_DEG, ROUGHLY_DEG = 0.05, 1.0
POSTURES = 500
SINE_OF_C167_MS = 2.0


def findings() -> Iterator[Finding]:
    """Formulas; the path with and without measurements; the orientation; the ways compared."""
    yield from formulas()
    yield from feedback()
    yield held()
    yield from false_singularities()
    yield rebuilt()
    yield from calls()


@dataclass(frozen=True, eq=False)
class Path:
    """A motion of two seconds by the paper's method: µm off at its end, degrees off all along."""

    position: float
    turned: Array


def shipped_arm() -> SerialArm:
    """The arm with the paper's scheme; the lengths are ours, the paper gives none."""
    return jogging(machines.read(MACHINE)).arm


def random_joints() -> Array:
    """Postures (500, 6) all over the joints' ranges."""
    return np.random.default_rng(3).uniform(-2.0, 2.0, (POSTURES, 6))


def formulas() -> Iterator[Finding]:
    """Eq. (1) and the three projections against the chain of rotations."""
    joints = random_joints()
    tool = shipped_arm().chain.forward(joints)
    centre = tool.position - TOOL * tool.rotation[..., 2]
    shown, r = projections(joints), tool.rotation
    parts = {
        'eq_1': ('wrist centre, eq. (1)', centre - PAPER_ARM.position(joints), 'm', ''),
        'a_x': (
            'a_x, with the sign of eq. (1)', shown[..., 0] - r[..., 0, 2], '',
            'printed with the opposite sign, which contradicts eq. (1): it must be −s1·s23 at '
            'q4 = q5 = 0',
        ),
        'a_x_printed': (
            'a_x as printed', -shown[..., 0] - r[..., 0, 2], '', 'the sign, as above',
        ),
        'a_z': ('a_z', shown[..., 1] - r[..., 2, 2], '', 'as printed'),
        'n_z': ('n_z', shown[..., 2] + r[..., 2, 1], '', 'as printed, with n = −y of R06'),
    }  # fmt: skip
    for key, (topic, gaps, unit, reason) in parts.items():
        worst = float(np.abs(gaps).max())
        yield Finding(
            key, ARM, topic, Claim('a formula', (0.0,), EXACT),
            f'off by {worst:.1g}' + (f' {unit}' if unit else ''), (worst,), unit,
            max(EXACT, 1e-9 * worst), reason or f'against the chain of rotations, {POSTURES} '
            'postures',
        )  # fmt: skip


def followed(is_measured: bool) -> Path:
    """A straight line by X' = (Xₙ − Xₙ₋₁)/T with a_x' = a_z' = n_z' = 0."""
    q, before = START, PAPER_ARM.position(START)
    begin, chain, turned = before, shipped_arm().chain, []
    first = chain.forward(START).rotation
    for t in np.arange(TICK, SECONDS, TICK):
        target = begin + t * VELOCITY
        known = PAPER_ARM.position(q) if is_measured else before
        q = q + TICK * joint_rates(PAPER_ARM, q, velocity_towards(target, known, TICK))
        before = target
        turn = so3.log(first.T @ chain.forward(q).rotation)
        turned.append(np.degrees(np.linalg.norm(turn)))
    off = 1e6 * float(np.linalg.norm(PAPER_ARM.position(q) - before))
    return Path(off, np.array(turned))


def feedback() -> Iterator[Finding]:
    """The end of the line, with measured positions and without."""
    reasons = {
        'measured': 'only the error of the last step remains',
        'computed': 'the errors of the steps accumulate',
    }
    for kind, reason in reasons.items():
        off = followed(kind == 'measured').position
        yield Finding(
            f'feedback_{kind}', ARM, f'Xₙ₋₁ {kind}: deviation from the line after 2 s',
            Claim('follows', (0.0,), FOLLOWS_UM, ROUGHLY_UM), f'{off:.2f} µm', (off,), 'µm',
            0.01 * off, reason,
        )  # fmt: skip


def held() -> Finding:
    """How far the tool turns meanwhile."""
    turned = float(followed(is_measured=True).turned.max())
    return Finding(
        'projections_held', ARM, 'orientation by a_x′ = a_z′ = n_z′ = 0 over these 2 s',
        Claim('held', (0.0,), HELD_DEG, ROUGHLY_DEG), f'turns by ≤ {turned:.4f}°', (turned,), '°',
        0.01 * turned, 'steps of 10 ms; nothing corrects what they add up to. The modes below do',
    )  # fmt: skip


def false_singularities() -> Iterator[Finding]:
    """Orientations that the three projections cannot hold, though the wrist is regular there."""
    chain = shipped_arm().chain
    for axis, joint in (('a_y', 0), ('s_z', 5)):
        q = at_false_singularity(axis, joint)
        system = float(np.linalg.svd(projection_rates(q)[:, 3:], compute_uv=False)[-1])
        wrist = float(np.linalg.svd(chain.jacobian(q)[3:, 3:], compute_uv=False)[-1])
        try:
            joint_rates(PAPER_ARM, q, VELOCITY)
            answer = 'the method goes on'
        except NoSolution:
            answer = 'the method has no solution'
        yield Finding(
            f'false_singularity_{axis}', ARM, f'{axis} = 0: σmin of the wrist’s axes', unstated(),
            f'{wrist:.3f}, of the three projections {system:.0e}', (wrist,), '', 1e-3,
            f'{answer}, the arm could: det = sin q5 · a_y · s_z',
        )  # fmt: skip


def at_false_singularity(axis: str, joint: int) -> Array:
    """START with one joint turned until a_y or s_z vanishes, by bisection."""
    name = next(key for key in wrist_factors(START) if key.endswith(axis))
    angles = np.radians(np.linspace(-90.0, 90.0, 181))

    def factor(angle: float) -> float:
        q = START.copy()
        q[joint] = angle
        return wrist_factors(q)[name]

    values = [factor(angle) for angle in angles]
    changes = np.flatnonzero(np.diff(np.sign(values)))
    if not changes.size:
        raise InvalidInput(f'{axis} does not vanish for any angle of joint {joint + 1}')
    low, high = angles[changes[0]], angles[changes[0] + 1]
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if factor(low) * factor(middle) > 0 else (low, middle)
    found: Array = START.copy()
    found[joint] = low
    return found


def rebuilt() -> Finding:
    """All nine projections from three, with the signs of a nearby orientation."""
    chain, worst = shipped_arm().chain, 0.0
    for q in random_joints():
        r = chain.forward(q).rotation
        nine = np.stack([r[:, 2], -r[:, 1], r[:, 0]])
        near = (r @ so3.exp(np.array([0.02, -0.01, 0.02]))).T[[2, 1, 0]] * [[1], [-1], [1]]
        found = nine_projections(np.array([nine[0, 0], nine[0, 2], nine[1, 2]]), near)
        worst = max(worst, float(np.abs(found @ found.T - np.eye(3)).max()))
        worst = max(worst, float(np.abs(projections(q) - found[[0, 0, 1], [0, 2, 2]]).max()))
    return Finding(
        'nine_projections', ARM, 'the other six of nine projections from three',
        Claim('easily computed', (0.0,), 1e-9), f'off by {worst:.0e}', (worst,), '', 1e-9,
        'by four solutions, of which the nearest to the last known one: three projections alone '
        'do not give the orientation',
    )  # fmt: skip


def calls() -> Iterator[Finding]:
    """Trigonometric calls of a step of each way, counted."""
    counts = counted()
    position, whole = counts['position by velocities'], counts['velocities']
    yield Finding(
        'calls_position', ARM, 'values of sin and cos in a step, position alone',
        Claim('six', (6.0,)), f'{position}', (float(position),), '', 0.5,
        'of q1, q2 and q2 + q3',
    )  # fmt: skip
    spent = SINE_OF_C167_MS * whole
    yield Finding(
        'calls_whole', ARM, 'values of sin and cos in a step, with the orientation',
        Claim('six (12 ms of less than 20 ms)', (6.0,)), f'{whole}', (float(whole),), '', 0.5,
        f'q4, q5 and q6 as well: {spent:g} ms at 2 ms each, so that a step takes more than 20 ms '
        'unless sin and cos of an angle come together',
    )  # fmt: skip
    geometric, algebraic = counts['triangles'], counts['equations']
    yield Finding(
        'calls_geometric', ARM, 'trigonometric calls by triangles (second way)',
        Claim('more than by velocities (third way)', (float(whole + 1),), side='at least'),
        f'{geometric}, by velocities {whole}, by the equations (first way) {algebraic}',
        (float(geometric),), '', 0.5,
        'arcus functions counted like sin and cos; both closed forms give the whole pose, not its '
        'change',
    )  # fmt: skip


def counted() -> dict[str, int]:
    """Calls by way; the closed forms give START back, or the count would be of something else."""
    tool = shipped_arm().chain.forward(START)
    centre = PAPER_ARM.position(START)
    found = {}
    for name, way in (('equations', by_equations), ('triangles', by_triangles)):
        use = Trigonometry()
        if np.abs(way(PAPER_ARM, centre, tool.rotation, use) - START).max() > EXACT:
            raise NoSolution(f'the inverse by {name} does not give the joints back')
        found[name] = use.calls.total()
    for name, whole in (('velocities', True), ('position by velocities', False)):
        use = Trigonometry()
        by_velocities(START, use, whole)
        found[name] = use.calls.total()
    return found
