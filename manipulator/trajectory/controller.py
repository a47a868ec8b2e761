"""The motion controller: commands, measurements, the bridge's state in; one setpoint a tick out.

It combines the motion supervisor (supervisor.py), jogging (teleop.py), path planning and commands
that came too early, in the order of a tick. It measures how late ticks come, and how far the
machine lags behind a stream of goals that exceeds its limits.
"""

from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import degrees

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import ManipulatorError, NoSolution, Refused
from manipulator.machine import Machine
from manipulator.planning.cycle import Cycle
from manipulator.planning.goal import Goal, Motion
from manipulator.planning.orientation import Orientation, OrientationRule
from manipulator.planning.worker import InPlace, Worker
from manipulator.pose import Pose
from manipulator.states import MotionResult
from manipulator.trajectory.early_command import EarlyCommand
from manipulator.trajectory.following_error import Tolerances
from manipulator.trajectory.joint_goal import joint_goal
from manipulator.trajectory.motion_status import STOPPED, MotionNews, MotionStatus
from manipulator.trajectory.path_planning import PathGoal, PathPlanning, TrajectoryGoal
from manipulator.trajectory.supervisor import MEASUREMENT_DELAY, MotionSupervisor
from manipulator.trajectory.teleop import Teleop


class Jitter:
    """The lateness of the last thousand ticks against the period, in seconds."""

    def __init__(self, period: float) -> None:
        self._period = period
        self._last: float | None = None
        self._lateness: deque[float] = deque(maxlen=1000)

    def tick(self, now: float) -> float:
        """Notes that a tick begins now; returns the seconds since the last one, 0 at first."""
        elapsed = 0.0 if self._last is None else now - self._last
        if self._last is not None:
            self._lateness.append(abs(elapsed - self._period))
        self._last = now
        return elapsed

    def quantile(self, q: float) -> float:
        """The q-quantile of the lateness, 0 before the second tick."""
        if not self._lateness:
            return 0.0
        return sorted(self._lateness)[int(q * (len(self._lateness) - 1))]


def lag_of(supervisor: MotionSupervisor) -> dict[str, float]:
    """From the commanded pose to the newest goal: `lag_mm` and `lag_deg`, 0 where there is none.

    The newest goal is always the one pursued; those in between were dropped.
    """
    gap = np.zeros(6)
    try:
        goal = supervisor.executor.pursued
    except Refused:
        goal = None
    if goal is not None:
        gap = supervisor.executor.state.pose.twist_to(goal)
    shift, turn = (float(np.linalg.norm(part)) for part in (gap[:3], gap[3:]))
    return {'lag_mm': 1e3 * shift, 'lag_deg': degrees(turn)}


OVERTAKING = 0.5
"""Seconds by which a goal may overtake a path, which takes longer to send, or a path a goal."""

Refuse = Callable[[ManipulatorError], object]
"""Receives the reason why an accepted command was dropped before it began."""


@dataclass(frozen=True)
class Answer:
    """To a request: accepted or not, and in words what will happen, or why it will not."""

    is_obeyed: bool
    text: str


class MotionController:
    """One machine's; poses are the platform's in the base frame, unless stated otherwise.

    Times are monotonic, in seconds; stamps are those of the messages, and name their commands. It
    is called from one thread. Commands raise Refused where the machine cannot be driven; those
    that come while it is about to be taken over wait for that (early_command.py).
    """

    def __init__(
        self,
        machine: Machine,
        dt: float,
        tolerances: Tolerances | None = None,
        worker: Worker | None = None,
        delay: float = MEASUREMENT_DELAY,
    ) -> None:
        """tolerances, worker: see `MotionSupervisor`; delay: see `Teleop`."""
        self.supervisor = MotionSupervisor(machine, dt, tolerances, worker, delay)
        self.teleop = Teleop(self.supervisor, delay)
        self.jitter = Jitter(dt)
        self.news = MotionNews()
        self._dt = dt
        self._paths = PathPlanning(self.supervisor, dt, worker or InPlace(), self.news)
        self._early = EarlyCommand()
        self._newest = float('-inf'), float('-inf')
        self._state_at = self._pose_at = self._tick_at = float('-inf')
        self._poses_since = float('-inf')
        self._pose: Pose | None = None

    # Measurements

    def note_machine_state(
        self, state: str, is_followed: bool, is_measured: bool, now: float
    ) -> None:
        """The reported machine state: see `MotionSupervisor`. A stop ends waiting commands."""
        self._state_at = now
        if state != self.supervisor.state:
            self._poses_since = now
        self.supervisor.note_machine_state(state, is_followed, is_measured)
        self._early.poll(now)
        self.news.update(self.supervisor.status)

    def note_joints(self, joints: Array | None) -> None:
        """The reported joints (n,); None, not all known, changes nothing."""
        if joints is not None:
            self.supervisor.note_joints(joints)

    def note_pose(self, T_base_platform: Pose, now: float, lateness: float = 0.0) -> None:
        """The reported pose of the platform, by how many seconds it is late.

        No machine is taken over where it was while it was still driven, or in another state.
        """
        self._pose_at = now
        if self.supervisor.is_driving or now - lateness >= self._poses_since:
            self.supervisor.note_pose(T_base_platform)

    # Commands

    def pursue(self, goal: Goal, refuse: Refuse, now: float, is_of_platform: bool = True) -> None:
        """A goal: the platform's pose in the base frame, or the pivot's in the work frame."""
        self._check_order(goal.stamp, now)
        self._pursue(replace(goal, received=now), refuse, now, is_of_platform)

    def follow(self, path: PathGoal, refuse: Refuse, now: float) -> None:
        """A path: it is planned, then executed like a goal, unless a newer command comes."""
        self._check_order(path.stamp, now)
        self._early.take(lambda: self._paths.begin(path), refuse, now)

    def follow_joints(self, trajectory: TrajectoryGoal, refuse: Refuse, now: float) -> None:
        """A joint trajectory: planned from rest, and begun by its stamp, which may be ahead."""
        self._early.take(lambda: self._paths.begin(trajectory), refuse, now)

    def move_joints(
        self, named: Mapping[str, float], stamp: float, refuse: Refuse, now: float
    ) -> None:
        """A joint move to positions (rad, m) by name; the other joints stay as commanded.

        Raises Unreachable where a limit would be broken there.
        """
        self._check_order(stamp, now)

        def act() -> None:
            supervisor = self.supervisor
            goal = joint_goal(supervisor.machine, supervisor.executor, named)
            supervisor.executor.pursue(replace(goal, stamp=stamp, received=now))

        self._early.take(act, refuse, now)

    def orientation_rule(self, orientation: Orientation, is_of_platform: bool) -> OrientationRule:
        """For poses of the platform in the base frame, or of the pivot in the work frame."""
        frames = self.supervisor.machine.frames
        point = self.teleop.point_in(frames, is_in_work=not is_of_platform)
        return OrientationRule(orientation, point)

    def home(self, stamp: float, now: float) -> None:
        """A goal at home, along a line or else by a joint move."""
        kinematics = self.supervisor.machine.kinematics
        self._pursue_joints(kinematics.home, kinematics.inverse(kinematics.home), stamp, now)

    def park(self, stamp: float, now: float) -> None:
        """As `home`, to where the servos are switched on and off."""
        machine = self.supervisor.machine
        if machine.park is None:
            raise Refused('no usable park position (park_deg or park_mm of section servos)')
        try:
            pose = machine.kinematics.forward(machine.park).pose
        except NoSolution as error:
            raise Refused(f'the forward solution of the park position failed: {error}') from error
        self._pursue_joints(pose, machine.park, stamp, now)

    def stop(self) -> None:
        """Brakes along the path, then holds; a jogging source is rejected until it releases."""
        self._early.drop(STOPPED)
        self.supervisor.executor.stop()
        self.teleop.stop()

    def start_cycle(self, made: Callable[[Pose], Cycle], stamp: float) -> None:
        """The cycle that is made about the present pose; `cycle_answer` returns its result."""
        executor = self.supervisor.executor
        executor.start_cycle(made(executor.state.pose), stamp)

    def cycle_answer(self, stamp: float) -> Answer | None:
        """Whether the cycle of that stamp has begun, or why not; None while that is open."""
        status = self.supervisor.status
        if status.goal_stamp == stamp and status.result == MotionResult.MOVING:
            return Answer(True, 'cycling until stopped')
        if status.goal_stamp == stamp and status.result in (
            MotionResult.REFUSED,
            MotionResult.STOPPED,
        ):
            return Answer(False, status.reason or status.result)
        if self._is_newest(stamp):
            return None
        return Answer(False, 'replaced by a newer command before it began')

    def refuse(self, stamp: float, error: ManipulatorError) -> None:
        """Reports the goal or path of that stamp as refused."""
        self.news.add(
            MotionStatus(self.supervisor.status.mode, MotionResult.REFUSED, stamp, str(error))
        )

    # The tick

    def begin_tick(self, now: float) -> None:
        """Advances by one tick; take the setpoint's stamp before `end_tick`."""
        since_last, self._tick_at = self.jitter.tick(now), now
        if self.supervisor.is_driving:
            self._poses_since = now
        # Messages that the bridge sent while this process stalled have not been received yet.
        self._state_at += max(since_last - self._dt, 0.0)
        self.supervisor.note_stall(since_last)
        self.supervisor.note_silence(now - self._pose_at)
        self.supervisor.note_bridge_silence(now - self._state_at)
        self.teleop.drive(now)
        self._paths.step(now)
        self._early.poll(now)
        self._pose = self.supervisor.step()

    def end_tick(self, now: float) -> Pose | None:
        """The setpoint, None while the machine is not driven or where the tick took too long.

        A stall before the stamp is detected here; after it, receivers reject the old stamp.
        """
        self.supervisor.note_stall(now - self._tick_at)
        self.news.update(self.supervisor.status)
        return self._pose if self.supervisor.is_driving else None

    def close(self) -> None:
        """Cancels the planning of a path."""
        self._paths.cancel()

    def _pursue_joints(self, pose: Pose, joints: Array, stamp: float, now: float) -> None:
        """Pursues joints (n,) at a pose of the pivot in the work frame."""
        goal = Goal(pose, stamp, motion=Motion.ANY, joints=joints)
        self._pursue(goal, lambda error: self.refuse(stamp, error), now, is_of_platform=False)

    def _pursue(self, goal: Goal, refuse: Refuse, now: float, is_of_platform: bool) -> None:
        def act() -> None:
            frames, executor = self.supervisor.machine.frames, self.supervisor.executor
            start = executor.pursued or executor.state.pose
            if is_of_platform:
                oriented = goal.orientation.applied(goal.pose, frames.platform(start))
                executor.pursue(replace(goal, pose=frames.pivot(oriented)))
            else:
                executor.pursue(replace(goal, pose=goal.orientation.applied(goal.pose, start)))

        self._early.take(act, refuse, now)

    def _check_order(self, stamp: float, now: float) -> None:
        """Refused for a goal or a path that one published later has overtaken on its topic.

        Stamps that are farther apart, or come so, may be those of two clocks.
        """
        newest, received = self._newest
        ahead = newest - stamp
        if stamp and 0.0 < ahead < OVERTAKING and now - received < OVERTAKING:
            raise Refused(f'stamped {ahead:.3f} s before the last goal or path: ignored')
        if stamp:
            self._newest = stamp, now

    def _is_newest(self, stamp: float) -> bool:
        try:
            return self.supervisor.executor.newest_stamp == stamp
        except Refused:
            return False
