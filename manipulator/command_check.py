"""From the poses to be at to joint commands: checks and refuses, never bends, never retimes."""

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import LimitViolated
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.step_allowance import StepAllowance

FORGET_AFTER = 0.25
"""Seconds after which the last command no longer says where the joints are."""

SLACK, LONGEST_GAP = 0.02, 0.08
"""Seconds of full speed that a joint may be ahead of the clock, and catch up with at once."""

STANDING = 1e-9
"""rad or m a command below which joints stand: the step is rounding and must not be repeated."""
IN_STEP = 2.0
"""Between two commands, at most this many times as long as between the two before, or as short."""


class CommandCheck:
    """One machine's last word on what may be commanded; times are monotonic, in seconds.

    A setpoint must keep the machine's constraints (from beyond a limit, only the way back is
    allowed), and no joint may jump away from the last command, or from where the joints are.
    """

    def __init__(self, machine: Machine) -> None:
        self._machine = machine
        self._names = machine.kinematics.joint_names
        self._joins_branches = getattr(machine.kinematics, 'joins_branches', False)
        self._commanded: Array | None = None
        self._last_step: Array | float = 0.0
        self._last_age = 0.0
        self._commanded_at = float('-inf')
        self._measured: Array | None = None
        self._allowance = StepAllowance(SLACK, LONGEST_GAP)

    def note_joints(self, joints: Array | None) -> None:
        """Where the joints are (n,), in rad or m; None when that is not known of all of them."""
        self._measured = joints
        if joints is None:
            self._commanded, self._last_step = None, 0.0

    def admit(self, T_base_platform: Pose, now: float) -> Array:
        """The joints (n,) to command; Unreachable or LimitViolated says why there are none."""
        age = now - self._commanded_at
        is_fresh = self._commanded is not None and age < FORGET_AFTER
        near = self._commanded if is_fresh else self._measured
        joints = self._machine.kinematics.inverse(T_base_platform, self._ahead(near, age))
        self._check_limits(T_base_platform, joints, near)
        if not is_fresh:
            self._allowance.restart(now)
        if near is not None:
            self._check_step(joints, near, now)
        self._last_step = joints - near if is_fresh and near is not None else 0.0
        self._last_age = age
        self._commanded, self._commanded_at = joints, now
        return joints

    def _ahead(self, near: Array | None, age: float) -> Array | None:
        """Where the joints go on to if they keep their speed.

        A jogged arm drives through postures where two branches meet, as a stretched elbow. Beside
        them the nearest branch is the one that turns back; only the motion tells which is meant.
        The cranks of a platform do turn back there.
        """
        if not self._joins_branches:
            return near
        is_fresh = age < FORGET_AFTER
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

    def _check_step(self, joints: Array, near: Array, now: float) -> None:
        """Refuses a jump away from the last command, unless it leads to where the joints are."""
        time = self._allowance.seconds(now)
        speed = np.broadcast_to(self._machine.motion.joint.speed, joints.shape)
        steps = np.abs(joints - near)
        needed = steps / speed
        worst = int(np.argmax(needed))
        if needed[worst] <= time:
            self._allowance.spend(float(needed[worst]), now)
            return
        if self._is_present(joints, speed * SLACK):
            self._allowance.restart(now)
            return
        allowed = float(speed[worst]) * time
        unit = self._machine.kinematics.joint_unit
        raise LimitViolated(
            f'{self._names[worst]} would jump by {steps[worst]:.4g} {unit}, at most '
            f'{allowed:.4g} {unit} in {time:.3g} s: begin at the present pose',
            'joint step',
            float(steps[worst]),
            (0.0, allowed),
            worst + 1,
        )

    def _is_present(self, joints: Array, tolerance: Array) -> bool:
        return self._measured is not None and bool(
            (np.abs(joints - self._measured) <= tolerance).all()
        )
