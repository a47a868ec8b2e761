"""FollowJointTrajectory, by which MoveIt 2 drives a machine, where control_msgs is installed.

One trajectory at a time. Nothing waits in a callback: every tick looks how far the trajectory is,
and its result is sent once motion_status reports the end.
"""

import math
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np
from builtin_interfaces.msg import Duration, Time
from rclpy.action import ActionServer, CancelResponse
from rclpy.node import Node
from trajectory_msgs.msg import JointTrajectoryPoint

from manipulator.arrays import Array
from manipulator.errors import InvalidInput, ManipulatorError
from manipulator.machine import Machine
from manipulator.nodes.joint_topics import JointTopics
from manipulator.nodes.messages import joint_points_of
from manipulator.planning.joint_points import InvalidJoints
from manipulator.planning.joint_trajectory import JointTrajectory
from manipulator.states import MotionResult
from manipulator.trajectory.controller import MotionController
from manipulator.trajectory.motion_status import REPLACED, MotionStatus
from manipulator.trajectory.trajectory_tolerances import JointTolerance, TrajectoryTolerances

FEEDBACK_PERIOD = 0.05
"""Seconds, as joint_trajectory_controller's action_monitor_rate of 20 Hz."""

SPEED_PERIOD = 0.1
"""Seconds over which a joint's speed at the end is measured: several reports."""


class _Server(ActionServer):
    """Begins nothing beside the tick: `notify_execute` with a callback sends a goal's result."""

    def notify_execute(self, goal_handle: Any, execute_callback: Any) -> None:
        """Called by `execute` without a callback."""
        if execute_callback is not None:
            super().notify_execute(goal_handle, execute_callback)


@dataclass
class _Active:
    """A goal from its acceptance to its result; times are monotonic, in seconds.

    plan: once it moves. left: s of the plan's time that were left at the last tick. is_reached:
    motion_status has reported its end, at the time ended_at. measured: a time after the end, and
    the joints at it; speed: theirs since then.
    """

    handle: Any
    stamp: float
    tolerances: TrajectoryTolerances
    plan: JointTrajectory | None = None
    left: float = math.inf
    is_reached: bool = False
    ended_at: float = math.inf
    feedback_at: float = -math.inf
    measured: tuple[float, Array] | None = None
    speed: Array | None = None

    def measure(self, actual: Array, now: float) -> Array:
        """The joints' speeds (n,) at rest, by their last reports; NaN until there are two."""
        if self.speed is None:
            self.measured, self.speed = (now, actual), np.full(len(actual), np.nan)
        elif (
            self.measured is not None
            and actual is not self.measured[1]
            and now - self.measured[0] >= SPEED_PERIOD
        ):
            before, joints = self.measured
            self.speed = np.abs(actual - joints) / (now - before)
            self.measured = now, actual
        return self.speed


class TrajectoryAction:
    """The action server; without control_msgs it does nothing."""

    def __init__(self, node: Node, controller: MotionController, joints: JointTopics) -> None:
        self._node, self._controller, self._joints = node, controller, joints
        self._active: _Active | None = None
        self._server: _Server | None = None
        try:
            self._kind: Any = import_module('control_msgs.action').FollowJointTrajectory
        except ModuleNotFoundError:
            return
        self._server = _Server(
            node,
            self._kind,
            '~/follow_joint_trajectory',
            execute_callback=lambda handle: self._kind.Result(),
            handle_accepted_callback=self._accept,
            cancel_callback=self._cancel,
        )

    def close(self) -> None:
        """Ends the server."""
        if self._server is not None:
            self._server.destroy()

    def note(self, status: MotionStatus) -> None:
        """A status that was published: perhaps the end of the active trajectory."""
        active = self._active
        if active is None or status.goal_stamp != active.stamp:
            return
        if status.result == MotionResult.REFUSED:
            self._finish('INVALID_GOAL', status.reason)
        elif status.result == MotionResult.STOPPED:
            is_over = active.left <= 0.0
            code = 'GOAL_TOLERANCE_VIOLATED' if is_over else 'PATH_TOLERANCE_VIOLATED'
            self._finish(code, status.reason or 'stopped')
        active.is_reached = status.result == MotionResult.REACHED

    def poll(self, now: float) -> None:
        """Call at every tick: feedback, and the tolerances that were requested."""
        active, supervisor = self._active, self._controller.supervisor
        actual = supervisor.reported_joints
        if active is None or actual is None:
            return
        executed = supervisor.executed(active.stamp)
        if executed is not None and isinstance(executed.plan, JointTrajectory):
            active.plan, active.left = executed.plan, executed.plan.duration - executed.time
            self._watch(active, executed.time, actual, now)
        elif active.plan is not None:
            active.left = 0.0
            if active.is_reached:
                self._judge(active, active.plan, actual, now)
            elif supervisor.status.goal_stamp != active.stamp:
                self._finish('INVALID_GOAL', 'replaced by a newer goal')

    def _watch(self, active: _Active, time: float, actual: Array, now: float) -> None:
        """Ends a trajectory that is left by more than its path tolerances; else feedback."""
        if active.plan is None:
            return
        desired = active.plan.curve.at(time)
        violation = active.tolerances.path_violation(desired[0], actual)
        if violation:
            self._controller.stop()
            self._finish('PATH_TOLERANCE_VIOLATED', violation)
        elif now - active.feedback_at >= FEEDBACK_PERIOD:
            active.feedback_at = now
            active.handle.publish_feedback(self._feedback(desired, actual, time))

    def _judge(self, active: _Active, plan: JointTrajectory, actual: Array, now: float) -> None:
        """The result of a trajectory that is over, once its goal tolerances are kept."""
        active.ended_at = min(active.ended_at, now)
        desired, speed = plan.joints_at(plan.duration), active.measure(actual, now)
        violation = active.tolerances.goal_violation(desired, actual, speed)
        if not violation:
            self._finish('SUCCESSFUL', '')
        elif now - active.ended_at > active.tolerances.goal_time and np.isfinite(speed).all():
            self._finish('GOAL_TOLERANCE_VIOLATED', violation)

    def _feedback(self, desired: tuple[Array, Array, Array], actual: Array, time: float) -> Any:
        feedback = self._kind.Feedback()
        feedback.header.stamp = self._node.get_clock().now().to_msg()
        feedback.joint_names = list(self._joints.names)
        names = ('positions', 'velocities', 'accelerations')
        rows = {name: row.tolist() for name, row in zip(names, desired, strict=True)}
        since = Duration(sec=int(time), nanosec=int(time % 1.0 * 1e9))
        feedback.desired = JointTrajectoryPoint(time_from_start=since, **rows)
        feedback.actual = JointTrajectoryPoint(time_from_start=since, positions=actual.tolist())
        error = (desired[0] - actual).tolist()
        feedback.error = JointTrajectoryPoint(time_from_start=since, positions=error)
        return feedback

    def _accept(self, handle: Any) -> None:
        """Begins a goal, which ends the one before it; a bad one does not."""
        handle.execute()
        trajectory, stamp = handle.request.trajectory, self._joints.name_of(Time())
        before = self._active
        try:
            points = joint_points_of(trajectory, self._joints.names)
            tolerances = tolerances_of(handle.request, self._controller.supervisor.machine)
            self._active = _Active(handle, stamp, tolerances)
            self._joints.begin(trajectory.header.stamp, lambda: points, stamp)
        except ManipulatorError as error:
            self._active = before
            is_of_joints = isinstance(error, InvalidJoints)
            self._send(handle, 'INVALID_JOINTS' if is_of_joints else 'INVALID_GOAL', str(error))
        else:
            if before is not None:
                self._send(before.handle, 'INVALID_GOAL', REPLACED)

    def _cancel(self, handle: Any) -> CancelResponse:
        """Brakes along the trajectory; the result follows at rest."""
        if self._active is None or self._active.handle is not handle:
            return CancelResponse.REJECT
        self._controller.stop()
        return CancelResponse.ACCEPT

    def _finish(self, code: str, text: str) -> None:
        """Sends the result of the active goal, if there is one."""
        active, self._active = self._active, None
        if active is not None:
            self._send(active.handle, code, text)

    def _send(self, handle: Any, code: str, text: str) -> None:
        result = self._kind.Result(error_string=text)
        result.error_code = getattr(self._kind.Result, code)
        if handle.is_cancel_requested:
            result.error_code = self._kind.Result.SUCCESSFUL
            handle.canceled()
        elif code == 'SUCCESSFUL':
            handle.succeed()
        else:
            self._node.get_logger().warning(f'follow_joint_trajectory: {text}')
            handle.abort()
        if self._server is not None:
            self._server.notify_execute(handle, lambda _: result)


def tolerances_of(goal: Any, machine: Machine) -> TrajectoryTolerances:
    """Those of a FollowJointTrajectory goal; InvalidInput also for what no machine here has."""
    if goal.multi_dof_trajectory.points or goal.multi_dof_trajectory.joint_names:
        raise InvalidInput('multi_dof_trajectory is not supported')
    path, at_goal = (
        [JointTolerance(one.name, one.position, one.velocity, one.acceleration) for one in given]
        for given in (goal.path_tolerance, goal.goal_tolerance)
    )
    wait = goal.goal_time_tolerance
    return TrajectoryTolerances.of(machine, path, at_goal, wait.sec + wait.nanosec * 1e-9)
