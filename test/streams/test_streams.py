"""Whatever people ask for, no frame is beyond a limit and nothing that is published is refused."""

import contextlib
import itertools

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, example, given, settings
from hypothesis import strategies as st

from arm_control.arm import SerialArm
from bridge.protocol import Clear, Disarm, Stop
from manipulator.errors import ManipulatorError
from manipulator.planning.cycle import Cycle
from manipulator.planning.goal import Goal
from manipulator.planning.path import Tolerance
from manipulator.planning.path_timing import PathRequest, plan_path
from manipulator.pose import Pose
from manipulator.teleop.arbiter import SOURCES
from manipulator.teleop.modes import MODES
from sampling import enough

DT = 0.01
SLACK = 1.01
"""What check_plan allows (1.005), and rounding."""

SLACK_OF_CHANGES = 1.05
"""A move that ends within a tick leaves a rest of its braking to the next, which may be a jog."""

REGULAR = 0.2
"""The σmin (2.5 times the onset of damping) above which a jogged arm keeps the tool's limits."""

NUMBER = st.floats(-1.0, 1.0)
SIX = st.tuples(*[NUMBER] * 6)
RATE = st.sampled_from([0.0, 0.13, 0.5, 0.77, 1.0])
WISHES = st.one_of(
    st.tuples(st.just('goal'), SIX, st.sampled_from([0.2, 0.5, 1.0])),
    st.tuples(st.just('goals'), st.lists(SIX, min_size=2, max_size=8)),
    st.tuples(st.just('path'), st.lists(SIX, min_size=2, max_size=5), st.sampled_from([0.1, 0.3])),
    st.tuples(st.just('twist'), st.sampled_from(SOURCES), SIX, st.integers(1, 60)),
    st.tuples(st.just('mode'), st.sampled_from(sorted(MODES))),
    st.tuples(st.just('cycle'), SIX, st.sampled_from([0.1, 0.5, 2.0])),
    st.tuples(st.just('pause'), st.booleans()),
    st.tuples(st.just('override'), RATE),
    st.tuples(st.just('pivot'), st.tuples(NUMBER, NUMBER, NUMBER)),
    st.tuples(st.just('stop')),
    st.tuples(st.just('emergency_stop')),
    st.tuples(st.just('disable')),
    st.tuples(st.just('enable')),
)
STREAMS = st.lists(st.tuples(WISHES, st.sampled_from([1, 2, 5, 17, 60])), max_size=10)


class User:
    """Does to a loop what a stream of commands says; refusals are answers like any other."""

    def __init__(self, loop):
        self.loop = loop
        self.machine = loop.machine

    def ask(self, command, ticks):
        with contextlib.suppress(ManipulatorError):
            getattr(self, command[0])(*command[1:])
        self.loop.run(ticks)

    def near_home(self, six, part=1.0):
        """Up to far beyond the reach where `part` is 1."""
        home, length = self.machine.kinematics.home, self.machine.kinematics.characteristic_length
        turned = home.moved(part * np.array(six) * ([0.5 * length] * 3 + [0.8] * 3))
        return self.loop.supervisor.machine.frames.pivot(turned)

    def goal(self, six, part=1.0):
        self.loop.supervisor.executor.pursue(Goal(self.near_home(six, part), self.loop.now))

    def goals(self, sixes):
        for six in sixes:
            self.goal(six, 0.3)
            self.loop.run(3)

    def path(self, sixes, part):
        executor, machine = self.loop.supervisor.executor, self.loop.supervisor.machine
        found = [self.near_home(six, part) for six in sixes]
        poses = Pose(np.array([p.position for p in found]), np.array([p.rotation for p in found]))
        timed = plan_path(machine, PathRequest(poses, 10.0, Tolerance()), executor.joints, DT)
        executor.pursue(Goal(found[0], self.loop.now, timed))

    def twist(self, source, six, ticks):
        motion = self.machine.motion
        twist = 2 * np.array(six) * ([motion.linear.speed] * 3 + [motion.angular.speed] * 3)
        for _ in range(ticks):
            self.loop.teleop.receive(source, twist, '', self.loop.now)
            self.loop.run(1)

    def mode(self, name):
        self.loop.teleop.set_mode(name)
        ahead = np.array([0.0, 0.0, 0.5])
        self.loop.teleop.look_at(self.machine.kinematics.home.position + ahead)

    def cycle(self, six, frequency):
        length = self.machine.kinematics.characteristic_length
        amplitude = 0.2 * np.array(six) * ([length] * 3 + [1.0] * 3)
        executor = self.loop.supervisor.executor
        pose = executor.state.pose
        executor.start_cycle(Cycle(pose, amplitude, np.full(6, frequency), np.arange(6.0)))

    def pause(self, is_paused):
        self.loop.supervisor.executor.pause(is_paused)

    def override(self, rate):
        self.loop.supervisor.override(rate)

    def pivot(self, point):
        self.loop.supervisor.set_pivot(0.05 * np.array(point))

    def stop(self):
        self.loop.supervisor.executor.stop()
        self.loop.teleop.stop()

    def emergency_stop(self):
        self.loop.ask(Stop())
        self.loop.run(20)
        self.loop.ask(Clear())

    def disable(self):
        self.loop.ask(Disarm())

    def enable(self):
        self.loop.arm()


def runs(sent):
    """Setpoints that follow one another without a pause, in the same frames."""
    found = [[sent[0]]]
    for before, after in itertools.pairwise(sent):
        if after.tick != before.tick + 1 or after.is_first or after.frames is not before.frames:
            found.append([])
        found[-1].append(after)
    return found


def check(loop):
    """By definition: differences of what was sent, against the machine file's limits."""
    assert not loop.refusals, loop.refusals[:3]
    ranges = np.array(loop.board.settings.count_ranges)
    speeds = np.array(loop.board.settings.count_speeds)
    for run in runs(loop.sent):
        counts = np.array([s.counts for s in run])
        assert (counts >= ranges[:, 0]).all() and (counts <= ranges[:, 1]).all()
        nearest = 1.0 if run[0].is_first else 2 * DT * speeds + 1.0
        assert (np.abs(counts[0] - run[0].pulses) <= nearest).all(), 'a jump'
        assert (np.abs(np.diff(counts, axis=0)) <= speeds * DT + 1.0).all()
        check_derivatives(loop.machine, run)


def check_derivatives(machine, run):
    motion = machine.motion
    joints = np.array([s.joints for s in run])
    rates = np.diff(joints, axis=0) / DT
    changes = np.abs(np.diff(rates, axis=0)) / DT
    assert (np.abs(rates) <= SLACK * motion.joint.speed).all()
    assert (changes <= SLACK_OF_CHANGES * motion.joint.acceleration).all()
    for part, limit in ((slice(0, 3), motion.linear), (slice(3, 6), motion.angular)):
        twists = twists_of(run)[:, part]
        assert norms(twists).max(initial=0.0) <= SLACK * limit.speed
        changes = norms(np.diff(twists, axis=0) / DT)
        if isinstance(machine.kinematics, SerialArm):
            changes = np.where(is_singular_jog(machine, run), 0.0, changes)
        assert changes.max(initial=0.0) <= SLACK_OF_CHANGES * limit.acceleration


def is_singular_jog(machine, run):
    """Whether each change of twist belongs to a jog near a singular posture.

    There the motion is scaled down or damped, and that as quickly as the joints may.
    """
    joints = np.array([s.joints for s in run])[1:-1]
    is_jogged = np.array([s.mode == 'jog' for s in run])
    near_jog = is_jogged[:-2] | is_jogged[1:-1] | is_jogged[2:]
    return near_jog & (machine.kinematics.sigma_min(run[0].pivot, joints) <= REGULAR)


def twists_of(run):
    steps = [a.pivot.twist_to(b.pivot) for a, b in itertools.pairwise(run)]
    return np.reshape(steps, (-1, 6)) / DT


def norms(vectors):
    return np.linalg.norm(vectors, axis=1)


@pytest.mark.parametrize('name', ['robocake', 'stewart_6_6', 'puma560'])
@settings(
    max_examples=enough(5, 40),
    deadline=None,
    phases=[Phase.explicit, Phase.generate],
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
@example(
    stream=[  # brakes from the edge where a leg can no longer close, its crank at full speed
        (('override', 0.5), 1),
        (('twist', 'cmd_vel', (-0.5, -0.5, 1.0, -0.1, 0.7, 0.0), 60), 60),
    ]
)
@example(
    stream=[  # a wrist joint that brakes as hard as it may while the jog mode changes
        (('emergency_stop',), 60),
        (('twist', 'cmd_vel/keyboard', (0.51, 0.19, -1.0, 0.0, 0.55, -0.46), 52), 17),
        (('mode', 'turn_tool_z'), 17),
        (('emergency_stop',), 17),
    ]
)
@example(
    stream=[  # a board that was stopped where a crank is at the very end of its range
        (('emergency_stop',), 60),
        (('twist', 'cmd_vel/keyboard', (0.5, 0.2, -1.0, 0.0, 0.55, -0.46), 52), 17),
        (('mode', 'turn_tool_z'), 17),
        (('emergency_stop',), 17),
    ]
)
@example(stream=[(('goal', (0.1,) * 6, 1.0), 9), (('enable',), 9)])
@given(stream=STREAMS)
def test_no_stream_of_wishes_breaks_a_limit(loop_of, name, stream):
    loop = loop_of(name)
    user = User(loop)
    for wish, ticks in stream:
        user.ask(wish, ticks)
    loop.run(30)
    check(loop)
