"""A node's process ends when it is asked to, whatever keeps its node from leaving the graph."""

import subprocess
import sys
import textwrap

NODE = textwrap.dedent(
    """
    import threading
    from rclpy.node import Node
    from manipulator.nodes.run import run_nodes

    class Clinging(Node):
        def __init__(self):
            super().__init__('clinging')
            print('up', flush=True)

        def close(self):
            print('closed', flush=True)

        def destroy_node(self):
            threading.Event().wait()

    run_nodes([Clinging])
    """
)


def test_a_node_that_cannot_leave_the_graph_ends_all_the_same(monkeypatch):
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'OFF')
    process = subprocess.Popen([sys.executable, '-c', NODE], stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout.readline() == 'up\n'
        process.terminate()
        assert process.stdout.read() == 'closed\n'
        assert process.wait(30.0) == 0
    finally:
        process.kill()
        process.wait()
