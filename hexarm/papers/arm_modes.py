"""The method, the modes and the step times of Fadeev and Loginov."""

from collections.abc import Iterator

import numpy as np

from arm_control.load import jogging
from arm_control.resolved_rate import JogState, ResolvedRate
from hexarm import machines
from hexarm.board import build as firmware_build
from hexarm.papers.finding import ARM, Finding, Verdict
from hexarm.papers.paper_arm import PaperArm, joint_rates, projections, velocity_towards
from manipulator.arrays import Array
from manipulator.pose import Pose
from manipulator.teleop.jog_modes import Feedback
from manipulator.teleop.jogger import within_speed
from manipulator.teleop.modes import jog_mode

MACHINE = 'arm_6r'
PAPER_ARM = PaperArm(0.3, 0.4, 0.4)
START = np.radians([10.0, 20.0, 80.0, 20.0, 50.0, 30.0])
TICK = 0.01
VELOCITY = np.array([0.1, -0.05, 0.05])
SIGHT = 0.35
MODE_TICKS = 300


def findings() -> Iterator[Finding]:
    """Eq. (1), the trajectory with and without measurements, the modes, and times on a chip."""
    yield position()
    yield from feedback()
    yield from modes()
    yield from step_times()


def position() -> Finding:
    """Eq. (1) and the approach axis against the chain of rotations."""
    chain = jogging(machines.read(MACHINE)).arm.chain
    joints = np.random.default_rng(3).uniform(-2.0, 2.0, (500, 6))
    tool = chain.forward(joints)
    centre = tool.position - 0.12 * tool.rotation[..., 2]
    worst = float(np.abs(centre - PAPER_ARM.position(joints)).max())
    shown = projections(joints)[..., :2]
    worst = max(worst, float(np.abs(shown - tool.rotation[..., [0, 2], 2]).max()))
    return Finding(
        'eq_1', ARM, 'wrist centre, eq. (1); a_x, a_z', 'formulas',
        f'equal to {worst:.0e} over 500 postures', worst, 1e-12, 'partly',
        'a_x is printed with the opposite sign, which contradicts eq. (1)',
    )  # fmt: skip


def feedback() -> Iterator[Finding]:
    """Two seconds of a straight line by X' = (Xₙ − Xₙ₋₁)/T."""
    told: tuple[tuple[str, Verdict, str], ...] = (
        ('measured', 'agrees', 'only the error of the last step remains'),
        ('computed', 'not stated', 'the errors of the steps accumulate'),
    )
    for kind, verdict, reason in told:
        q, before = START, PAPER_ARM.position(START)
        begin = before
        for t in np.arange(TICK, 2.0, TICK):
            target = begin + t * VELOCITY
            known = PAPER_ARM.position(q) if kind == 'measured' else before
            q = q + TICK * joint_rates(PAPER_ARM, q, velocity_towards(target, known, TICK))
            before = target
        off = 1e6 * float(np.linalg.norm(PAPER_ARM.position(q) - before))
        yield Finding(
            f'feedback_{kind}', ARM, f'Xₙ₋₁ {kind}: deviation from the line after 2 s', 'follows',
            f'{off:.2f} µm', off, 0.01 * off, verdict, reason,
        )  # fmt: skip


def modes() -> Iterator[Finding]:
    """Each way of keeping the gripper's orientation, over three seconds of motion at 100 Hz."""
    jog = jogging(machines.read(MACHINE))
    start = jog.arm.chain.forward(START)
    point = start.position + SIGHT * start.rotation[:, 2]
    across, turning = np.zeros(6), np.zeros(6)
    across[:3], turning[5] = 0.3 * VELOCITY, 0.2
    approach = np.sort(np.abs(_driven(jog, 'parallel', across)[-1].rotation[:, 2]))
    beside = float(np.arcsin(np.linalg.norm(approach[:2])))
    looking = _driven(jog, 'look_at', across, point)
    results = {
        'held constant': _angle(start.rotation, _driven(jog, 'hold_orientation', across)),
        'turned about z, point kept': max(
            float(np.linalg.norm(p.position - start.position))
            for p in _driven(jog, 'turn_base_z', turning)
        ),
        'parallel to an axis, at the end': beside,
        'pointing at one point': max(_off_sight(p, point) for p in looking),
    }
    for name, value in results.items():
        is_length = 'point kept' in name
        shown = f'{1e3 * value:.4f} mm' if is_length else f'{np.degrees(value):.4f}°'
        number = 1e3 * value if is_length else float(np.degrees(value))
        yield Finding(
            f'mode_{name.split()[0]}', ARM, f'orientation {name}', 'a mode',
            f'deviates by ≤ {shown}', number, 0.01, 'agrees',
            'closed loop on the pose; three projections would have false singularities',
        )  # fmt: skip


def step_times() -> Iterator[Finding]:
    """Clock cycles of one step of the same method in C, where chip and compiler are at hand."""
    if firmware_build.missing_tools():
        return
    found = firmware_build.step_times()
    for key, topic, paper in (
        ('step_time', 'one step of the method', '< 20 ms on a C167, ≤ 1 ms with MF167'),
        ('sine_time', 'one sine', '2 ms on a C167, 0.7 µs with MF167'),
    ):
        time = found[key]
        yield Finding(
            key, ARM, topic, paper, f'{time:.2f} ms on an ATmega2560 at 16 MHz', time, 0.05 * time,
            'agrees', 'single precision, on a simulated chip, exact to the clock cycle',
        )  # fmt: skip


def _driven(
    jog: ResolvedRate, name: str, command: Array, point: Array | None = None
) -> list[Pose]:
    forward, state = jog.arm.chain.forward, JogState.at_rest(START)
    poses = [forward(START)]
    held = jog_mode(name, Feedback.for_delay(TICK), point).latched(poses[0])
    for _ in range(MODE_TICKS):
        twist, held = held.step(command, poses[-1], poses[-1].position)
        state = jog.step(state, within_speed(twist, jog.motion)[0], TICK).state
        poses.append(forward(state.joints))
    return poses


def _angle(rotation: Array, poses: list[Pose]) -> float:
    first = Pose(np.zeros(3), rotation)
    return max(float(np.linalg.norm(first.twist_to(pose)[3:])) for pose in poses)


def _off_sight(pose: Pose, point: Array) -> float:
    sight = (point - pose.position) / np.linalg.norm(point - pose.position)
    sine = float(np.linalg.norm(np.cross(pose.rotation[:, 2], sight)))
    return float(np.arcsin(min(sine, 1.0)))
