"""One machine, its processes and links, and the user who asks for something."""

import numpy as np

from bridge.calibration import Calibration
from bridge.driver import BoardDriver
from bridge.fake.board_thread import FakeMachine
from bridge.protocol import Setpoint
from bridge.servo_config import BoardConfig
from hexarm import machines
from hexarm.board.kinematics import crank_hexapod
from manipulator.planning.joint_points import joint_points
from manipulator.planning.path import Tolerance
from manipulator.planning.path_timing import PathRequest
from manipulator.trajectory.following_error import Tolerances
from manipulator.trajectory.path_planning import PathGoal, TrajectoryGoal
from world.board import BoardProcess, Cable
from world.bridge import Bridge
from world.controller import ControllerProcess
from world.kinematics import Forward, Inverse
from world.timeline import Link, Process, Timeline

PATIENCE = 20.0
TWIST_PERIOD = 1 / 30
PATH_TOLERANCE = Tolerance(1e-4, np.radians(0.1))
MEASUREMENTS = 5
"""Depth of the measurements' links; commands have 1 (manipulator/nodes/qos.py)."""


class World:
    """A machine by its name or the path of its file; time passes in `run` and `wait`.

    hysteresis: play of each servo, rad or m; None: the machine file's.
    """

    def __init__(self, name, boot_s=0.2, hysteresis=None):
        self.machine = machines.load(name)
        self._config = config = BoardConfig.from_machine(machines.read(name))
        self.calibration = Calibration.from_config(config.servos)
        self.timeline = Timeline()
        self.bridge = None
        self.user = Process(self.timeline)
        play = config.hysteresis if hysteresis is None else hysteresis
        hexapod = crank_hexapod(self.machine, self.calibration)
        fake = FakeMachine.from_config(config, boot_s, hysteresis=play, hexapod=hexapod)
        self.board = BoardProcess(self.timeline, fake)
        self.cable = self.board.cable = Cable(self.timeline, self.board)
        nobody = self.user
        names = ('setpoint', 'requested', 'commands', 'words', 'goals', 'paths', 'twists')
        names += ('goal_joints', 'trajectories', 'joint_rates')
        self.links = {name: Link(nobody, None) for name in names}
        deep = ('pose', 'joints_ik', 'joints_pose', 'joints')
        self.links |= {name: Link(nobody, None, depth=MEASUREMENTS) for name in deep}
        for start in (self.start_controller, self.start_inverse, self.start_forward):
            start()
        self.start_bridge()

    # Processes: each start takes the place of the one before, which is dead

    def start_controller(self):
        out = self.links['setpoint'], self.links['requested']
        new = self.controller = ControllerProcess(self.timeline, self.machine, *out)
        for link, accept in (
            ('words', new.on_machine_state),
            ('goals', new.on_goal),
            ('paths', new.on_path),
            ('twists', new.on_twist),
            ('goal_joints', new.on_goal_joints),
            ('trajectories', new.on_trajectory),
            ('joint_rates', new.on_joint_rates),
            ('pose', new.on_pose),
            ('joints', new.on_joints),
        ):
            self.links[link].lead_to(new, accept)

    def start_inverse(self):
        new = self.inverse = Inverse(self.timeline, self.machine, self.links['commands'])
        self.links['setpoint'].lead_to(new, new.on_setpoint)
        self.links['requested'].lead_to(new, new.on_requested)
        self.links['joints_ik'].lead_to(new, new.on_joints)

    def start_forward(self):
        new = self.forward = Forward(self.timeline, self.machine, self.links['pose'])
        self.links['joints_pose'].lead_to(new, new.on_joints)

    def start_bridge(self):
        new = self.bridge = Bridge(
            self.timeline,
            self._config,
            self.machine.kinematics.joint_names,
            self.cable,
            self.links['words'],
            Fan([self.links[name] for name in ('joints', 'joints_ik', 'joints_pose')]),
        )
        self.links['commands'].lead_to(new, new.on_command)
        self.cable.lead_to(new)

    def restart(self, name):
        """Kills a process and starts another in its place."""
        getattr(self, name).kill()
        getattr(self, f'start_{name}')()

    # Time

    @property
    def now(self):
        return self.timeline.now

    def run(self, seconds):
        self.timeline.run(seconds)

    def wait(self, what, is_so, seconds=PATIENCE):
        end = self.now + seconds
        while not is_so():
            assert self.now < end, f'no {what} within {seconds:g} s: {self.summary}'
            self.run(0.01)

    # What is known

    @property
    def joints(self):
        """Where the joints truly are (n,)."""
        order = [self.calibration.names.index(n) for n in self.machine.kinematics.joint_names]
        return self.board.machine.servos.positions[order]

    @property
    def state(self):
        return self.bridge.monitor.status.state

    @property
    def status(self):
        """The last motion_status."""
        return self.controller.statuses[-1][1]

    @property
    def summary(self):
        return f'machine {self.state}, motion {self.status}'

    @property
    def pose(self):
        """Where the platform truly is."""
        supervisor = self.controller.supervisor
        near = self.machine.kinematics.home
        if supervisor.is_driving:
            near = supervisor.machine.frames.platform(supervisor.executor.state.pose)
        return self.machine.kinematics.forward(self.joints, near).pose

    def frames(self, kind=object, since=float('-inf')):
        """(time, message) of what the host put on the cable."""
        return [(t, m) for t, m in self.cable.frames if t >= since and isinstance(m, kind)]

    def setpoints(self, since=float('-inf')):
        """Counts (n, channels) of the setpoint frames."""
        return np.array([m.counts for _, m in self.frames(Setpoint, since)], dtype=float)

    def pulses(self, since=float('-inf')):
        """Counts (n, channels) that the board put out, 100 times a second."""
        return np.array([counts for t, counts in self.board.pulses if t >= since])

    def moved(self, since):
        """The largest difference, in counts, of a pulse from the first since then."""
        pulses = self.pulses(since)
        return np.nanmax(np.abs(pulses - pulses[0]))

    def steps(self, since):
        """The largest change of a count from each setpoint frame to the next."""
        return np.abs(np.diff(self.setpoints(since), axis=0)).max(axis=1)

    # The user

    def ask(self, question):
        """What a service of the bridge answered, '' for obeyed: `ask(BoardDriver.stop)`."""
        answer = self.bridge.ask(question)
        self.wait('answer', lambda: answer.said is not None)
        return answer.said

    def ask_to_arm(self):
        """The answer that is to come."""
        return self.bridge.ask(lambda driver: driver.enable(True))

    def enable(self):
        self.wait('board', lambda: self.state not in ('disconnected', 'booting'))
        assert self.ask(lambda driver: driver.enable(True)) == ''
        self.wait('enabled machine', lambda: self.state == 'enabled')
        self.wait('controller that holds', lambda: self.status.mode == 'hold')

    def disable(self):
        return self.ask(lambda driver: driver.enable(False))

    def emergency_stop(self):
        """The answer that is to come."""
        return self.bridge.ask(BoardDriver.stop)

    def clear(self):
        return self.ask(BoardDriver.clear_fault)

    def send_goal(self, pose):
        """Its stamp, by which the statuses know it."""
        stamp = self.user.stamp
        self.links['goals'].send(stamp, pose)
        return stamp

    def send_goal_joints(self, **named):
        """As `send_goal`, to positions of joints."""
        stamp = self.user.stamp
        self.links['goal_joints'].send(stamp, named)
        return stamp

    def send_trajectory(self, names, points, starts_in=None):
        """As `send_goal`; points are JointPoints, starts_in: seconds from now."""
        stamp, known = self.user.stamp, self.machine.kinematics.joint_names
        tolerance = Tolerances.of(self.machine).goal
        starts_at = None if starts_in is None else self.now + starts_in
        goal = TrajectoryGoal(
            stamp, lambda: joint_points(names, points, known), tolerance, starts_at
        )
        self.links['trajectories'].send(stamp, goal)
        return stamp

    def send_path(self, poses, speed=0.02):
        """Poses (n,) of the platform; as `send_goal`."""
        stamp = self.user.stamp
        request = PathRequest(poses, speed, PATH_TOLERANCE)
        self.links['paths'].send(stamp, PathGoal(stamp, lambda: request, is_of_platform=True))
        return stamp

    def go_to(self, pose):
        """Waits until the goal is reached, or anything else came of it; the status then."""
        return self.end_of(self.send_goal(pose))

    def end_of(self, stamp):
        """Waits until a goal or path is over; the status then."""
        ends = ('reached', 'refused', 'stopped')
        self.wait(
            'end of the goal',
            lambda: self.status.goal_stamp == stamp and self.status.result in ends,
        )
        return self.status

    def jog(self, twist, seconds, source='cmd_vel', frame=''):
        """Holds a stick for so long, then sends the zero of its release."""
        end = self.now + seconds
        while self.now < end:
            wanted = np.array(twist, dtype=float)
            self.links['twists'].send(self.user.stamp, source, wanted, frame)
            self.run(TWIST_PERIOD)
        self.links['twists'].send(self.user.stamp, source, np.zeros(6))


class Fan:
    """Sends over several links at once."""

    def __init__(self, links):
        self._links = links

    def send(self, *value):
        for link in self._links:
            link.send(*value)
