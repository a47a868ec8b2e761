"""The services of the trajectory node: stop, home, pause, start_cycle, plan."""

import time
from collections.abc import Callable
from threading import Thread

import numpy as np
from geometry_msgs.msg import PoseStamped
from nav_msgs.srv import GetPlan
from rclpy.node import Node
from std_srvs.srv import SetBool, Trigger

from manipulator.errors import ManipulatorError, Unreachable
from manipulator.machine import Machine
from manipulator.nodes.cycle_parameters import CycleParameters
from manipulator.nodes.messages import goal_of, pose_message, seconds
from manipulator.pose import Pose
from manipulator.reach.words import explained
from manipulator.trajectory.early_command import EarlyCommand
from manipulator.trajectory.goal import Goal
from manipulator.trajectory.motion_status import MotionStatus
from manipulator.trajectory.pilot import Pilot
from manipulator.trajectory.plan import MotionState
from manipulator.trajectory.planner import plan_to
from manipulator.trajectory.teleop import Teleop


class TrajectoryServices:
    """Answers with what will happen, or with why it will not."""

    def __init__(
        self,
        node: Node,
        pilot: Pilot,
        teleop: Teleop,
        early: EarlyCommand,
        dt: float,
        say: Callable[[MotionStatus], None],
    ) -> None:
        self._node = node
        self._pilot = pilot
        self._teleop = teleop
        self._early = early
        self._dt = dt
        self._say = say
        self._cycle = CycleParameters(node)
        for name, act in (
            ('stop', self._stop),
            ('home', self._home),
            ('start_cycle', self._start_cycle),
        ):
            node.create_service(Trigger, f'~/{name}', _trigger(act))
        node.create_service(SetBool, '~/pause', self._on_pause)
        node.create_service(GetPlan, '~/plan', self._on_plan)

    def _stop(self) -> str:
        self._early.drop('stopped before it began')
        self._pilot.player.stop()
        self._teleop.stop()
        return 'braking along the way, then holding'

    def _home(self) -> str:
        stamp = seconds(self._node.get_clock().now().to_msg())

        def refuse(error: ManipulatorError) -> None:
            self._say(MotionStatus(self._pilot.status.mode, 'refused', stamp, str(error)))

        def go() -> None:
            player = self._pilot.player
            player.pursue(Goal(self._pilot.machine.kinematics.home, stamp))

        self._early.take(go, refuse, time.monotonic())
        return 'going home'

    def _start_cycle(self) -> str:
        player = self._pilot.player
        player.start_cycle(self._cycle.read(player.state.pose))
        return 'cycling until stopped'

    def _on_pause(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        try:
            self._pilot.pause(request.data)
            response.success, response.message = True, 'paused' if request.data else 'going on'
        except ManipulatorError as error:
            response.message = str(error)
        return response

    def _on_plan(self, request: GetPlan.Request, response: GetPlan.Response) -> GetPlan.Response:
        """The platform's poses on a move from start (from here, when it is all zero) to goal."""
        machine = self._pilot.machine
        try:
            goal = goal_of(request.goal, machine.frames)
            start = self._start_of(request)
            near = machine.kinematics.inverse(start)
            move = plan_to(machine, MotionState.at_rest(start), goal, near, self._dt)
        except ManipulatorError as error:
            self._node.get_logger().warning(f'plan: {error}')
            if isinstance(error, Unreachable):
                # A tenth of a second's work: not in the thread that streams setpoints.
                Thread(target=self._explain, args=(machine, goal), daemon=True).start()
            return response
        stamp = self._node.get_clock().now().to_msg()
        times = np.append(np.arange(0.0, move.duration, self._dt), move.duration)
        poses = machine.frames.platform(move.at(times).pose)
        response.plan.header.stamp = stamp
        response.plan.poses = [pose_message(poses[i], stamp) for i in range(len(times))]
        return response

    def _explain(self, machine: Machine, goal: Pose) -> None:
        said = explained(machine, goal)
        if said:
            self._node.get_logger().info(f'plan: {said}')

    def _start_of(self, request: GetPlan.Request) -> Pose:
        if request.start == PoseStamped():
            return self._pilot.player.state.pose
        return goal_of(request.start, self._pilot.machine.frames)


def _trigger(act: Callable[[], str]) -> Callable[..., Trigger.Response]:
    def answer(request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        try:
            response.message = act()
            response.success = True
        except ManipulatorError as error:
            response.message = str(error)
        return response

    return answer
