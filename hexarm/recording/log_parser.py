"""From the messages of a recording to its run summary.

MCAP's schema encoding `ros2msg` (https://mcap.dev/spec/registry) is the type's own .msg file, then
each type that it mentions, behind a line of 80 equal signs and a line `MSG: package/Name`.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from hexarm.recording.run_summary import Event, RunSummary, Series
from manipulator.arrays import Array
from manipulator.errors import InvalidInput, ManipulatorError
from manipulator.pose import Pose
from manipulator.states import MachineState, MotionResult

SEPARATOR = '=' * 80
PLAIN = re.compile(r'bool|byte|char|float(32|64)|u?int(8|16|32|64)|w?string')


class UnknownType(ManipulatorError, LookupError):
    """A message type whose package is not installed here, or that has no .msg file."""


def schema_text(type_name: str) -> str:
    """The schema of `package/msg/Name`; UnknownType names the type that is missing."""
    package, _, name = type_name.split('/')
    own = message_text(package, name)
    found: dict[str, str] = {}
    waiting = mentioned(own, package)
    while waiting:
        other = waiting.pop(0)
        if other not in found:
            found[other] = message_text(*other.split('/'))
            waiting += mentioned(found[other], other.split('/')[0])
    parts = [f'{SEPARATOR}\nMSG: {other}\n{text}' for other, text in found.items()]
    return '\n'.join([own, *parts])


def message_text(package: str, name: str) -> str:
    """The .msg file of a type, from the share/ folder of the prefix that holds its Python."""
    spec = find_spec(package)
    homes = [Path(place) for place in (spec.submodule_search_locations or [])] if spec else []
    for prefix in (parent for home in homes for parent in home.resolve().parents):
        path = prefix / 'share' / package / 'msg' / f'{name}.msg'
        if path.is_file():
            return path.read_text(encoding='utf-8')
    raise UnknownType(f'{package}/msg/{name} is not installed here')


def mentioned(text: str, package: str) -> list[str]:
    """The types `package/Name` of the fields of a .msg text, in order; its own are unqualified."""
    types = []
    for line in text.splitlines():
        field = re.match(r'\s*([A-Za-z]\w*(?:/[A-Za-z]\w*)*)\S*\s+[A-Za-z]', line.split('#')[0])
        if field is not None and not PLAIN.fullmatch(field[1]):
            words = field[1].split('/')
            types.append(f'{words[0] if len(words) > 1 else package}/{words[-1]}')
    return types


POSES = ('setpoint', 'pose', 'goal_pose')
JOINTS = ('joint_command', 'joint_states')
STATES = ('machine_state', 'motion_status')
TOPICS = (*POSES, *JOINTS, *STATES, 'emergency_stop')
DIAGNOSTICS = '/diagnostics'
BAD_STATES = (
    MachineState.DISCONNECTED,
    MachineState.STOPPED,
    MachineState.FAULT,
    MachineState.HOLDING,
    MotionResult.REFUSED,
    MotionResult.STOPPED,
)
COUNTERS = ('setpoints_refused', 'twists_refused', 'joint_states_refused', 'refusals')
"""Diagnostics that count refusals; those of goals are in motion_status, each with its reason."""


REPORTED_WITHIN = 3.0
"""Seconds after which the first report of a node is that of a new node, which counts from 0."""


def is_needed(topic: str) -> bool:
    """Whether a summary needs the topic."""
    return topic == DIAGNOSTICS or topic.endswith(tuple(f'/{name}' for name in TOPICS))


def summarise(
    messages: Iterable[tuple[str, float, Any]], namespace: str | None = None
) -> RunSummary:
    """The summary of the machine in `namespace`, by default the only one that is in the recording.

    Raises InvalidInput where there is no machine, or another, or several to choose from.
    """
    parsers: dict[str, LogParser] = {}
    diagnostics: list[tuple[float, Any]] = []
    first, last = np.inf, -np.inf
    for topic, at, message in messages:
        first, last = min(first, at), max(last, at)
        if topic == DIAGNOSTICS:
            diagnostics += [(at, entry) for entry in message.status]
        else:
            name = next(name for name in TOPICS if topic.endswith(f'/{name}'))
            space = topic.removesuffix(f'/{name}').strip('/')
            parsers.setdefault(space, LogParser(space)).add(name, at, message)
    space = _chosen(parsers, namespace)
    for at, entry in diagnostics:
        parsers[space].add_diagnostics(at, entry, first)
    return parsers[space].summary(first, last - first)


def _chosen(parsers: dict[str, 'LogParser'], namespace: str | None) -> str:
    there = ', '.join(f'/{name}' for name in sorted(parsers))
    if not parsers:
        raise InvalidInput('there is no machine in this recording')
    if namespace is None and len(parsers) > 1:
        raise InvalidInput(f'several machines are in it, choose with --namespace: {there}')
    space = next(iter(parsers)) if namespace is None else namespace
    if space not in parsers:
        raise InvalidInput(f'/{space} is not in this recording, only {there}')
    return space


@dataclass
class LogParser:
    """Collects the messages of one machine's topics."""

    namespace: str
    rows: dict[str, list[tuple[float, Any]]] = field(default_factory=dict)
    events: list[Event] = field(default_factory=list)
    _reported: dict[str, object] = field(default_factory=dict)
    _latched: Event | None = None
    _latched_stamp: float = 0.0

    def add(self, name: str, at: float, message: Any) -> None:
        """One message of the topic `name`, relative to the namespace."""
        if name in STATES:
            self._on_state(name, at, message)
        elif name == 'emergency_stop':
            if message.data:
                self.events.append(Event(at, 'user', 'emergency stop', is_bad=True))
        elif name in JOINTS:
            positions = dict(zip(message.name, message.position, strict=False))
            self.rows.setdefault(name, []).append((at, positions))
        elif message.header.frame_id in ('', 'base'):
            p, q = message.pose.position, message.pose.orientation
            self.rows.setdefault(name, []).append((at, (p.x, p.y, p.z, q.x, q.y, q.z, q.w)))

    def add_diagnostics(self, at: float, entry: Any, first: float) -> None:
        """A node's report: counts of refusals that have grown become events.

        What a node counted before the recording, which begins at `first`, is none of it.
        """
        space, _, node = entry.name.rpartition('/')
        if space != self.namespace:
            return
        values = {pair.key: pair.value for pair in entry.values}
        for key in COUNTERS:
            count = int(values[key]) if values.get(key, '').isdigit() else 0
            unknown = count if at - first < REPORTED_WITHIN else 0
            before = self._reported.get(f'{node} {key}', unknown)
            self._reported[f'{node} {key}'] = count
            if isinstance(before, int) and count > before:
                reason = values.get('last_twist_refusal' if 'twist' in key else 'last_refusal', '')
                self.events.append(
                    Event(at, node, MotionResult.REFUSED, reason, True, count - before)
                )

    def _on_state(self, name: str, at: float, message: Any) -> None:
        values = {pair.key: pair.value for pair in message.values}
        what = values.get('result', message.message)
        is_first = name not in self._reported
        report = (what, values.get('reason', ''), values.get('goal_stamp', ''))
        if report != self._reported.get(name) and what:
            self._reported[name] = report
            source = {'machine_state': 'machine', 'motion_status': 'motion'}[name]
            event = Event(at, source, what, report[1], what in BAD_STATES)
            if is_first and name == 'motion_status':
                self._latched, self._latched_stamp = event, float(report[2] or 0.0)
            self.events.append(event)

    def summary(self, first: float, duration: float) -> RunSummary:
        """All of it, with times from `first` on."""
        names = self._joint_names()
        events = sorted(self._own_events(first), key=lambda e: e.time)
        setpoint = self._poses('setpoint', first)
        return RunSummary(
            self.namespace,
            duration,
            names,
            setpoint=setpoint,
            pose=_on_the_turn_of(setpoint, self._poses('pose', first)),
            goals=_on_the_turn_of(setpoint, self._poses('goal_pose', first)),
            joint_command=self._joints('joint_command', names, first),
            joint_states=self._joints('joint_states', names, first),
            events=tuple(replace(e, time=e.time - first) for e in events),
        )

    def _own_events(self, first: float) -> list[Event]:
        """Without the latched result of a goal that is older than the recording."""
        is_older = 0.0 < self._latched_stamp < first
        return [e for e in self.events if not (is_older and e is self._latched)]

    def _joint_names(self) -> tuple[str, ...]:
        every = [tuple(row) for name in JOINTS for _, row in self.rows.get(name, [])]
        return max(every, key=len, default=())

    def _poses(self, name: str, first: float) -> Series:
        rows = self.rows.get(name, [])
        numbers = np.array([row for _, row in rows]).reshape(len(rows), 7)
        good = np.isfinite(numbers).all(axis=1) & (
            np.abs(np.linalg.norm(numbers[:, 3:], axis=1) - 1) < 1e-3
        )
        pose = Pose.from_xyz_quaternion(numbers[good, :3], numbers[good, 3:])
        values = np.hstack([pose.position, np.unwrap(pose.rpy, axis=0)])
        return Series(_times(rows, first)[good], values)

    def _joints(self, name: str, names: tuple[str, ...], first: float) -> Series:
        rows = self.rows.get(name, [])
        values = [[row.get(joint, np.nan) for joint in names] for _, row in rows]
        return Series(_times(rows, first), np.array(values).reshape(len(rows), len(names)))


def _on_the_turn_of(setpoint: Series, poses: Series) -> Series:
    """The poses with their angles moved by whole turns next to the setpoint's."""
    if not len(setpoint):
        return poses
    commanded = setpoint.before(np.maximum(poses.times, setpoint.times[0]))
    turns = np.round((commanded - poses.values)[:, 3:] / (2 * np.pi))
    angles = poses.values[:, 3:] + 2 * np.pi * turns
    return Series(poses.times, np.hstack([poses.values[:, :3], angles]))


def _times(rows: list[tuple[float, Any]], first: float) -> Array:
    return np.array([at - first for at, _ in rows])
