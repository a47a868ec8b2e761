"""A joystick has the arm while it is held: over goals, within limits, and not beyond a stop."""

import subprocess
import sys
import textwrap
import time

import numpy as np
import pytest

from hexarm.machines import load
from manipulator.errors import Refused

pytestmark = [pytest.mark.graph, pytest.mark.real_time]

KINEMATICS = load('arm_6r_stepper').kinematics
HOME = KINEMATICS.home
PERIOD = 0.02


def test_release_stops_within_a_third_of_a_second(arm, joystick, listen):
    commands = listen('joint_command')
    joystick.hold([0.2, 0, 0, 0, 0, 0], 1.0)
    assert arm.motion('mode') == 'jog'
    joystick.send()
    released = time.time()
    arm.spin(1.0)
    moving = np.abs(np.diff(commands.joints, axis=0)).max(axis=1) > 0
    assert commands.stamps[1:][moving][-1] - released < 0.35
    assert (arm.motion('mode'), arm.motion('result')) == ('hold', 'idle')
    commands.check_smooth()


def test_joystick_overrides_a_goal_in_motion_smoothly_and_the_goal_does_not_resume(
    arm, joystick, listen
):
    commands = listen('joint_command')
    stamp = arm.publish_goal(HOME.moved([0.25, 0, 0, 0, 0, 0]))
    arm.wait('moving', lambda: arm.motion('mode') == 'move', 5.0)
    arm.spin(0.5)
    statuses = []
    end = time.monotonic() + 1.0
    while time.monotonic() < end:
        joystick.send([0, 0, 0.1, 0, 0, 0])
        arm.spin(PERIOD)
        statuses.append((arm.motion('goal_stamp'), arm.motion('result'), arm.motion('mode')))
    assert (f'{stamp:.9f}', 'moving', 'move') in statuses
    assert statuses[-1][1:] == ('moving', 'jog')
    with pytest.raises(Refused, match='cmd_vel/joy has the machine'):
        joystick.send([0, 0, 0.1, 0, 0, 0])
        arm.go_to(HOME)
    joystick.send()
    arm.spin(1.0)
    rest = commands.joints[-1]
    arm.spin(0.5)
    assert commands.joints[-1] == pytest.approx(rest, abs=1e-9)
    assert arm.motion('mode') == 'hold'
    assert KINEMATICS.forward(rest).pose.position[2] > HOME.position[2] + 0.03
    commands.check_smooth()


def test_killed_source_stops_the_arm(arm):
    script = textwrap.dedent(
        """
        import time, rclpy
        from geometry_msgs.msg import TwistStamped
        rclpy.init()
        node = rclpy.create_node('doomed')
        publisher = node.create_publisher(TwistStamped, '/arm/cmd_vel/panel', 1)
        message = TwistStamped()
        message.twist.linear.x = 0.1
        while True:
            message.header.stamp = node.get_clock().now().to_msg()
            publisher.publish(message)
            time.sleep(0.02)
        """
    )
    source = subprocess.Popen([sys.executable, '-c', script])
    try:
        arm.wait('jogging', lambda: arm.motion('mode') == 'jog', 20.0)
        arm.spin(0.3)
    finally:
        source.kill()
        source.wait()
    arm.wait('standing still', lambda: arm.motion('mode') == 'hold', 2.0)


def test_bad_twists_modes_and_frames_are_refused_and_the_arm_stays(arm, joystick, listen):
    heard = listen()
    joystick.mode('upside_down')
    for twist, frame in (([np.nan, 0, 0, 0, 0, 0], ''), ([0.1, 0, 0, 0, 0, 0], 'moon')):
        for _ in range(10):
            joystick.send(twist, frame)
            arm.spin(PERIOD)
    arm.spin(1.0)
    assert np.ptp(heard.joints, axis=0).max() < 1e-3
    told = {v.key: v.value for v in arm.diagnostics['arm/trajectory'].values}
    assert told['jog_mode'] == 'free'
    assert int(told['twists_refused']) >= 10
    assert "'moon' is not one of" in told['last_twist_refusal']


def test_twist_above_the_limits_is_scaled_and_said(arm, joystick):
    joystick.hold([0, 0, 2.0, 0, 0, 0], 0.3)
    assert 'scaled to' in arm.motion('reason')
    assert 'speed limits' in arm.motion('reason')


def test_stop_ends_a_jog_until_the_stick_is_let_go(arm, joystick):
    joystick.hold([0, 0, 0.05, 0, 0, 0], 0.3)
    arm.trigger('trajectory/stop')
    joystick.hold([0, 0, 0.05, 0, 0, 0], 0.6)
    assert (arm.motion('mode'), arm.motion('result')) == ('hold', 'stopped')
    arm.spin(0.5)
    joystick.hold([0, 0, -0.05, 0, 0, 0], 0.3)
    assert arm.motion('mode') == 'jog'
