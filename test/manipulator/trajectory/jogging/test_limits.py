"""Jogging keeps the limits over random streams of twists and of everything else."""

import contextlib

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from manipulator.errors import Refused, Unreachable
from manipulator.planning.cycle import Cycle
from manipulator.planning.goal import Goal
from manipulator.teleop.jog_modes import Feedback
from manipulator.teleop.modes import jog_mode
from sampling import enough

DT = 0.01
MODES = ('free', 'hold_orientation', 'turn_base_z', 'turn_tool_x', 'parallel', 'look_at')

directions = st.tuples(*([st.floats(-1.0, 1.0)] * 6))
commands = st.one_of(
    st.tuples(
        st.just('jog'),
        directions,
        st.sampled_from(MODES),
        st.sampled_from(['', 'tool', 'work']),
    ),
    st.tuples(st.just('release')),
    st.tuples(st.just('goal'), directions),
    st.tuples(st.just('stop')),
    st.tuples(st.just('pause'), st.booleans()),
    st.tuples(st.just('override'), st.floats(0.0, 1.0)),
    st.tuples(st.just('cycle')),
)
streams = st.lists(st.tuples(commands, st.integers(1, 40)), min_size=1, max_size=8)


def obey(motion, command, stamp):
    """Gives one command; returns what the joystick wants from now on: twist, mode, frame."""
    reach = 0.3 * motion.machine.kinematics.characteristic_length
    home = motion.machine.kinematics.home
    match command:
        case ('jog', part, name, frame):
            point = home.moved([0, 0, 4 * reach, 0, 0, 0]).position
            mode = jog_mode(name, Feedback.for_delay(0.0), point)
            return 1.5 * motion.full_speed * part, mode, frame
        case ('goal', shift):
            with contextlib.suppress(Refused):
                scale = np.repeat([reach, 0.3], 3)
                motion.pursue(Goal(home.moved(scale * shift), stamp))
        case ('stop',):
            motion.stop()
        case ('pause', is_paused):
            motion.pause(is_paused)
        case ('override', rate):
            motion.override(rate)
        case ('cycle',):
            amplitude = np.repeat([0.1 * reach, 0.03], 3)
            with contextlib.suppress(Refused, Unreachable):
                motion.start_cycle(Cycle(motion.state.pose, amplitude, [0.5] * 6, [0.5] * 6))
    return ()


@settings(max_examples=enough(4, 20), deadline=None)
@given(stream=streams)
def test_no_stream_of_commands_and_twists_leaves_the_limits(machine, at_home, stream):
    motion = at_home(machine)
    for k, (command, ticks) in enumerate(stream):
        motion.run(ticks, *obey(motion, command, float(k)))
    motion.check_limits()


def test_platform_keeps_its_accelerations_while_jogged(platform, at_home):
    motion, rng = at_home(platform), np.random.default_rng(5)
    for _ in range(enough(8, 40)):
        motion.run(25, motion.full_speed * rng.uniform(-1, 1, 6))
    changes = np.diff(motion.twists, axis=0) / DT
    linear, angular = platform.motion.linear, platform.motion.angular
    assert np.linalg.norm(changes[:, :3], axis=1).max() <= 1.001 * linear.acceleration
    assert np.linalg.norm(changes[:, 3:], axis=1).max() <= 1.001 * angular.acceleration
    assert np.linalg.norm(changes[:, :3], axis=1).max() > 0.1 * linear.acceleration
