"""Stops a machine: along its path, or at once with --emergency.

    python3 examples/stop.py
    python3 examples/stop.py --emergency

The service `trajectory/stop` brakes along the path within the limits of acceleration and jerk,
then holds; the next goal is accepted. `emergency_stop` (std_msgs/Bool) goes to the bridge and from
there to the board, bypassing every planner: the servos hold where they are, and nothing moves them
until the service `serial_bridge/clear_fault` ends the stop. Publishing false does nothing.
`hexarm stop` and `hexarm clear` have the same effect. None of them replaces a switch in the
servos' supply.
"""

import argparse
import sys
import time

import rclpy
from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Bool
from std_srvs.srv import Trigger

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def stop(node, namespace):
    """Calls the service and returns its answer."""
    client = node.create_client(Trigger, f'{namespace}/trajectory/stop')
    if not client.wait_for_service(timeout_sec=10.0):
        sys.exit(f'{client.srv_name} is not available')
    future = client.call_async(Trigger.Request())
    rclpy.spin_until_future_complete(node, future, timeout_sec=5.0)
    answer = future.result()
    if answer is None or not answer.success:
        sys.exit(answer.message if answer else f'{client.srv_name} does not answer')
    return answer.message


def emergency_stop(node, namespace):
    """Publishes true until the bridge reports the machine as stopped, and returns the state.

    Publishing once, for the first subscriber, is not enough: that may be a recorder.
    """
    states = []
    topic = f'{namespace}/machine_state'
    node.create_subscription(DiagnosticStatus, topic, states.append, LATCHED)
    publisher = node.create_publisher(Bool, f'{namespace}/emergency_stop', 1)
    end = time.monotonic() + 10.0
    while not states or states[-1].message != 'stopped':
        if time.monotonic() > end:
            state = states[-1].message if states else 'unknown'
            sys.exit(f'not confirmed within 10 s: {state}')
        publisher.publish(Bool(data=True))
        rclpy.spin_once(node, timeout_sec=0.02)
    return states[-1].message


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    parser.add_argument('--emergency', action='store_true', help='at once, and latched')
    parser.add_argument('--namespace', default='/hexapod')
    arguments = parser.parse_args()

    rclpy.init()
    act = emergency_stop if arguments.emergency else stop
    print(act(rclpy.create_node('stop'), arguments.namespace))
    rclpy.shutdown()


if __name__ == '__main__':
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)
