"""The owner of the Cartesian state: goals in, one setpoint a tick out while enabled."""

import time
from collections.abc import Callable
from dataclasses import replace

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PointStamped, PoseStamped
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, String

from manipulator.errors import ManipulatorError
from manipulator.machine import JOG_SINGULARITIES, Machine
from manipulator.nodes.diagnostics import ERROR, OK, WARN, Diagnostics, Report, status
from manipulator.nodes.intra_process import IntraProcess
from manipulator.nodes.joint_topics import JointTopics
from manipulator.nodes.messages import (
    BASE_FRAME,
    PLATFORM_FRAME,
    WORK_FRAME,
    joint_message,
    known_joints,
    point_of,
    pose_message,
    pose_of,
    seconds,
)
from manipulator.nodes.parameters import GoalParameters, declare
from manipulator.nodes.path_goals import PathGoals
from manipulator.nodes.planning_thread import PlanningThread
from manipulator.nodes.qos import COMMAND, LATCHED, MEASUREMENT
from manipulator.nodes.steady_timer import SteadyTimer
from manipulator.nodes.subscriptions import FilteredCallback
from manipulator.nodes.teleop_topics import TeleopTopics
from manipulator.nodes.trajectory_action import TrajectoryAction
from manipulator.nodes.trajectory_services import TrajectoryServices
from manipulator.planning.goal import Goal
from manipulator.pose import Pose
from manipulator.states import MotionResult
from manipulator.teleop.arbiter import PEOPLE
from manipulator.trajectory.controller import MotionController, lag_of
from manipulator.trajectory.following_error import Tolerances
from manipulator.trajectory.motion_status import MotionStatus
from manipulator.trajectory.supervisor import MEASUREMENT_DELAY

DELAY = 'age in seconds of a measured pose by the time that its correction moves the joints'
SINGULARITY = 'what a jogged arm does where it cannot keep its direction: stop or slide'
TOLERANCE = (
    'how far a joint may be from its commands of the last half second (rad or m); '
    '0: 6 % of its range, at most 0.2 rad'
)
GOAL_TOLERANCE = (
    'how far a reported joint may be from a goal that is reached (rad or m); '
    '0: 1 % of its range, at most 0.5 degrees'
)
POSE_TOLERANCE = (
    'how far the pose of measured joints may be from a goal that is reached (m; turns in '
    'proportion); 0: 0.1 % of the characteristic length, or all joints within two counts'
)


class TrajectoryNode(Node):
    """goal_pose, pose, machine_state in; setpoint, motion_status out; see docs/interfaces.md."""

    def __init__(
        self, load: Callable[[str], Machine], default_machine: str, process: IntraProcess
    ) -> None:
        super().__init__('trajectory')
        name = declare(self, 'machine', default_machine, 'machine file: a shipped name or a path')
        rate = declare(self, 'rate', 100.0, 'setpoints per second (Hz)', (10.0, 500.0))
        tolerance = declare(self, 'following_tolerance', 0.0, TOLERANCE, (0.0, 10.0))
        goal_tolerance = declare(self, 'goal_tolerance', 0.0, GOAL_TOLERANCE, (0.0, 10.0))
        distance = declare(self, 'pose_tolerance', 0.0, POSE_TOLERANCE, (0.0, 1.0))
        self._goal_parameters = GoalParameters(self)
        delay = declare(self, 'measurement_delay', MEASUREMENT_DELAY, DELAY, (0.0, 1.0))
        singularity = declare(self, 'jog_singularity', JOG_SINGULARITIES[0], SINGULARITY)
        dt, self._worker = 1.0 / rate, PlanningThread()
        machine = replace(load(name), jog_singularity=singularity)
        self._names = machine.kinematics.joint_names
        tolerances = Tolerances.of(machine, tolerance, goal_tolerance, distance)
        self._controller = MotionController(machine, dt, tolerances, self._worker, delay)
        self._connect(process)
        PathGoals(self, self._controller, self._goal_parameters)
        joints = JointTopics(self, self._controller, tolerances.goal)
        self._action = TrajectoryAction(self, self._controller, joints)
        self._teleop_topics = TeleopTopics(self, self._controller.teleop)
        self._answers = TrajectoryServices(
            self, self._controller, self._goal_parameters, dt, self._worker
        )
        self._timer = SteadyTimer(self, dt, self._tick)
        self._diagnostics = Diagnostics(self, self._report, ('setpoint', 'pose', *PEOPLE))

    def close(self) -> None:
        """Ends what runs beside this node."""
        self._action.close()
        self._controller.close()
        self._worker.close()

    def _connect(self, process: IntraProcess) -> None:
        self._goals = FilteredCallback(self, 'goal_pose', self._on_goal, self._on_bad_goal)
        self._poses = FilteredCallback(self, 'pose', self._on_pose)
        self._joints = FilteredCallback(self, 'joint_states', self._on_joint_states)
        self._setpoints = process.publisher(self, PoseStamped, 'setpoint', COMMAND)
        self._joint_setpoints = process.publisher(self, JointState, 'joint_setpoint', COMMAND)
        self._statuses = self.create_publisher(DiagnosticStatus, 'motion_status', LATCHED)
        subscribe = self.create_subscription
        subscribe(PoseStamped, 'goal_pose', self._goals, COMMAND)
        process.subscribe(self, PoseStamped, 'pose', self._poses, MEASUREMENT)
        process.subscribe(self, JointState, 'joint_states', self._joints, MEASUREMENT)
        subscribe(DiagnosticStatus, 'machine_state', self._on_machine_state, LATCHED)
        subscribe(Float64, 'speed_override', self._on_speed_override, COMMAND)
        subscribe(PointStamped, 'pivot', self._on_pivot, COMMAND)
        subscribe(String, 'tool', self._on_tool, COMMAND)

    def _on_machine_state(self, message: DiagnosticStatus) -> None:
        values = {pair.key: pair.value for pair in message.values}
        is_followed = values.get('followed') == 'yes'
        is_measured = values.get('joints') == 'measured'
        self._controller.note_machine_state(
            message.message[:80], is_followed, is_measured, time.monotonic()
        )
        self._publish_news()

    def _on_joint_states(self, message: JointState) -> None:
        self._controller.note_joints(known_joints(message, self._names))

    def _on_pose(self, message: PoseStamped) -> None:
        self._controller.note_pose(pose_of(message), time.monotonic(), self._poses.lateness)

    def _on_goal(self, message: PoseStamped) -> None:
        is_of_platform = message.header.frame_id != WORK_FRAME
        chosen = self._goal_parameters
        rule = self._controller.orientation_rule(chosen.orientation, is_of_platform)
        pose = pose_of(message, (BASE_FRAME, WORK_FRAME), rule.is_given)
        stamp = seconds(message.header.stamp)
        self._controller.pursue(
            Goal(
                pose,
                stamp,
                motion=chosen.motion,
                orientation=rule,
                on_unreachable=chosen.on_unreachable,
            ),
            lambda error: self._goals.refuse(message, error),
            time.monotonic(),
            is_of_platform,
        )

    def _on_bad_goal(self, message: PoseStamped, error: ManipulatorError) -> None:
        self._controller.refuse(seconds(message.header.stamp), error)
        self._publish_news()

    def _on_speed_override(self, message: Float64) -> None:
        try:
            self._controller.supervisor.override(message.data)
        except ManipulatorError as error:
            self.get_logger().warning(str(error), throttle_duration_sec=1.0)

    def _on_pivot(self, message: PointStamped) -> None:
        try:
            self._controller.supervisor.set_pivot(point_of(message, PLATFORM_FRAME))
        except ManipulatorError as error:
            self.get_logger().warning(f'pivot: {error}', throttle_duration_sec=1.0)

    def _on_tool(self, message: String) -> None:
        try:
            self._controller.supervisor.use_tool(message.data)
        except ManipulatorError as error:
            self.get_logger().warning(f'tool: {error}', throttle_duration_sec=1.0)

    def _tick(self) -> None:
        self._controller.begin_tick(time.monotonic())
        stamp = self.get_clock().now().to_msg()
        pose = self._controller.end_tick(time.monotonic())
        if pose is not None:
            self._publish_setpoint(pose, stamp)
        self._answers.poll()
        self._publish_news()
        self._action.poll(time.monotonic())

    def _publish_setpoint(self, pose: Pose, stamp: Time) -> None:
        joints = self._controller.supervisor.requested_joints
        if joints is not None:
            self._joint_setpoints.publish(joint_message(joints, self._names, stamp))
        self._setpoints.publish(pose_message(pose, stamp))

    def _publish_news(self) -> None:
        for new in self._controller.news.take():
            self._publish(new)
            self._action.note(new)

    def _publish(self, new: MotionStatus) -> None:
        """Publishes a status; refusals and stops are logged."""
        text = f'{new.result}: {new.reason}' if new.reason else new.result
        if new.result == MotionResult.REFUSED:
            self.get_logger().warning(f'goal {text}', throttle_duration_sec=1.0)
        elif new.result == MotionResult.STOPPED:
            self.get_logger().info(text)
        values = {
            'mode': new.mode,
            'result': new.result,
            'goal_stamp': f'{new.goal_stamp:.9f}',
            'reason': new.reason,
        }
        if new.percent is not None:
            values['percent'] = str(new.percent)
        name = self.get_fully_qualified_name().lstrip('/')
        level = WARN if new.result == MotionResult.REFUSED else OK
        self._statuses.publish(status(level, name, text, values))

    def _report(self) -> Report:
        supervisor, news = self._controller.supervisor, self._controller.news
        jitter, now = self._controller.jitter, supervisor.status
        values = {
            'mode': now.mode,
            'result': now.result,
            'goals_refused': news.refusals,
            'last_refusal': news.last_refusal,
            **lag_of(supervisor),
            **self._teleop_topics.report(),
            'tool': supervisor.machine.frames.tool,
            'last_pose_age_s': self._poses.age,
            'tick_jitter_p50_ms': jitter.quantile(0.5) * 1e3,
            'tick_jitter_p99_ms': jitter.quantile(0.99) * 1e3,
        }
        conflict = self._teleop_topics.conflict
        if conflict:
            return ERROR, f'{conflict}: end all but one, then release the deadman', values
        return OK, now.reason or now.result, values
