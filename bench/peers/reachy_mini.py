"""Reachy Mini's compiled kinematics (Rust) against ours, both on Reachy Mini's head."""

import numpy as np
from reachy_mini_rust_kinematics import ReachyMiniRustKinematics

from bench.peers.reachy_geometry import CRANK, ROD, reachy_mini
from bench.row import Row, interleaved_medians
from hexapod_control.rotary import RotaryHexapod
from manipulator import rotation as so3
from manipulator.arrays import Array
from manipulator.errors import NoSolution
from manipulator.pose import Pose

BOXES = ((10e-3, np.radians(25.0)), (15e-3, np.radians(40.0)))
POSES, ROUNDS = 3000, 1000
TURN = 2 * np.pi
MOST_STEPS = 200
OWN_STEPS = 3  # what the maker's own program takes between two readings of the joints
SAME = 1e-4  # metres or radians: another mode is centimetres away


def rows() -> list[Row]:
    head, theirs = reachy_mini(), peer()
    small, joints = reachable(head, *BOXES[0])
    apart = max(
        np.abs(np.remainder(theirs.inverse_kinematics(matrix(p)) - q + np.pi, TURN) - np.pi).max()
        for p, q in zip(small[:500], joints[:500], strict=True)
    )
    text = f'{apart:.1e} rad'
    found = [Row('crank angles differ from Reachy Mini’s', text, '≤ 1e-9', bool(apart <= 1e-9))]
    found += speed_rows(head, theirs, small, joints)
    for box in BOXES:
        found += honesty_rows(head, theirs, box)
    return found


def peer() -> ReachyMiniRustKinematics:
    """Their solver with our geometry: its motor frames are our cranks' tangent, up and normal."""
    solver = ReachyMiniRustKinematics(CRANK * 1e-3, ROD * 1e-3)
    g = reachy_mini().geometry
    for leg in range(6):
        axes = np.stack([g.tangents[leg], g.ups[leg], g.normals[leg]], axis=1)
        elbow_out = 1.0
        solver.add_branch(
            g.platform_points[leg].tolist(), matrix(Pose(g.crank_centres[leg], axes)), elbow_out
        )
    return solver


def matrix(pose: Pose) -> list[list[float]]:
    square = np.eye(4)
    square[:3, :3], square[:3, 3] = pose.rotation, pose.position
    return square.tolist()


def reachable(head: RotaryHexapod, reach: float, turn: float) -> tuple[list[Pose], Array]:
    """Poses at most `reach` (m) from home along each axis, `turn` (rad) in roll, pitch, yaw."""
    random = np.random.default_rng(5)
    places = head.home.position + random.uniform(-reach, reach, (4 * POSES, 3))
    poses = Pose(places, so3.from_rpy(random.uniform(-turn, turn, (4 * POSES, 3))))
    joints = head.inverse_or_nan(poses)
    chosen = np.flatnonzero(np.isfinite(joints).all(axis=1))[:POSES]
    return [poses[k] for k in chosen], joints[chosen]


def settled(solver: ReachyMiniRustKinematics, angles: list[float], start: Array) -> Array:
    """One call is one step; it returns its own start where it finds nothing better."""
    solver.reset_forward_kinematics(start)
    before = None
    for _ in range(MOST_STEPS):
        found = solver.forward_kinematics(angles)
        if found == before:
            break
        before = found
    return np.array(found)


def stepped(solver: ReachyMiniRustKinematics, angles: list[float], start: Array) -> Array:
    solver.reset_forward_kinematics(start)
    for _ in range(OWN_STEPS):
        found = solver.forward_kinematics(angles)
    return np.array(found)


def error(pose: Pose, found: Array) -> float:
    return float(np.abs(pose.twist_to(Pose(found[:3, 3], found[:3, :3]))).max())


def speed_rows(
    head: RotaryHexapod, theirs: ReachyMiniRustKinematics, poses: list[Pose], joints: Array
) -> list[Row]:
    squares, angles = [matrix(p) for p in poses], joints.tolist()
    home = matrix(head.home)
    inverse, their_inverse, forward, to_rest, three = interleaved_medians(
        [
            lambda k: head.inverse(poses[k]),
            lambda k: theirs.inverse_kinematics(squares[k]),
            lambda k: head.forward(joints[k]),
            lambda k: settled(theirs, angles[k], home),
            lambda k: stepped(theirs, angles[k], home),
        ],
        ROUNDS,
    )
    some = range(ROUNDS)
    ours_off = max(error(poses[k], np.array(matrix(head.forward(joints[k]).pose))) for k in some)
    rest_off = np.median([error(poses[k], settled(theirs, angles[k], home)) for k in some])
    three_off = np.median([error(poses[k], stepped(theirs, angles[k], home)) for k in some])
    return [
        against('inverse', inverse, their_inverse, 0.5),
        against('forward from home, until converged', forward, to_rest, 0.15),
        against(f'forward from home, their {OWN_STEPS} steps', forward, three),
        Row(
            f'pose error: ours, theirs converged, theirs after {OWN_STEPS} steps',
            f'{ours_off:.0e} (worst), {rest_off:.0e}, {three_off:.0e} (medians) m or rad',
        ),
    ]


def against(what: str, ours: float, theirs: float, goal: float | None = None) -> Row:
    ratio = ours / theirs
    text = f'{1e6 * theirs:.2f} µs, ours {1e6 * ours:.2f} µs = {ratio:.2f}×'
    return Row(what, text, f'{goal:g}×' if goal else '', goal is None or ratio <= goal)


def honesty_rows(
    head: RotaryHexapod, theirs: ReachyMiniRustKinematics, box: tuple[float, float]
) -> list[Row]:
    """What a start from home answers to the joints of reachable poses."""
    poses, joints = reachable(head, *box)
    home, size = matrix(head.home), len(poses)
    silent = sum(
        error(pose, settled(theirs, q.tolist(), home)) > SAME
        for pose, q in zip(poses, joints, strict=True)
    )
    refused = wrong = 0
    for pose, q in zip(poses, joints, strict=True):
        try:
            found = head.forward(q).pose
        except NoSolution:
            refused += 1
            continue
        wrong += bool(np.abs(pose.twist_to(found)).max() > SAME)
    where = f'{size} poses, ±{1e3 * box[0]:.0f} mm and ±{np.degrees(box[1]):.0f}°, from home'
    percent = 100 / size
    return [
        Row(f'{where}: theirs wrong', f'{percent * silent:.2f} %'),
        Row(f'{where}: ours wrong', f'{percent * wrong:.2f} %', '0 %', wrong == 0),
        Row(f'{where}: ours rejected', f'{percent * refused:.2f} %'),
    ]
