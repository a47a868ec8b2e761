"""A bare rclpy chain of the graph's length: source → relay → sink, each a process of its own.

`python -m bench.relay_chain source|relay|sink`: the sink prints the one-way times that it saw.
"""

import json
import sys
import time

import rclpy
from geometry_msgs.msg import PoseStamped
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.signals import SignalHandlerOptions

RATE = 100.0
MESSAGES = 500
QOS = QoSProfile(depth=1)


def source(node):
    publisher = node.create_publisher(PoseStamped, 'chain_in', QOS)

    def publish():
        message = PoseStamped()
        message.header.stamp = node.get_clock().now().to_msg()
        publisher.publish(message)

    node.create_timer(1.0 / RATE, publish)
    return lambda: False


def relay(node):
    publisher = node.create_publisher(PoseStamped, 'chain_out', QOS)
    node.create_subscription(PoseStamped, 'chain_in', publisher.publish, QOS)
    return lambda: False


def sink(node):
    seconds = []

    def hear(message):
        stamp = message.header.stamp
        seconds.append(time.time() - stamp.sec - stamp.nanosec * 1e-9)

    node.create_subscription(PoseStamped, 'chain_out', hear, QOS)

    def is_done():
        if len(seconds) < MESSAGES:
            return False
        print(json.dumps(seconds))
        return True

    return is_done


def main(role):
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = Node(f'chain_{role}')
    is_done = {'source': source, 'relay': relay, 'sink': sink}[role](node)
    executor = EventsExecutor()
    executor.add_node(node)
    while not is_done():
        executor.spin_once(timeout_sec=0.1)


if __name__ == '__main__':
    main(sys.argv[1])
