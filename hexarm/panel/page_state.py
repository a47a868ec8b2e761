"""What the page shows of a machine, as JSON: docs/panel.md describes the page.

Metres and radians; the page converts to millimetres and degrees.
"""

import json
from dataclasses import dataclass
from typing import Any

import numpy as np

from hexarm.panel.reachable import bounds, coordinates, pose_at
from hexarm.panel.view import NodeReport, View
from manipulator.arrays import Array
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.states import UNKNOWN, MachineState, MotionMode
from manipulator.teleop.modes import MODES

SILENT = 3.0
"""Seconds after which a node that reports once a second is shown as silent."""
LONGEST = 400
"""Characters of a reason."""

MOVES = ('goal', 'home', 'park', 'cycle', 'go_to')
MOVING = (MotionMode.MOVE, MotionMode.PATH, MotionMode.CYCLE, MotionMode.JOG)
CAN: dict[str, tuple[str, ...]] = {
    MachineState.DISARMED: ('enable',),
    MachineState.ARMING: ('disable',),
    MachineState.ENABLED: ('disable', 'brake', 'pause', 'resume', *MOVES),
    MachineState.HOLDING: ('enable', 'disable'),
    MachineState.UNCLAIMED: ('enable', 'disable'),
    MachineState.PLAYING: ('disable',),
    MachineState.STOPPED: ('clear',),
    MachineState.FAULT: ('clear', 'disable'),
}
"""By machine state, the buttons that have an effect."""

STEPS: dict[str, tuple[str, str | None]] = {
    UNKNOWN: ('No machine answers: does hexarm up run?', None),
    MachineState.DISCONNECTED: ('No board answers: look at its cable and supply.', None),
    MachineState.BOOTING: ('The board is starting.', None),
    MachineState.DISARMED: ('The servos are off.', 'enable'),
    MachineState.ARMING: ('The servos are being switched on, one by one.', None),
    MachineState.HOLDING: ('The board holds and waits for setpoints. If it stays so:', 'enable'),
    MachineState.UNCLAIMED: ('The servos are still on from before.', 'enable'),
    MachineState.PLAYING: ('The board plays a program by itself.', None),
    MachineState.STOPPED: ('Look at the machine; if it may move again:', 'clear'),
    MachineState.FAULT: ('Remove the cause; then:', 'clear'),
}
"""By machine state, what a user does next, and the button for it."""


@dataclass(eq=False)
class Controls:
    """What the controls of all pages show, and hands have set; mutable, of the node's thread.

    goal: x, y, z, roll, pitch, yaw (6,) in m and rad; turns are counted from `centre` (6,).
    ranges (6, 2): how far each of them alone may go; reach: why the goal is out of reach, and the
    nearest pose, '' within reach.
    """

    centre: Array
    goal: Array
    ranges: Array | None = None
    reach: str = ''
    speed: float = 1.0
    opening: float | None = None

    @classmethod
    def at(cls, pose: Pose) -> 'Controls':
        """With the goal at a pose."""
        return cls(coordinates(pose), coordinates(pose))

    @property
    def pose(self) -> Pose:
        """The goal."""
        return pose_at(self.goal)

    def move(self, axis: int, value: float) -> Pose:
        """The goal with another value of one coordinate."""
        self.goal = self.goal.copy()
        self.goal[axis] = value
        return self.pose

    def follow(self, pose: Pose) -> None:
        """Shows another goal."""
        self.goal = coordinates(pose, self.centre)

    def show_reach(self, pose: Pose, ranges: Array, reason: str) -> None:
        """What is reachable about a pose: by how much each coordinate may change (6, 2)."""
        self.ranges = coordinates(pose, self.centre)[:, None] + ranges
        self.reach = reason


def machine_text(machine: Machine, label: str, has_gripper: bool) -> str:
    """What does not change."""
    names = machine.kinematics.joint_names
    low, high = (np.clip(ends, -4 * np.pi, 4 * np.pi).tolist() for ends in machine.joint_ranges)
    words = {
        'label': label,
        'bounds': bounds(machine).tolist(),
        'joint_unit': machine.kinematics.joint_unit,
        'joints': [
            {'name': name, 'low': a, 'high': b}
            for name, a, b in zip(names, low, high, strict=True)
        ],
        'modes': list(MODES),
        'tools': [tool.name for tool in machine.frames.tools],
        'has_gripper': has_gripper,
    }
    return json.dumps({'machine': words})


def state_text(view: View, controls: Controls, notice: str) -> str:
    """What may change at any time."""
    measured, commanded = view.measured, view.commanded
    text, action = step_of(view)
    words: dict[str, Any] = {
        'state': view.machine_state,
        'reason': view.machine_reason[:LONGEST],
        'notice': notice[:LONGEST],
        'motion': (view.motion or view.mode)[:LONGEST],
        'step': {'text': text, 'action': action},
        'can': can(view),
        'goal': controls.goal.tolist(),
        'ranges': None if controls.ranges is None else controls.ranges.tolist(),
        'reach': controls.reach,
        'speed': controls.speed,
        'opening': controls.opening,
        'saved': list(view.saved),
        'tool': tool_of(view),
        'pose': None if measured is None else coordinates(measured.pose).tolist(),
        'joints': None if measured is None else measured.joints.tolist(),
        'joint_goal': None if commanded is None else commanded.joints.tolist(),
        'errors': None,
    }
    if measured is not None and commanded is not None:
        words['errors'] = errors(commanded.pose, measured.pose)
    return json.dumps({'state': words})


def nodes_text(nodes: tuple[NodeReport, ...]) -> str:
    """The nodes' reports; one that is silent is an error."""
    words = [
        {
            'name': node.name,
            'level': 2 if node.age > SILENT else node.level,
            'message': f'silent for {node.age:.0f} s' if node.age > SILENT else node.message,
            'values': dict(node.values),
        }
        for node in nodes
    ]
    return json.dumps({'nodes': words})


def can(view: View) -> list[str]:
    """The buttons that have an effect now."""
    found = list(CAN.get(view.machine_state, ()))
    if view.machine_state == MachineState.ENABLED and view.mode not in MOVING:
        found.remove('brake')
    if view.measured is not None:
        found.append('save')
    return found


def tool_of(view: View) -> str:
    """The tool in force, as trajectory reports it; before its first report the machine file's."""
    found = (node.values['tool'] for node in view.nodes if 'tool' in node.values)
    return next(found, view.frames.tool)


def step_of(view: View) -> tuple[str, str | None]:
    """What a user does next, and the button for it; nothing for a machine that takes goals."""
    return STEPS.get(view.machine_state, ('', None))


def errors(commanded: Pose, measured: Pose) -> list[float]:
    """How far apart two poses are, m and rad."""
    offsets = commanded.twist_to(measured)
    return [float(np.linalg.norm(offsets[:3])), float(np.linalg.norm(offsets[3:]))]
