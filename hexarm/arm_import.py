"""An arm of a URDF as the text of a machine file: what was not in the URDF is marked `assumed`."""

import json
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
import yaml

from arm_control.chain import JOINTS, Chain
from arm_control.urdf_chain import UrdfArm
from arm_control.urdf_file import Inertial, UrdfJoint
from hexarm.machine_check import report_of
from hexarm.simulation.dynamics_config import check_inertia
from manipulator.arrays import Array
from manipulator.config import parse_yaml
from manipulator.errors import ConfigError
from manipulator.formatting import shortened
from manipulator.rotation import EXACTLY, to_rpy

ASSUMED_SPEED, ASSUMED_RANGE, ASSUMED_TORQUE = 90.0, 180.0, 50.0
"""deg/s, degrees either way, N·m: of joints whose file gives none."""
RAMP = 0.25
"""Seconds to a joint's full speed, where no acceleration is asked for."""
CREDIBLE_SPEED, CREDIBLE_TORQUE = (0.1, 5000.0), (0.001, 10_000.0)
"""deg/s and N·m; others were filled in for form's sake."""
ONSET = 0.08
"""The singular value below which a posture is near to singular."""
FREE = 1e-9
"""The singular value below which a posture is singular, but for roundings."""
WELL = 0.6
"""Of the largest one, that of a posture that will do for home."""
BENDS = tuple(math.radians(angle) for angle in (0, 30, -30, 60, -60, 90, -90))
"""Angles of joints 2 to 5 in postures that are tried as home."""
OFF_STOPS, OFF_STOPS_SHARE = math.radians(10.0), 0.1
"""How far home is from the ends of a joint's range: rad, but at most this part of the range."""
LENGTH_SHARE, RADIUS_SHARE = 0.25, 0.06
"""Of all links together the characteristic length; of that a link's radius."""
ROUNDING, ROUNDING_SHARE = 1e-15, 1e-12
GEARS = 1e7
"""g·mm² of rotor, at the output, for each N·m of a geared drive."""


@dataclass(frozen=True)
class ImportOptions:
    """What a URDF does not say, and its user may: home (6,) in degrees, acceleration in deg/s²."""

    home_deg: Sequence[float] | None = None
    acceleration_deg_s2: float | None = None


@dataclass(frozen=True)
class Imported:
    """The text, and the lines of it with values that are assumed."""

    text: str
    assumed: tuple[str, ...]


def machine_text(
    arm: UrdfArm,
    name: str,
    source: str,
    options: ImportOptions,
    meshes: Sequence[str] = (),
    notes: Sequence[str] = (),
) -> Imported:
    """The machine file of an arm, which `hexarm check` finds good; ConfigError with its problems.

    name is the robot's, source the URDF's file name: both go into comments, and so do notes.
    meshes are the files of the seven links, or none.
    """
    length = LENGTH_SHARE * reach_of(arm.chain)
    sections = (
        _head(arm, name, source),
        [*_geometry(arm, length, options), *_meshes(meshes, notes)],
        _limits(arm, length, options),
        _motion(arm, options),
        _dynamics(arm, length),
    )
    text = '\n'.join('\n'.join(lines) + '\n' for lines in sections)
    report = report_of(parse_yaml(text))
    if report.problems:
        raise ConfigError(report.problems, source)
    lines = [line.strip() for line in text.splitlines() if not line.startswith('#')]
    return Imported(text, tuple(line for line in lines if 'assumed' in line))


def _head(arm: UrdfArm, name: str, source: str) -> Iterator[str]:
    where = f'{_plain(arm.base)} to {_plain(arm.tip)}'
    yield f'# Imported from {_plain(source)} by hexarm import: {where}.'
    yield '# What is marked "assumed" was not in that file: look at it before the arm moves.'
    yield 'kind: serial_arm'
    yield f'description: {json.dumps(_plain(name), ensure_ascii=False)}'
    yield 'driver: topic                      # other software moves the joints: docs/your-arm.md'


def _geometry(arm: UrdfArm, length: float, options: ImportOptions) -> Iterator[str]:
    chain = arm.chain
    yield 'geometry:'
    yield '  screws:                          # axes and points on them, in base axes at zero'
    for joint, axis, point in zip(arm.joints, chain.axes, chain.points, strict=True):
        yield f'    - {{axis: {_list(axis)}, point_mm: {_list(1e3 * point)}}}  # {joint.name}'
    yield f'  tool_position_mm: {_list(1e3 * chain.home.position)}'
    rpy = to_rpy(chain.home.rotation, EXACTLY)
    yield f'  tool_rpy_deg: {_list(np.degrees(rpy))}'
    if options.home_deg is not None:
        yield f'  home_deg: {_list(options.home_deg)}'
        return
    exact, (low, high) = np.degrees(home_of(arm, length)), np.degrees(_ends(arm))
    rounded = np.round(exact, 3)
    home = np.where((low <= rounded) & (rounded <= high), rounded, exact)
    yield f'  home_deg: {_list(home)}  # assumed: not near a singular posture'


def _meshes(files: Sequence[str], notes: Sequence[str]) -> Iterator[str]:
    if files:
        yield '  meshes:                          # of the base and the six links, for the eye'
        yield from (f'    - {json.dumps(file, ensure_ascii=False)}' for file in files)
    yield from (f'  # {_plain(note)}' for note in notes)


def _limits(arm: UrdfArm, length: float, options: ImportOptions) -> Iterator[str]:
    yield 'limits:'
    yield f'  characteristic_length_mm: {1e3 * length:.0f}.0  # assumed: a quarter of all links'
    yield f'  damping_onset: {ONSET}              # assumed'
    yield '  joints:'
    for joint in arm.joints:
        yield _joint(joint, options)


def _joint(joint: UrdfJoint, options: ImportOptions) -> str:
    travel, notes = range_deg(joint), list[str]()
    words = [f'name: {_scalar(joint.name)}']
    if travel is None:
        words.append('continuous: true')
    else:
        words.append(f'range_deg: {_list(travel)}')
        notes += [] if _has_range(joint) else ['range']
    speed = speed_deg_s(joint)
    notes += [] if _is_credible(joint.velocity, CREDIBLE_SPEED, True) else ['speed']
    acceleration = options.acceleration_deg_s2 or _ramped(speed)
    notes += [] if options.acceleration_deg_s2 else ['acceleration']
    words += [f'speed_deg_s: {_number(speed)}', f'acceleration_deg_s2: {_number(acceleration)}']
    return f'    - {{{", ".join(words)}}}' + (f'  # assumed: {", ".join(notes)}' if notes else '')


def _motion(arm: UrdfArm, options: ImportOptions) -> Iterator[str]:
    fastest = max(speed_deg_s(joint) for joint in arm.joints)
    acceleration = options.acceleration_deg_s2 or _ramped(fastest)
    yield 'motion:                            # assumed, all of the tool'
    yield '  linear_speed_mm_s: 250.0         # the speed that ISO 10218 allows beside people'
    yield '  linear_acceleration_mm_s2: 1500.0'
    yield '  linear_jerk_mm_s3: 20000.0'
    yield '  angular_speed_deg_s: 90.0'
    yield '  angular_acceleration_deg_s2: 600.0'
    yield '  angular_jerk_deg_s3: 8000.0'
    yield f"  joint_speed_deg_s: {_number(fastest)}  # of any joint; `limits` has each joint's own"
    yield f'  joint_acceleration_deg_s2: {_number(acceleration)}'


def _dynamics(arm: UrdfArm, length: float) -> Iterator[str]:
    bodies = [body for body in arm.bodies if body is not None]
    if len(bodies) < JOINTS:
        lacking = [j.name for j, body in zip(arm.joints, arm.bodies, strict=True) if body is None]
        yield f'# No dynamics: the file has no mass for what {", ".join(lacking)} carries.'
        return
    yield 'dynamics:                          # for hexarm mjcf and simulate'
    yield '  compensation: false'
    yield '  payload: {mass_g: 0.0, radius_mm: 30.0, height_mm: 60.0, source: estimate}'
    yield '  links:'
    for joint, body in zip(arm.joints, bodies, strict=True):
        yield _link(joint, body, max(1.0, 1e3 * RADIUS_SHARE * length))


def _link(joint: UrdfJoint, body: Inertial, radius_mm: float) -> str:
    words = [f'mass_g: {_number(1e3 * body.mass)}', f'radius_mm: {radius_mm:.1f}']
    words.append(f'centre_mm: {_list(1e3 * body.centre)}')
    moments = 1e9 * np.diag(body.inertia)
    products = 1e9 * body.inertia[[0, 0, 1], [1, 2, 2]]
    products = np.where(np.abs(products) < ROUNDING_SHARE * moments.max(), 0.0, products)
    notes = ['radius']
    try:
        check_inertia(1e3 * body.mass, tuple(moments.tolist()), tuple(products.tolist()))
        words += [f'inertia_g_mm2: {_list(moments)}', f'products_g_mm2: {_list(products)}']
    except ConfigError:
        notes.append('inertia (no body has that of the file)')
    torque, source = joint.effort, 'torque: URDF; the rest: estimate'
    if torque is None or not _is_credible(torque, CREDIBLE_TORQUE):
        torque, source = ASSUMED_TORQUE, 'estimate'
        notes.append('torque')
    drive = (
        f'torque_n_m: {_number(torque)}, proportional_band_deg: 0.5, '
        f'backdrive_n_m: {_number(torque / 2)}, rotor_inertia_g_mm2: {GEARS * torque:.0f}.0, '
        f'source: "{source}"'
    )
    words.append(f'source: URDF, drive: {{{drive}}}')
    return f'    - {{{", ".join(words)}}}  # assumed: {", ".join(notes)}'


def range_deg(joint: UrdfJoint) -> tuple[float, float] | None:
    """Lower and upper end; None for a joint without end."""
    if joint.kind == 'continuous':
        return None
    if not _has_range(joint):
        return -ASSUMED_RANGE, ASSUMED_RANGE
    return math.degrees(joint.lower or 0.0), math.degrees(joint.upper or 0.0)


def speed_deg_s(joint: UrdfJoint) -> float:
    """At most, or what is assumed."""
    if joint.velocity is None or not _is_credible(joint.velocity, CREDIBLE_SPEED, True):
        return ASSUMED_SPEED
    return math.degrees(joint.velocity)


def _ramped(speed: float) -> float:
    """The acceleration to a speed within RAMP, to three digits."""
    return float(f'{speed / RAMP:.3g}')


def _has_range(joint: UrdfJoint) -> bool:
    """URDF takes an end that is not given as 0: both at 0 is a form that was not filled in."""
    return (joint.lower or 0.0) != 0.0 or (joint.upper or 0.0) != 0.0 or joint.kind == 'continuous'


def _is_credible(value: float | None, bounds: tuple[float, float], is_angle: bool = False) -> bool:
    low, high = bounds
    return value is not None and low <= (math.degrees(value) if is_angle else value) <= high


def home_of(arm: UrdfArm, length: float) -> Array:
    """Joints (6,) in rad: see `posture`; within the file's ranges."""
    return posture(arm.chain, *_ends(arm), length)


def posture(chain: Chain, low: Array, high: Array, length: float) -> Array:
    """Joints (6,) in rad: of the postures tried, the nearest to zero far from singular ones.

    Of those whose tool and joints are above the base plane, where there are any; within low and
    high (6,), and not at their ends. length (m): what one radian counts.
    Raises ConfigError where all are singular.
    """
    ends = zip(low.tolist(), high.tolist(), strict=True)
    rest = np.array([0.0 if a <= 0.0 <= b else (a + b) / 2 for a, b in ends])
    bends = np.array([(0.0, *four, 0.0) for four in product(BENDS, repeat=4)])
    inside = np.minimum(OFF_STOPS, OFF_STOPS_SHARE * (high - low))
    postures = np.clip(rest + bends, low + inside, high - inside)
    sigma = chain.sigma_min(postures, length)
    is_above = _lowest(chain, postures) >= min(0.0, float(chain.points[:, 2].min()))
    allowed = is_above if (sigma[is_above] >= ONSET).any() else np.ones_like(is_above)
    best = sigma[allowed].max()
    if best < FREE:
        raise ConfigError(
            [
                'geometry: some motion of the tool is impossible in every posture that was tried: '
                'are axes that should turn apart, as by alpha, all parallel or in one line?'
            ]
        )
    fitting = allowed & (sigma >= WELL * best)
    nearest: Array = postures[fitting][np.abs(bends[fitting]).sum(axis=1).argmin()]
    return nearest


def _lowest(chain: Chain, postures: Array) -> Array:
    """The height of the lowest of joints and tool, (n,) in m."""
    moved = chain.displacements(postures)[:, 1:]
    points = np.einsum('nkij,kj->nki', moved[..., :3, :3], chain.points) + moved[..., :3, 3]
    tools = chain.forward(postures).position[:, 2]
    lowest: Array = np.minimum(points[..., 2].min(axis=1), tools)
    return lowest


def _ends(arm: UrdfArm) -> tuple[Array, Array]:
    ranges = [range_deg(joint) or (-math.inf, math.inf) for joint in arm.joints]
    return np.radians([r[0] for r in ranges]), np.radians([r[1] for r in ranges])


def reach_of(chain: Chain) -> float:
    """Metres from the base through all joints to the tool."""
    places = np.vstack([np.zeros(3), chain.points, chain.home.position])
    return float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())


def _list(numbers: Iterable[float]) -> str:
    return f'[{", ".join(map(_number, numbers))}]'


def _number(value: float) -> str:
    """15 digits, which bring 120.0 back from radians; a sine's rounding is 0.

    YAML takes 4e-07 for a text, and 4.0e-07 for a number.
    """
    text = repr(float(f'{value:.15g}') if abs(value) >= ROUNDING else 0.0)
    return text if '.' in text else text.replace('e', '.0e')


def _scalar(text: str) -> str:
    """A text in a flow mapping: in quotes where YAML would take it for something else."""
    try:
        is_plain = yaml.safe_load(text) == text and set(text).isdisjoint(',[]{}#&*!|>%@`"\'')
    except yaml.YAMLError:
        is_plain = False
    return text if is_plain else json.dumps(text, ensure_ascii=False)


def _plain(text: str) -> str:
    """On one line, and not too long, for a comment."""
    return shortened(' '.join(''.join(c if c.isprintable() else ' ' for c in text).split()))
