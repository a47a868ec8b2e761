"""The services of the trajectory node: stop, home, park, pause, start_cycle, plan."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from threading import Thread

import numpy as np
from geometry_msgs.msg import PoseStamped
from nav_msgs.srv import GetPlan
from rclpy.node import Node
from std_srvs.srv import SetBool, Trigger

from manipulator.arrays import Array
from manipulator.errors import ManipulatorError, NoSolution, Refused, Unreachable
from manipulator.machine import Machine
from manipulator.nodes.cycle_parameters import CycleParameters
from manipulator.nodes.late_answers import Call, create_late_service
from manipulator.nodes.messages import goal_of, pose_message, seconds
from manipulator.pose import Pose
from manipulator.reach.words import explained
from manipulator.trajectory.early_command import EarlyCommand
from manipulator.trajectory.goal import Goal, Motion
from manipulator.trajectory.motion_status import MotionStatus
from manipulator.trajectory.pilot import Pilot
from manipulator.trajectory.plan import MotionState, Plan
from manipulator.trajectory.planner import Start, plan_goal
from manipulator.trajectory.teleop import Teleop
from manipulator.trajectory.worker import Job, Worker


@dataclass(frozen=True, eq=False)
class _PlanCall:
    """A request for a plan that is being worked out."""

    call: Call
    machine: Machine
    goal: Pose
    job: Job[Plan]


class TrajectoryServices:
    """Answers with what will happen, or with why it will not; `poll` is called at every tick."""

    def __init__(
        self,
        node: Node,
        pilot: Pilot,
        teleop: Teleop,
        early: EarlyCommand,
        dt: float,
        worker: Worker,
        say: Callable[[MotionStatus], None],
    ) -> None:
        self._node = node
        self._pilot = pilot
        self._teleop = teleop
        self._early = early
        self._dt = dt
        self._worker = worker
        self._say = say
        self._cycle = CycleParameters(node)
        self._cycles: list[tuple[Call, float]] = []
        self._plans: list[_PlanCall] = []
        for name, act in (('stop', self._stop), ('home', self._home), ('park', self._park)):
            node.create_service(Trigger, f'~/{name}', _trigger(act))
        node.create_service(SetBool, '~/pause', self._on_pause)
        create_late_service(node, Trigger, '~/start_cycle', self._on_start_cycle)
        create_late_service(node, GetPlan, '~/plan', self._on_plan)

    def poll(self) -> None:
        """Answers what can be answered by now."""
        for cycle in tuple(self._cycles):
            if self._answer_cycle(*cycle):
                self._cycles.remove(cycle)
        for plan in [p for p in self._plans if p.job.is_done]:
            self._plans.remove(plan)
            self._answer_plan(plan)

    def _stop(self) -> str:
        self._early.drop('stopped before it began')
        self._pilot.player.stop()
        self._teleop.stop()
        return 'braking along the way, then holding'

    def _home(self) -> str:
        machine = self._pilot.machine
        home = machine.kinematics.home
        self._go(home, machine.kinematics.inverse(home))
        return 'going home'

    def _park(self) -> str:
        machine = self._pilot.machine
        if machine.park is None:
            raise Refused('the machine file has no usable park position (section servos)')
        try:
            pose = machine.kinematics.forward(machine.park).pose
        except NoSolution as error:
            raise Refused(f'the park position is no pose that can be trusted: {error}') from error
        self._go(pose, machine.park)
        return 'going to park'

    def _go(self, pose: Pose, joints: Array) -> None:
        """To joints (n,) at a pose, along a line or else by a joint move."""
        goal = Goal(pose, self._now(), motion=Motion.ANY, joints=joints)

        def refuse(error: ManipulatorError) -> None:
            self._say(MotionStatus(self._pilot.status.mode, 'refused', goal.stamp, str(error)))

        self._early.take(lambda: self._pilot.player.pursue(goal), refuse, time.monotonic())

    def _on_pause(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        try:
            self._pilot.pause(request.data)
            response.success, response.message = True, 'paused' if request.data else 'going on'
        except ManipulatorError as error:
            response.message = str(error)
        return response

    def _on_start_cycle(self, call: Call) -> None:
        stamp = self._now()
        try:
            player = self._pilot.player
            player.start_cycle(self._cycle.read(player.state.pose), stamp)
        except ManipulatorError as error:
            call.response.message = str(error)
            call.send()
        else:
            self._cycles.append((call, stamp))

    def _answer_cycle(self, call: Call, stamp: float) -> bool:
        """Answers once the cycle is begun or refused, by the motion's status."""
        status, response = self._pilot.status, call.response
        if status.goal_stamp == stamp and status.result == 'moving':
            response.success, response.message = True, 'cycling until stopped'
        elif status.goal_stamp == stamp and status.result in ('refused', 'stopped'):
            response.message = status.reason or status.result
        elif self._is_awaited(stamp):
            return False
        else:
            response.message = 'a newer command came before it began'
        call.send()
        return True

    def _is_awaited(self, stamp: float) -> bool:
        try:
            return self._pilot.player.newest_stamp == stamp
        except Refused:
            return False

    def _on_plan(self, call: Call) -> None:
        """The platform's poses on a move from start (from here, when it is all zero) to goal."""
        machine = self._pilot.machine
        try:
            goal = goal_of(call.request.goal, machine.frames)
            start = self._start_of(call.request)
            job = self._worker.submit(lambda effort: plan_goal(machine, start, Goal(goal), effort))
        except ManipulatorError as error:
            self._node.get_logger().warning(f'plan: {error}')
            call.send()
        else:
            self._plans.append(_PlanCall(call, machine, goal, job))

    def _answer_plan(self, plan: _PlanCall) -> None:
        machine, response = plan.machine, plan.call.response
        try:
            move = plan.job.result()
        except ManipulatorError as error:
            self._node.get_logger().warning(f'plan: {error}')
            if isinstance(error, Unreachable):
                # A tenth of a second's work: not in the thread that streams setpoints.
                Thread(target=self._explain, args=(machine, plan.goal), daemon=True).start()
        else:
            stamp = self._node.get_clock().now().to_msg()
            times = np.append(np.arange(0.0, move.duration, self._dt), move.duration)
            poses = machine.frames.platform(move.at(times).pose)
            response.plan.header.stamp = stamp
            response.plan.poses = [pose_message(poses[i], stamp) for i in range(len(times))]
        plan.call.send()

    def _explain(self, machine: Machine, goal: Pose) -> None:
        said = explained(machine, goal)
        if said:
            self._node.get_logger().info(f'plan: {said}')

    def _start_of(self, request: GetPlan.Request) -> Start:
        machine = self._pilot.machine
        if request.start == PoseStamped():
            player = self._pilot.player
            pose, joints = player.state.pose, player.joints
        else:
            pose = goal_of(request.start, machine.frames)
            joints = machine.kinematics.inverse(pose)
        return Start(MotionState.at_rest(pose), joints, self._dt)

    def _now(self) -> float:
        return seconds(self._node.get_clock().now().to_msg())


def _trigger(act: Callable[[], str]) -> Callable[..., Trigger.Response]:
    def answer(request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        try:
            response.message = act()
            response.success = True
        except ManipulatorError as error:
            response.message = str(error)
        return response

    return answer
