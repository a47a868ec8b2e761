"""`Robot`: one machine of the graph, from a Python program (docs/client.md).

Metres, radians, seconds. Poses are those of the platform, or of the tool, in the base frame.
"""

import asyncio
from collections.abc import Callable, Iterable, Mapping

import numpy as np

from hexarm import saved_goals
from hexarm.machines import load
from hexarm.namespaces import NAMESPACE
from hexarm.robot_client import PATIENCE, Progress, RobotClient
from hexarm.robot_values import (
    FileName,
    Limits,
    PoseLike,
    check_progress,
    checked,
    checked_file,
    moved_to,
    numbers_by_name,
    pose_from,
    poses_from,
)
from manipulator.analysis.reach import Reach, reach
from manipulator.errors import InvalidInput
from manipulator.formatting import shown
from manipulator.machine import Machine
from manipulator.nodes.messages import BASE_FRAME, WORK_FRAME, pose_of
from manipulator.pose import Pose
from manipulator.saved_poses import SavedPose, SavedPoses, checked_name
from manipulator.states import MotionResult

JOG_FRAMES = (BASE_FRAME, WORK_FRAME, 'pivot', 'tool')
PLANNED_WITHIN = 60.0
"""Seconds that the planning of a path may take, by default."""


class Robot:
    """A machine that runs in `namespace` (`hexarm up`); a context manager.

    It belongs to one thread, and receives messages only while one of its methods or properties
    runs. Methods that move wait until the machine is there (`wait=False`: see `wait`). They raise
    Refused, Stopped or TimedOut with the reason. Whatever else ends a wait (Ctrl-C, a timeout)
    brakes the machine, which then holds; so does leaving the block while it moves.
    """

    def __init__(self, namespace: str = '/hexapod', *, machine: FileName | None = None) -> None:
        """`machine`: its file, where that has another name here than on its own computer.

        NoMachine names the machines that are there.
        """
        if not isinstance(namespace, str) or NAMESPACE.fullmatch(namespace) is None:
            raise InvalidInput(f'{shown(namespace)} is not a ROS name: letters, digits, _ and /')
        self.namespace = f'/{namespace.strip("/")}'
        self._file = None if machine is None else checked_file(machine)
        self._machine: Machine | None = None
        self._client = RobotClient(self.namespace, self._check)
        try:
            self._start()
            self._client.await_machine()
        except BaseException:
            self._leave()
            raise

    @staticmethod
    def simulated(machine: FileName = 'robocake', namespace: str | None = None) -> 'Robot':
        """A machine on the fake board, with a graph of its own, which ends with this Robot.

        Unless ROS_DOMAIN_ID is set, it has a ROS domain of its own, on this computer only.
        """
        from hexarm.simulated import SimulatedRobot  # noqa: PLC0415 (a subclass of this one)

        return SimulatedRobot(machine, namespace)

    def __enter__(self) -> 'Robot':
        """The robot itself."""
        return self

    def __exit__(self, *exception: object) -> None:
        """As `close`."""
        self.close()

    def close(self) -> None:
        """Leaves the graph; a motion under way is braked, the servos stay as they are."""
        try:
            if self._client.is_under_way:
                self._client.brake()
        finally:
            self._leave()

    # Servos

    def enable(self) -> None:
        """Servos on, one by one; returns when the machine takes goals."""
        self._client.enable()

    def disable(self) -> None:
        """Servos off: they hold nothing any more. `park` comes first, usually."""
        self._client.disable()

    def emergency_stop(self) -> None:
        """The board holds at once, until `clear`; to end a motion in the usual way: `stop`."""
        self._client.emergency_stop()

    def clear(self) -> None:
        """Ends an emergency stop or a fault, once somebody has looked; nothing moves."""
        self._client.trigger('serial_bridge/clear_fault')

    # Motion

    def move(
        self,
        *,
        x: float | None = None,
        y: float | None = None,
        z: float | None = None,
        roll: float | None = None,
        pitch: float | None = None,
        yaw: float | None = None,
        speed: float | None = None,
        wait: bool = True,
        timeout: float = PATIENCE,
        progress: Progress | None = None,
    ) -> None:
        """Moves to the named coordinates (m, rad); the others keep their commanded values."""
        coordinates = {'x': x, 'y': y, 'z': z, 'roll': roll, 'pitch': pitch, 'yaw': yaw}
        named = {name: value for name, value in coordinates.items() if value is not None}
        numbers = numbers_by_name(named, {}, 'coordinate')
        goal = moved_to(self.target, numbers)
        self.move_to(goal, speed=speed, wait=wait, timeout=timeout, progress=progress)

    def move_to(
        self,
        pose: PoseLike | str,
        *,
        speed: float | None = None,
        wait: bool = True,
        timeout: float = PATIENCE,
        progress: Progress | None = None,
    ) -> None:
        """Moves to a pose, or to a saved one by name; with a `speed` (m/s) on a line from rest.

        An arm takes a saved pose with the joints that it had: by a joint move, or on the line; it
        is Refused where the line leads to other ones.
        """
        check_progress(progress)
        goal = self._goal(pose)
        most = None if speed is None else checked('speed', speed, above=0.0)
        self._move(lambda: self._begin_move(goal, most, progress), wait, timeout)

    def move_tool_to(
        self, pose: PoseLike, *, wait: bool = True, timeout: float = PATIENCE
    ) -> None:
        """Moves the tool in force, or the pivot, to a pose in the work frame."""
        goal = pose_from(pose)
        self._begin(lambda: self._client.send_goal(goal, WORK_FRAME), wait, timeout)

    def move_joints(
        self,
        joints: Mapping[str, float] | None = None,
        /,
        *,
        wait: bool = True,
        timeout: float = PATIENCE,
        **named: float,
    ) -> None:
        """Moves joints by name (rad, m), from rest in proportion; the others stay as commanded."""
        goal = numbers_by_name(joints, named, 'joint')
        self._begin(lambda: self._client.send_joints(goal), wait, timeout)

    def follow(
        self,
        poses: Pose | Iterable[PoseLike],
        *,
        speed: float | None = None,
        wait: bool = True,
        timeout: float = PLANNED_WITHIN,
        progress: Progress | None = None,
    ) -> None:
        """Moves to the first pose, then exactly through the others, at `speed` (m/s) at most."""
        check_progress(progress)
        path = poses_from(poses)
        most = None if speed is None else checked('speed', speed, above=0.0)
        self._move(lambda: self._client.begin_path(path, most, progress), wait, timeout)

    def home(self, *, wait: bool = True, timeout: float = PATIENCE) -> None:
        """Moves to the home pose, along a line where one leads there, else by its joints."""
        self._begin(lambda: self._client.send_to('home'), wait, timeout)

    def park(self, *, wait: bool = True, timeout: float = PATIENCE) -> None:
        """As `home`, to the joints at which the servos are switched on and off."""
        self._begin(lambda: self._client.send_to('park'), wait, timeout)

    def jog(
        self,
        *,
        vx: float = 0.0,
        vy: float = 0.0,
        vz: float = 0.0,
        wx: float = 0.0,
        wy: float = 0.0,
        wz: float = 0.0,
        seconds: float = 1.0,
        frame: str = BASE_FRAME,
    ) -> None:
        """Moves at a velocity (m/s, rad/s; axes of `frame`: base, tool, work) for some seconds.

        The machine slows down before a limit, and brakes at the end.
        """
        named = {'vx': vx, 'vy': vy, 'vz': vz, 'wx': wx, 'wy': wy, 'wz': wz}
        twist = [checked(name, value) for name, value in named.items()]
        if not any(twist):
            raise InvalidInput('no velocity is given: vx, vy, vz (m/s), wx, wy, wz (rad/s)')
        if frame not in JOG_FRAMES:
            raise InvalidInput(f'frame {shown(frame)}: needs one of {", ".join(JOG_FRAMES)}')
        duration = checked('seconds', seconds, above=0.0)
        self.wait()
        self._client.jog(twist, frame, duration)

    def jog_joints(
        self,
        rates: Mapping[str, float] | None = None,
        /,
        *,
        seconds: float = 1.0,
        **named: float,
    ) -> None:
        """Turns joints by name at rates (rad/s, m/s) for some seconds; as `jog`."""
        request = numbers_by_name(rates, named, 'joint')
        duration = checked('seconds', seconds, above=0.0)
        self.wait()
        self._client.jog_joints(request, duration)

    def stop(self) -> None:
        """Brakes along the path and returns when the machine holds; then it may move again."""
        self._client.rest()

    # Tools

    def use_tool(self, name: str) -> None:
        """Puts a tool of the machine file in force, '' none; returns when it is (docs/tools.md).

        InvalidInput names the tools that there are. A motion under way is waited for.
        """
        self._model().frames.with_tool(name)
        self.wait()
        self._client.use_tool(name)

    @property
    def tool(self) -> str:
        """The name of the tool in force, '' for none; as reported once a second."""
        return self._client.tool()

    @property
    def tool_pose(self) -> Pose:
        """The measured pose of the tool in force, or of the pivot, in the work frame."""
        return pose_of(self._client.fresh_pivot(), (WORK_FRAME,))

    # Saved poses

    def save_pose(self, name: str = '') -> str:
        """Saves the measured pose beside the machine file; returns its name, new for ''.

        A pose that has this name already is replaced; InvalidInput, Refused with the reason.
        """
        return self._client.change_saved_pose(
            'save_pose', '' if name == '' else checked_name(name)
        )

    def delete_pose(self, name: str) -> None:
        """Deletes a saved pose; Refused where there is none, or a sequence needs it."""
        self._client.change_saved_pose('delete_pose', checked_name(name))

    @property
    def saved_poses(self) -> SavedPoses:
        """The saved poses and sequences by name."""
        return SavedPoses.none_of(self._model()).read(self._client.saved_poses())

    def replay(
        self,
        *names: str,
        speed: float | None = None,
        pause: float | None = None,
        repeat: int = 1,
        progress: Progress | None = None,
    ) -> None:
        """Moves to saved poses, and through saved sequences, one after the other.

        `speed` (m/s) and `pause` (s) replace those of the sequences; `repeat`: how many times.
        Raises as `move_to`; Ctrl-C brakes the machine.
        """
        if not names:
            raise InvalidInput('replay what? Names of saved poses and sequences')
        check_progress(progress)
        saved = self.saved_poses
        steps = saved.steps(names)
        most = None if speed is None else checked('speed', speed, above=0.0)
        rest = None if pause is None else checked('pause', pause, least=0.0)
        total = len(steps) * int(checked('repeat', repeat, least=1.0))
        for done in range(total):
            step = steps[done % len(steps)]
            self._begin_move(saved.of(step.pose), most or step.speed)
            self.wait()
            self._client.spin(step.pause_s if rest is None else rest)
            if progress is not None:
                progress((done + 1) / total)

    # Waiting

    def wait(self, timeout: float = PATIENCE) -> None:
        """Waits for the end of the last motion; Refused or Stopped with the reason.

        However long it takes: TimedOut after `timeout` seconds in which nothing moves.
        """
        self._client.finish(checked('timeout', timeout, above=0.0))

    def is_done(self) -> bool:
        """Whether the last motion has ended, for programs with a loop of their own.

        Takes some ten milliseconds; raises as `wait`.
        """
        self._client.poll()
        return not self._client.is_under_way

    async def done(self) -> None:
        """As `wait`, for asyncio, without a timeout; cancelling it brakes the machine."""
        try:
            while not self.is_done():
                await asyncio.sleep(0.01)
        except asyncio.CancelledError:
            self._client.brake()
            raise

    # Measurements

    @property
    def pose(self) -> Pose:
        """The measured pose, received after this call."""
        return pose_of(self._client.fresh('pose'))

    @property
    def target(self) -> Pose:
        """The commanded pose: the end of this program's motion under way, else the setpoint."""
        return self._client.destination()

    @property
    def joints(self) -> dict[str, float]:
        """The measured joints by name (rad, m); of hobby servos what the board puts out."""
        message = self._client.fresh('joint_states')
        return dict(zip(message.name, message.position, strict=True))

    @property
    def state(self) -> str:
        """The machine state: disarmed, arming, enabled, holding, stopped, fault, …"""
        self._client.receive()
        return str(self._client.machine_state.message)

    @property
    def is_moving(self) -> bool:
        """Whether it moves or plans to, for this program or for another."""
        self._client.receive()
        is_planning = self._client.motion('result') == MotionResult.PLANNING
        return is_planning or not self._client.is_at_rest()

    @property
    def limits(self) -> Limits:
        """Joint ranges and speeds, from the machine file."""
        return Limits.of(self._model())

    def reach(self, pose: PoseLike | str) -> Reach:
        """Whether a pose can be reached, the reason if not, and how near each limit is."""
        return reach(self._model(), self._goal(pose).pose)

    def _goal(self, pose: PoseLike | str) -> SavedPose:
        return self.saved_poses.of(pose) if isinstance(pose, str) else SavedPose(pose_from(pose))

    def _begin_move(
        self, saved: SavedPose, speed: float | None, progress: Progress | None = None
    ) -> None:
        goal, client = saved.pose, self._client
        joints = None if saved.joints is None else saved_goals.joints_of(self._model(), saved)
        if speed is not None:
            client.rest()
            start = client.commanded()
            if joints is not None:
                near = np.array([self.joints[name] for name in joints])
                saved_goals.check_line(self._model(), start, near, saved)
            client.begin_path(poses_from([start, goal]), speed, progress)
        elif joints is not None:
            client.begin(lambda: client.send_joints(joints), goal, progress)
        else:
            client.begin(lambda: client.send_goal(goal), goal, progress)

    def _begin(self, send: Callable[[], object], wait: bool, timeout: float) -> None:
        self._move(lambda: self._client.begin(send), wait, timeout)

    def _move(self, begin: Callable[[], object], wait: bool, timeout: float) -> None:
        """Begins a motion, once all that was asked for is checked, and waits for its end."""
        patience = checked('timeout', timeout, above=0.0)
        begin()
        if wait:
            self._client.finish(patience)

    def _model(self) -> Machine:
        if self._machine is None:
            file = self._file or self._client.report_of('trajectory').hardware_id
            self._machine = load(file)
        return self._machine

    def _start(self) -> None:
        """Before the machine is waited for."""

    def _check(self) -> None:
        """At every wait; may raise to end it."""

    def _leave(self) -> None:
        self._client.__exit__()
