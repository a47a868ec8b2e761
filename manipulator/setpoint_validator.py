"""From setpoints to joint commands: checks and refuses, never changes or retimes them."""

import numpy as np

from manipulator.arrays import Array
from manipulator.deadlines import COMMAND_MEMORY
from manipulator.errors import LimitViolated
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.static_deflection import commanded

SHORTEST_STEP, LONGEST_STEP = 0.02, 0.1
"""A joint may step as far as its speed allows within this time (messages may bunch up).

A process that stalls receives one message late and the next right after it: the second may use
the time that the first left unused.
"""

REQUEST_MEMORY = 0.1
"""Seconds that requested joints wait for their setpoint, the next one."""

STANDING = 1e-9
"""rad or m a command below which joints are at rest: a step of rounding is not repeated."""
IN_STEP = 2.0
"""Between two commands, at most this many times as long as between the two before, or as short."""


class SetpointValidator:
    """The last check of one machine's setpoints; times are monotonic, in seconds.

    A setpoint must keep the machine's constraints (from beyond a limit, only the way back is
    allowed), and no joint may jump away from the last command, or from where the joints are.
    """

    def __init__(self, machine: Machine) -> None:
        self._machine = machine
        self._names = machine.kinematics.joint_names
        self._joins_branches = machine.kinematics.joins_branches
        self._commanded: Array | None = None
        self._last_step: Array | float = 0.0
        self._last_age = self._unused = 0.0
        self._commanded_at = float('-inf')
        self._measured: Array | None = None
        self._pose: Pose | None = None
        self._requested: Array | None = None
        self._requested_at = float('-inf')

    def note_requested(self, joints: Array, now: float) -> None:
        """The joints (n,) of a motion of joints: of a pose that fixes none, these are chosen."""
        self._requested, self._requested_at = joints, now

    def note_joints(self, joints: Array | None) -> None:
        """The reported joints (n,), in rad or m; None when not all are known."""
        self._measured = joints
        if joints is None:
            self._commanded, self._last_step = None, 0.0

    def command(self, T_base_platform: Pose, now: float) -> Array:
        """As `admit`, with the static deflection added: the command for the board."""
        joints = self.admit(T_base_platform, now)
        return commanded(self._machine.deflection, T_base_platform, joints)

    def admit(self, T_base_platform: Pose, now: float) -> Array:
        """The joints (n,) at the setpoint; raises Unreachable or LimitViolated."""
        age = now - self._commanded_at
        is_fresh = self._commanded is not None and age < COMMAND_MEMORY
        near = self._commanded if is_fresh else self._measured
        if not is_fresh:
            self._unused = 0.0
        ahead = near if self._is_same(T_base_platform) else self._ahead(near, age)
        if self._requested is not None and now - self._requested_at < REQUEST_MEMORY:
            ahead = self._requested
        self._requested = None
        joints = self._machine.kinematics.inverse(T_base_platform, ahead)
        self._check_limits(T_base_platform, joints, near)
        if near is not None:
            self._check_step(joints, near, age if is_fresh else 0.0)
            self._unused = self._left_by(joints - near, age) if is_fresh else 0.0
        self._last_step = joints - near if is_fresh and near is not None else 0.0
        self._last_age = age
        self._commanded, self._commanded_at = joints, now
        self._pose = T_base_platform
        return joints

    def _is_same(self, pose: Pose) -> bool:
        """Whether the machine is to stand still: where a pose fixes no joints, these stay too."""
        last = self._pose
        return last is not None and bool(
            (pose.position == last.position).all() and (pose.rotation == last.rotation).all()
        )

    def _ahead(self, near: Array | None, age: float) -> Array | None:
        """Where the joints go on to if they keep their speed.

        A jogged arm drives through postures where two branches meet, as a stretched elbow. Beside
        them the nearest branch is the one that turns back; only the motion shows which is meant.
        The cranks of a platform do turn back there.
        """
        if not self._joins_branches:
            return near
        is_fresh = age < COMMAND_MEMORY
        is_regular = is_fresh and age < IN_STEP * self._last_age and self._last_age < IN_STEP * age
        if near is None or not is_regular or np.abs(self._last_step).max() < STANDING:
            return near
        return near + self._last_step * (age / self._last_age)

    def _check_limits(self, pose: Pose, joints: Array, near: Array | None) -> None:
        constraints = self._machine.constraints
        if constraints.admits(pose, joints):
            return
        if near is not None:
            start = self._machine.kinematics.forward(near, pose).pose
            constraints = constraints.stretched_to(start, near)
        constraints.check(pose, joints)

    def _check_step(self, joints: Array, near: Array, age: float) -> None:
        """Refuses a jump away from the last command, unless it leads to where the joints are."""
        time = min(max(age, SHORTEST_STEP) + self._unused, LONGEST_STEP)
        bounds = np.broadcast_to(self._machine.motion.joint.speed * time, joints.shape)
        steps = np.abs(joints - near)
        worst = int(np.argmax(steps / bounds))
        allowed = float(bounds[worst])
        if steps[worst] <= allowed or self._is_present(joints, bounds):
            return
        unit = self._machine.kinematics.joint_unit
        raise LimitViolated(
            f'{self._names[worst]} would jump by {steps[worst]:.4g} {unit}, at most '
            f'{allowed:.4g} {unit} in {time:.3g} s: begin at the present pose',
            'joint step',
            float(steps[worst]),
            (0.0, allowed),
            worst + 1,
        )

    def _left_by(self, step: Array, age: float) -> float:
        """Seconds that a step did not need of a gap between messages."""
        needed = float(np.max(np.abs(step) / self._machine.motion.joint.speed))
        return max(age - SHORTEST_STEP - needed, 0.0)

    def _is_present(self, joints: Array, tolerance: Array) -> bool:
        return self._measured is not None and bool(
            (np.abs(joints - self._measured) <= tolerance).all()
        )
