"""Stops a machine: along its way, or at once with --emergency.

    python3 examples/stop.py
    python3 examples/stop.py --emergency

The service `trajectory/stop` brakes along the path within the limits of acceleration and jerk,
then holds; the next goal moves on. `emergency_stop` (std_msgs/Bool) goes to the bridge and from
there to the board, past every planner: the servos hold where they are, and nothing moves them
until the service `serial_bridge/clear_fault` ends the stop. Publishing false does nothing. Neither
replaces a switch in the servos' supply.
"""

import argparse
import sys
import time

import rclpy
from std_msgs.msg import Bool
from std_srvs.srv import Trigger


def stop(node, namespace):
    """Calls the service and returns what it answers."""
    client = node.create_client(Trigger, f'{namespace}/trajectory/stop')
    if not client.wait_for_service(timeout_sec=10.0):
        sys.exit(f'nobody offers {client.srv_name}')
    future = client.call_async(Trigger.Request())
    rclpy.spin_until_future_complete(node, future, timeout_sec=5.0)
    answer = future.result()
    if answer is None or not answer.success:
        sys.exit(answer.message if answer else f'{client.srv_name} does not answer')
    return answer.message


def emergency_stop(node, namespace):
    """Publishes true once somebody hears it, and waits until it has arrived."""
    publisher = node.create_publisher(Bool, f'{namespace}/emergency_stop', 1)
    end = time.monotonic() + 10.0
    while not publisher.get_subscription_count():
        if time.monotonic() > end:
            sys.exit(f'nobody hears {publisher.topic_name}')
        rclpy.spin_once(node, timeout_sec=0.01)
    publisher.publish(Bool(data=True))
    publisher.wait_for_all_acked()
    return 'emergency stop sent'


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
    main()
