"""The summary of one machine's run: what was commanded, measured and refused, as numbers."""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array
from manipulator.pose import Pose

POSE_COLUMNS = ('x_m', 'y_m', 'z_m', 'roll_rad', 'pitch_rad', 'yaw_rad')


@dataclass(frozen=True, eq=False)
class Series:
    """Values (n, k) at times (n,), in seconds from the beginning of the recording."""

    times: Array
    values: Array

    def __len__(self) -> int:
        """How many there are."""
        return len(self.times)

    def between(self, begin: float, end: float) -> 'Series':
        """The part from begin to end (s)."""
        inside = (self.times >= begin) & (self.times <= end)
        return Series(self.times[inside], self.values[inside])

    def before(self, times: Array) -> Array:
        """The last value at or before each of the times (m, k); NaN before the first."""
        if not len(self):
            return np.full((len(times), self.values.shape[1]), np.nan)
        index = np.searchsorted(self.times, times, side='right') - 1
        found: Array = np.where(index[:, None] < 0, np.nan, self.values[index])
        return found


@dataclass(frozen=True)
class Event:
    """A reported event: its source, what and why; count where it was reported repeatedly."""

    time: float
    source: str
    what: str
    reason: str = ''
    is_bad: bool = False
    count: int = 1


@dataclass(frozen=True, eq=False)
class RunSummary:
    """Poses as x, y, z, roll, pitch, yaw (m, rad; angles without jumps); joints in rad or m."""

    namespace: str
    duration: float
    joint_names: tuple[str, ...]
    setpoint: Series
    pose: Series
    goals: Series
    joint_command: Series
    joint_states: Series
    events: tuple[Event, ...]

    def between(self, begin: float, end: float) -> 'RunSummary':
        """The part from begin to end (s from the beginning of the recording)."""
        series = ('setpoint', 'pose', 'goals', 'joint_command', 'joint_states')
        cut = {name: getattr(self, name).between(begin, end) for name in series}
        events = tuple(e for e in self.events if begin <= e.time <= end)
        return RunSummary(self.namespace, self.duration, self.joint_names, events=events, **cut)

    @property
    def pose_error(self) -> Series:
        """How far each pose is from the last setpoint before it: distance (m), angle (rad)."""
        commanded, measured = self.setpoint.before(self.pose.times), self.pose.values
        known = ~np.isnan(commanded[:, 0])
        commanded, measured = commanded[known], measured[known]
        twist = Pose.from_xyz_rpy(
            commanded[:, :3], commanded[:, 3:]
        ).inverse() @ Pose.from_xyz_rpy(measured[:, :3], measured[:, 3:])
        angle = np.arccos(np.clip((np.trace(twist.rotation, axis1=1, axis2=2) - 1) / 2, -1, 1))
        distance = np.linalg.norm(commanded[:, :3] - measured[:, :3], axis=1)
        return Series(self.pose.times[known], np.stack([distance, angle], axis=1))

    @property
    def joint_error(self) -> Series:
        """How far each joint is from its last command before (n, joints)."""
        commanded = self.joint_command.before(self.joint_states.times)
        return Series(self.joint_states.times, self.joint_states.values - commanded)
