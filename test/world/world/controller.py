"""The process of the motion controller, with its thread for plans."""

from concurrent.futures import Future
from threading import Event

from manipulator.errors import ManipulatorError
from manipulator.planning.goal import Goal, OnUnreachable
from manipulator.planning.worker import Effort, Job
from manipulator.trajectory.controller import MotionController
from world.filtered_callback import FilteredCallback
from world.timeline import Process

DT = 0.01
PLANNING_S = 0.02


class Thread:
    """Works tasks out one after the other, each in `seconds`, also while its process is frozen."""

    is_beside = True

    def __init__(self, timeline, seconds=PLANNING_S):
        self.seconds = seconds
        self._timeline = timeline
        self._free_at = timeline.now

    def submit(self, task):
        future, cancelled = Future(), Event()
        self._free_at = max(self._free_at, self._timeline.now) + self.seconds
        wait = self._free_at - self._timeline.now
        self._timeline.after(wait, lambda: self._work_out(task, future, cancelled))
        return Job(future, cancelled.set)

    def _work_out(self, task, future, cancelled):
        if future.set_running_or_notify_cancel():
            try:
                future.set_result(task(Effort(is_cancelled=cancelled.is_set)))
            except ManipulatorError as error:
                future.set_exception(error)


class ControllerProcess(Process):
    """Goals, paths, twists, poses, joints and the bridge's word in; setpoints and statuses out.

    statuses, requested: as they were published, with their times. ages: of each setpoint when it
    went out, s.
    """

    def __init__(self, timeline, machine, setpoints, requested):
        super().__init__(timeline)
        self.thread = Thread(timeline)
        self.core = MotionController(machine, DT, worker=self.thread)
        self.statuses, self.ages = [], []
        self.pause_in_next_tick = 0.0
        self.on_unreachable = OnUnreachable.REFUSE
        self._setpoints, self._requested = setpoints, requested
        self.requested = []
        self.on_goal = FilteredCallback(self, self._take_goal, self._refuse)
        self.on_path = FilteredCallback(self, self._take_path, self._refuse)
        self.on_goal_joints = FilteredCallback(self, self._take_goal_joints, self._refuse)
        self.on_trajectory = FilteredCallback(self, self._take_trajectory, self._refuse)
        self.on_joint_rates = FilteredCallback(self, self._take_joint_rates)
        self.on_pose = FilteredCallback(self, self._take_pose)
        self.on_joints = FilteredCallback(
            self, lambda stamp, joints: self.core.note_joints(joints)
        )
        self.on_twist = FilteredCallback(self, self._take_twist)
        self.every(DT, self._tick)

    @property
    def supervisor(self):
        return self.core.supervisor

    @property
    def teleop(self):
        return self.core.teleop

    def on_machine_state(self, word, is_followed, is_measured):
        self.core.note_machine_state(word, is_followed, is_measured, self.now)
        self._publish_news()

    def _take_pose(self, stamp, pose):
        self.core.note_pose(pose, self.now, self.on_pose.lateness)

    def _take_goal(self, stamp, pose):
        refuse = self._later(self.on_goal, stamp)
        goal = Goal(pose, stamp, on_unreachable=self.on_unreachable)
        self.core.pursue(goal, refuse, self.now)

    def _take_path(self, stamp, path):
        self.core.follow(path, self._later(self.on_path, stamp), self.now)

    def _take_goal_joints(self, stamp, named):
        refuse = self._later(self.on_goal_joints, stamp)
        self.core.move_joints(named, stamp, refuse, self.now)

    def _take_trajectory(self, stamp, goal):
        self.core.follow_joints(goal, self._later(self.on_trajectory, stamp), self.now)

    def _take_joint_rates(self, stamp, source, rates):
        self.teleop.receive_joints(source, rates, self.now)

    def _later(self, callback, stamp):
        return lambda error: callback.refuse(stamp, error)

    def _refuse(self, stamp, error):
        self.core.refuse(stamp, error)
        self._publish_news()

    def _take_twist(self, stamp, source, twist, frame=''):
        self.teleop.receive(source, twist, frame, self.now)

    def _tick(self):
        self.core.begin_tick(self.now)
        stamp = self.stamp
        pause, self.pause_in_next_tick = self.pause_in_next_tick, 0.0
        if pause:
            self.freeze(pause)
        self.handle(lambda: self._end_tick(stamp))

    def _end_tick(self, stamp):
        pose = self.core.end_tick(self.now)
        if pose is not None:
            self.ages.append(self.stamp - stamp)
            joints = self.supervisor.requested_joints
            if joints is not None:
                self.requested.append((self.now, joints))
                self._requested.send(joints)
            self._setpoints.send(stamp, pose)
        self._publish_news()

    def _publish_news(self):
        self.statuses += [(self.now, status) for status in self.core.news.take()]
