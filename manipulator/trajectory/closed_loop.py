"""Plans of a machine whose joints are measured: they are corrected, and paths wait for arrival."""

from math import sqrt

from manipulator.arrays import Array
from manipulator.errors import NoSolution
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.trajectory.correction import Correction
from manipulator.trajectory.executor import AHEAD, Executor
from manipulator.trajectory.following_error import Tolerances

LONGEST_WAIT = 3.0
"""Seconds that a path waits for the arrival at its first pose."""

CREEP = 0.1
"""Scaling factor while the play of a joint that has turned is taken up."""

BRAKING = 0.8
"""Of the braking rate: what is used to come down to it."""


class ClosedLoop:
    """One machine's, from its takeover to its release; changes once a tick.

    dead_band (n,): errors of joints that cannot be told from none. delay: seconds from a
    measurement to the moment that its correction moves the joints.
    """

    def __init__(self, dead_band: Array, tolerances: Tolerances, delay: float, dt: float) -> None:
        self._correction = Correction(dead_band, tolerances.following, delay, dt)
        self._tolerances = tolerances
        self._longest_wait = round(LONGEST_WAIT / dt)
        self._waited = 0
        self._is_facing = False

    def measure(self, joints: Array) -> None:
        """Takes measured joints (n,)."""
        self._correction.measure(joints)

    def step(self, machine: Machine, executor: Executor, pose: Pose, is_active: bool) -> Pose:
        """The pose to command for the reference `pose`; is_active: see `Correction.step`."""
        executor.awaits_arrival = True
        executor.slow_down(self._scaling(machine, executor, pose) if is_active else 1.0)
        is_stream = executor.is_streaming
        return self._correction.step(machine, pose, executor.joints, is_active, is_stream)

    def _scaling(self, machine: Machine, executor: Executor, pose: Pose) -> float:
        """The scaling factor with which a path comes to a turn of a joint at CREEP."""
        correction = self._correction
        if executor.is_waiting or not executor.may_slow_down or not correction.has_play:
            return 1.0
        try:
            jacobian = machine.kinematics.jacobian(pose, executor.joints)
        except NoSolution:
            return 1.0
        share = correction.share_to_turn(jacobian, executor.joints_ahead(), self._tolerances)
        if share is None:
            return 1.0
        left = BRAKING * machine.motion.braking_rate * share * AHEAD
        return min(sqrt(CREEP**2 + 2.0 * left), 1.0)

    def prepare(self, executor: Executor, deviation: str) -> None:
        """Begins a waiting path once its first pose is reached and the joints' play taken up.

        deviation: how far the machine is from that pose, in words; a path whose first pose is not
        reached ends with it.
        """
        if not executor.is_waiting:
            self._waited, self._is_facing = 0, False
            return
        self._waited += executor.is_executing
        is_late = self._waited > self._longest_wait
        if self._is_facing:
            if is_late or self._correction.is_settled:
                executor.begin_waiting()
        elif not deviation:
            self._correction.face(executor.joints_ahead())
            self._is_facing = True
        elif is_late:
            executor.give_up_waiting(f'before the path begins: {deviation}')
