"""What the trajectory node does (manipulator/nodes/trajectory_node.py), without ROS."""

from manipulator.trajectory.goal import Goal
from manipulator.trajectory.motion_status import MotionStatus
from manipulator.trajectory.pilot import Pilot
from manipulator.trajectory.teleop import Teleop
from world.intake import Intake
from world.timeline import Process

DT = 0.01
DELAY = 0.06


class Supervisor(Process):
    """Goals, twists, poses and the bridge's word in; setpoints out.

    ages: of each setpoint when it went out, s.
    """

    def __init__(self, timeline, machine, setpoints):
        super().__init__(timeline)
        self.pilot = Pilot(machine, DT)
        self.teleop = Teleop(self.pilot, DELAY)
        self.statuses, self.ages = [], []
        self._seen = None
        self.pause_in_next_tick = 0.0
        self._setpoints = setpoints
        self._state_heard, self._ticked_at = float('-inf'), self.now
        self.on_goal = Intake(self, self._take_goal, self._refuse_goal)
        self.on_pose = Intake(self, lambda stamp, pose: self.pilot.note_pose(pose))
        self.on_joints = Intake(self, lambda stamp, joints: self._take_joints(joints))
        self.on_twist = Intake(self, self._take_twist)
        self.every(DT, self._tick)

    def on_machine_state(self, word, is_followed, is_measured):
        self._state_heard = self.now
        self.pilot.note_machine_state(word, is_followed, is_measured)
        self._note_status()

    def _take_joints(self, joints):
        if joints is not None:
            self.pilot.note_joints(joints)

    def _take_goal(self, stamp, pose):
        self.pilot.player.pursue(Goal(self.pilot.machine.frames.pivot(pose), stamp))

    def _refuse_goal(self, stamp, error):
        self._say(MotionStatus(self.pilot.status.mode, 'refused', stamp, str(error)))

    def _take_twist(self, stamp, source, twist):
        self.teleop.hear(source, twist, '', self.now)

    def _tick(self):
        since_last, self._ticked_at = self.now - self._ticked_at, self.now
        self._state_heard += max(since_last - DT, 0.0)
        self.pilot.note_stall(since_last)
        self.pilot.note_silence(self.on_pose.age)
        self.pilot.note_bridge_silence(self.now - self._state_heard)
        self.teleop.drive(self.now)
        pose, stamp, began = self.pilot.step(), self.stamp, self.now
        pause, self.pause_in_next_tick = self.pause_in_next_tick, 0.0
        if pause:
            self.freeze(pause)
        self.handle(lambda: self._send(pose, stamp, began))

    def _send(self, pose, stamp, began):
        self.pilot.note_stall(self.now - began)
        if pose is not None and self.pilot.is_driving:
            self.ages.append(self.stamp - stamp)
            self._setpoints.send(stamp, pose)
        self._note_status()

    def _note_status(self):
        if self.pilot.status != self._seen:
            self._seen = self.pilot.status
            self._say(self._seen)

    def _say(self, status):
        if not self.statuses or status != self.statuses[-1][1]:
            self.statuses.append((self.now, status))
