"""The owner of the Cartesian state: goals in, one setpoint a tick out while enabled."""

from collections.abc import Callable

import numpy as np
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PointStamped, PoseStamped
from nav_msgs.srv import GetPlan
from rclpy.node import Node
from std_msgs.msg import Float64
from std_srvs.srv import SetBool, Trigger

from manipulator.errors import InvalidInput, ManipulatorError, Refused
from manipulator.framed_machine import in_frames
from manipulator.frames import Frames
from manipulator.machine import Machine
from manipulator.nodes.cycle_parameters import CycleParameters
from manipulator.nodes.diagnostics import OK, WARN, Diagnostics, Report, status
from manipulator.nodes.intake import Intake
from manipulator.nodes.jitter import Jitter
from manipulator.nodes.messages import (
    BASE_FRAME,
    PLATFORM_FRAME,
    WORK_FRAME,
    point_of,
    pose_message,
    pose_of,
    seconds,
)
from manipulator.nodes.parameters import declare
from manipulator.nodes.qos import COMMAND, LATCHED, MEASUREMENT
from manipulator.pose import Pose
from manipulator.trajectory.following import Following
from manipulator.trajectory.plan import MotionState
from manipulator.trajectory.planner import plan_to
from manipulator.trajectory.player import Goal, MotionStatus, Player

POSE_DEADLINE = 0.5
HOLDING = 'holding'
DRIVABLE = ('enabled', HOLDING)
"""States in which the board follows setpoints; it holds when they came too late."""
FOLLOWING_TOLERANCE = (
    'how far a joint may be from what was commanded within the last half second (rad or m)'
)
CONNECTING = MotionStatus('disabled', 'idle', 0.0, 'the board does not follow setpoints yet')
DISABLED = MotionStatus('disabled', 'idle', 0.0, 'the servos are not enabled')


class TrajectoryNode(Node):
    """goal_pose, pose, machine_state in; setpoint, motion_status out; see docs/interfaces.md."""

    def __init__(self, load: Callable[[str], Machine], default_machine: str) -> None:
        super().__init__('trajectory')
        name = declare(self, 'machine', default_machine, 'machine file: a shipped name or a path')
        rate = declare(self, 'rate', 100.0, 'setpoints per second (Hz)', (10.0, 500.0))
        self._bare = load(name)
        self._machine = in_frames(self._bare, self._bare.frames)
        self._cycle = CycleParameters(self)
        self._tolerance = declare(
            self, 'following_tolerance', 0.2, FOLLOWING_TOLERANCE, (0.0001, 10.0)
        )
        self._dt = 1.0 / rate
        self._player: Player | None = None
        self._next_frames: Frames | None = None
        self._status = DISABLED
        self._published: MotionStatus | None = None
        self._override = 1.0
        self._machine_state = ''
        self._is_followed = False
        self._refusals = 0
        self._last_refusal = ''
        self._jitter = Jitter(self._dt)
        self._connect()
        self._timer = self.create_timer(self._dt, self._tick)
        self._diagnostics = Diagnostics(self, self._report, ('setpoint', 'pose'))

    def _connect(self) -> None:
        self._goals = Intake(self, 'goal_pose', self._on_goal, self._on_bad_goal)
        self._poses = Intake(self, 'pose', self._on_pose)
        self._setpoints = self.create_publisher(PoseStamped, 'setpoint', COMMAND)
        self._statuses = self.create_publisher(DiagnosticStatus, 'motion_status', LATCHED)
        self.create_subscription(PoseStamped, 'goal_pose', self._goals, COMMAND)
        self.create_subscription(PoseStamped, 'pose', self._poses, MEASUREMENT)
        self.create_subscription(
            DiagnosticStatus, 'machine_state', self._on_machine_state, LATCHED
        )
        self.create_subscription(Float64, 'speed_override', self._on_speed_override, LATCHED)
        self.create_subscription(PointStamped, 'pivot', self._on_pivot, LATCHED)
        self.create_service(Trigger, '~/stop', self._serve(self._stop))
        self.create_service(Trigger, '~/home', self._serve(self._home))
        self.create_service(Trigger, '~/start_cycle', self._serve(self._start_cycle))
        self.create_service(SetBool, '~/pause', self._on_pause)
        self.create_service(GetPlan, '~/plan', self._on_plan)

    def _on_machine_state(self, message: DiagnosticStatus) -> None:
        """Leaving 'enabled' drops every goal; what follows begins where the joints are."""
        state = message.message
        is_lost = state not in DRIVABLE or (state == HOLDING and state != self._machine_state)
        if is_lost and self._player is not None:
            self._release(f'the machine is {state}')
        self._machine_state = state
        values = {pair.key: pair.value for pair in message.values}
        if self._player is not None and values.get('followed', 'yes') == 'yes':
            self._is_followed = True
            self._set_status(self._player.status)

    def _on_pose(self, message: PoseStamped) -> None:
        pose = pose_of(message)
        if self._player is not None:
            pivot = self._machine.frames.pivot(pose)
            joints = self._machine.kinematics.inverse(pivot, self._player.joints)
            self._following.measure(joints)
        elif self._machine_state in DRIVABLE:
            self._is_followed = False
            self._begin_at(pose)

    def _begin_at(self, T_base_platform: Pose) -> None:
        pose = self._machine.frames.pivot(T_base_platform)
        joints = self._machine.kinematics.inverse(pose)
        self._player = Player(self._machine, pose, joints, self._dt)
        self._player.override(self._override)
        names = self._machine.kinematics.joint_names
        self._following = Following(names, self._tolerance, self._dt)
        self._set_status(self._player.status if self._is_followed else CONNECTING)

    def _on_goal(self, message: PoseStamped) -> None:
        stamp = seconds(message.header.stamp)
        self._enabled_player().pursue(Goal(self._pivot_pose_of(message), stamp))

    def _pivot_pose_of(self, message: PoseStamped) -> Pose:
        """Of the pivot in the work frame; a message in the base frame tells the platform's."""
        pose = pose_of(message, (BASE_FRAME, WORK_FRAME))
        is_pivot = message.header.frame_id == WORK_FRAME
        return pose if is_pivot else self._machine.frames.pivot(pose)

    def _on_pivot(self, message: PointStamped) -> None:
        """Another pivot: taken once the machine stands still, since turns are about it."""
        try:
            self._next_frames = self._machine.frames.with_pivot(point_of(message, PLATFORM_FRAME))
        except ManipulatorError as error:
            self.get_logger().warning(f'pivot: {error}', throttle_duration_sec=1.0)

    def _take_frames(self, frames: Frames) -> None:
        old, self._machine = self._machine, in_frames(self._bare, frames)
        self._next_frames = None
        if self._player is not None:
            self._begin_at(old.frames.platform(self._player.state.pose))

    def _on_bad_goal(self, message: PoseStamped, error: ManipulatorError) -> None:
        self._last_refusal = str(error)
        mode = self._status.mode
        self._set_status(MotionStatus(mode, 'refused', seconds(message.header.stamp), str(error)))

    def _on_speed_override(self, message: Float64) -> None:
        try:
            if not 0.0 <= message.data <= 1.0:
                raise InvalidInput(f'{message.data:g} outside [0, 1]')
            self._override = message.data
            if self._player is not None:
                self._player.override(self._override)
        except ManipulatorError as error:
            self.get_logger().warning(f'speed_override: {error}', throttle_duration_sec=1.0)

    def _tick(self) -> None:
        self._jitter.tick()
        if self._next_frames is not None and (self._player is None or self._player.is_at_rest):
            self._take_frames(self._next_frames)
        if self._player is None:
            self._set_status(self._status)
            return
        if self._poses.age > POSE_DEADLINE:
            self._release(f'no pose for {POSE_DEADLINE} s')
            return
        if self._following.trouble:
            self._release(self._following.trouble)
            return
        before = self._player.status
        pose = self._player.step()
        self._following.command(self._player.joints)
        platform = self._machine.frames.platform(pose)
        self._setpoints.publish(pose_message(platform, self.get_clock().now().to_msg()))
        if self._player.status is not before:
            self._log_refusal(self._player.status)
            self._set_status(self._player.status)

    def _release(self, reason: str) -> None:
        """Lets go of the machine: no setpoints until it is enabled and its pose is known again."""
        self._player = None
        self.get_logger().info(f'goals are dropped: {reason}')
        self._set_status(MotionStatus('disabled', 'stopped', self._status.goal_stamp, reason))

    def _log_refusal(self, new: MotionStatus) -> None:
        if new.result == 'refused':
            self._refusals += 1
            self._last_refusal = new.reason
            self.get_logger().warning(f'goal refused: {new.reason}', throttle_duration_sec=1.0)

    def _set_status(self, new: MotionStatus) -> None:
        self._status = new
        if new == self._published:
            return
        self._published = new
        level = WARN if new.result == 'refused' else OK
        text = f'{new.result}: {new.reason}' if new.reason else new.result
        stamp = f'{new.goal_stamp:.9f}'
        values = {'mode': new.mode, 'result': new.result, 'goal_stamp': stamp}
        name = self.get_fully_qualified_name().lstrip('/')
        self._statuses.publish(status(level, name, text, values | {'reason': new.reason}))

    def _enabled_player(self) -> Player:
        if self._player is None:
            state = self._machine_state or 'not heard of'
            raise Refused(f'the machine is {state}: enable it first')
        if not self._is_followed:
            raise Refused(CONNECTING.reason)
        return self._player

    def _serve(self, act: Callable[[Player], str]) -> Callable[..., Trigger.Response]:
        """A Trigger service that answers with what `act` says, or with why it cannot."""

        def answer(request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
            try:
                response.message = act(self._enabled_player())
                response.success = True
            except ManipulatorError as error:
                response.message = str(error)
            return response

        return answer

    def _stop(self, player: Player) -> str:
        player.stop()
        return 'braking along the way, then holding'

    def _home(self, player: Player) -> str:
        goal = Goal(self._machine.kinematics.home, seconds(self.get_clock().now().to_msg()))
        player.pursue(goal)
        return 'going home'

    def _start_cycle(self, player: Player) -> str:
        player.start_cycle(self._cycle.read(player.state.pose))
        return 'cycling until stopped'

    def _on_pause(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        try:
            self._enabled_player().pause(request.data)
            response.success, response.message = True, 'paused' if request.data else 'going on'
        except ManipulatorError as error:
            response.message = str(error)
        return response

    def _on_plan(self, request: GetPlan.Request, response: GetPlan.Response) -> GetPlan.Response:
        """The poses that a move from start (from here, when start is zero) to goal would pass."""
        try:
            start = self._start_of(request)
            near = self._machine.kinematics.inverse(start)
            goal = self._pivot_pose_of(request.goal)
            move = plan_to(self._machine, MotionState.at_rest(start), goal, near, self._dt)
        except ManipulatorError as error:
            self.get_logger().warning(f'plan: {error}')
            return response
        stamp = self.get_clock().now().to_msg()
        times = np.append(np.arange(0.0, move.duration, self._dt), move.duration)
        poses = self._machine.frames.platform(move.at(times).pose)
        response.plan.header.stamp = stamp
        response.plan.poses = [pose_message(poses[i], stamp) for i in range(len(times))]
        return response

    def _start_of(self, request: GetPlan.Request) -> Pose:
        if request.start == PoseStamped():
            return self._enabled_player().state.pose
        return self._pivot_pose_of(request.start)

    def _report(self) -> Report:
        values = {
            'mode': self._status.mode,
            'result': self._status.result,
            'goals_refused': self._goals.refused + self._refusals,
            'last_refusal': self._last_refusal,
            'last_pose_age_s': self._poses.age,
            'tick_jitter_p50_ms': self._jitter.quantile(0.5) * 1e3,
            'tick_jitter_p99_ms': self._jitter.quantile(0.99) * 1e3,
        }
        return OK, self._status.result, values
