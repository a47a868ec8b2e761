"""The services of the trajectory node: stop, home, park, pause, start_cycle, plan."""

import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from geometry_msgs.msg import PoseStamped
from nav_msgs.srv import GetPlan
from rclpy.node import Node
from std_srvs.srv import SetBool, Trigger

from manipulator.errors import ManipulatorError
from manipulator.machine import Machine
from manipulator.nodes.late_answers import Call, create_late_service
from manipulator.nodes.messages import goal_of, pose_message, seconds
from manipulator.nodes.parameters import CycleParameters, GoalParameters
from manipulator.planning.goal import Goal
from manipulator.planning.plan import MotionState
from manipulator.planning.planner import ComparedPlan, compared
from manipulator.planning.start import Start
from manipulator.planning.worker import Job, Worker
from manipulator.trajectory.controller import MotionController

STAMP = ', goal_stamp '
"""What precedes the stamp in the answers of home and park: motion_status names the move by it."""


def named(stamp: float) -> str:
    """The end of an answer: the stamp, as motion_status has it."""
    return f'{STAMP}{stamp:.9f}'


@dataclass(frozen=True, eq=False)
class _PlanCall:
    """A request for a plan that is being made."""

    call: Call
    machine: Machine
    job: Job[ComparedPlan]


class TrajectoryServices:
    """Answers with what will happen, or with why it will not; `poll` is called at every tick."""

    def __init__(
        self,
        node: Node,
        controller: MotionController,
        parameters: GoalParameters,
        dt: float,
        worker: Worker,
    ) -> None:
        self._node = node
        self._controller = controller
        self._parameters = parameters
        self._dt = dt
        self._worker = worker
        self._cycle = CycleParameters(node)
        self._cycles: list[tuple[Call, float]] = []
        self._plan: _PlanCall | None = None
        self._waiting: deque[Call] = deque()
        for name, act in (('stop', self._stop), ('home', self._home), ('park', self._park)):
            node.create_service(Trigger, f'~/{name}', _trigger(act))
        node.create_service(SetBool, '~/pause', self._on_pause)
        create_late_service(node, Trigger, '~/start_cycle', self._on_start_cycle)
        create_late_service(node, GetPlan, '~/plan', self._waiting.append)

    def poll(self) -> None:
        """Answers what can be answered by now."""
        for call, stamp in tuple(self._cycles):
            answer = self._controller.cycle_answer(stamp)
            if answer is not None:
                self._cycles.remove((call, stamp))
                call.response.success, call.response.message = answer.is_obeyed, answer.text
                call.send()
        if self._plan is not None and self._plan.job.is_done:
            plan, self._plan = self._plan, None
            self._answer_plan(plan)
        if self._plan is None and self._waiting:
            self._begin_plan(self._waiting.popleft())

    def _stop(self) -> str:
        self._controller.stop()
        return 'braking along the path, then holding'

    def _home(self) -> str:
        stamp = self._now()
        self._controller.home(stamp, time.monotonic())
        return f'going home{named(stamp)}'

    def _park(self) -> str:
        stamp = self._now()
        self._controller.park(stamp, time.monotonic())
        return f'going to park{named(stamp)}'

    def _on_pause(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        try:
            self._controller.supervisor.pause(request.data)
            response.success, response.message = True, 'paused' if request.data else 'going on'
        except ManipulatorError as error:
            response.message = str(error)
        return response

    def _on_start_cycle(self, call: Call) -> None:
        stamp = self._now()
        try:
            self._controller.start_cycle(self._cycle.read, stamp)
        except ManipulatorError as error:
            call.response.message = str(error)
            call.send()
        else:
            self._cycles.append((call, stamp))

    def _begin_plan(self, call: Call) -> None:
        """The platform's poses on a move from start (from here, when it is all zero) to goal.

        One at a time: goals to drive to wait for no more than one such question.
        """
        machine = self._controller.supervisor.machine
        try:
            goal = goal_of(call.request.goal, machine.frames)
            start = self._start_of(call.request)
            request = Goal(goal, motion=self._parameters.motion)
            job = self._worker.submit(lambda effort: compared(machine, start, request, effort))
        except ManipulatorError as error:
            self._node.get_logger().warning(f'plan: {error}')
            call.send()
        else:
            self._plan = _PlanCall(call, machine, job)

    def _answer_plan(self, plan: _PlanCall) -> None:
        machine, response = plan.machine, plan.call.response
        try:
            compared_plan = plan.job.result()
        except ManipulatorError as error:
            self._node.get_logger().warning(f'plan: {error}')
        else:
            move = compared_plan.plan
            self._node.get_logger().info(f'plan: {compared_plan}')
            stamp = self._node.get_clock().now().to_msg()
            times = np.append(np.arange(0.0, move.duration, self._dt), move.duration)
            poses = machine.frames.platform(move.at(times).pose)
            response.plan.header.stamp = stamp
            response.plan.poses = [pose_message(poses[i], stamp) for i in range(len(times))]
        plan.call.send()

    def _start_of(self, request: GetPlan.Request) -> Start:
        machine = self._controller.supervisor.machine
        if request.start == PoseStamped():
            executor = self._controller.supervisor.executor
            pose, joints = executor.state.pose, executor.joints
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
