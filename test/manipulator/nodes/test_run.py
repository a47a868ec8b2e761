"""A node's process: it ends when it is asked to, and no tick waits for garbage collections."""

import subprocess
import sys
import textwrap

NODE = textwrap.dedent(
    """
    import ctypes
    import gc
    from rclpy.node import Node
    from manipulator.nodes.run import run_node

    class Clinging(Node):
        def __init__(self):
            super().__init__('clinging')
            print('up', flush=True)

        def close(self):
            print('frozen' if gc.get_freeze_count() > 10_000 else 'collected', flush=True)

        def destroy_node(self):
            ctypes.PyDLL(None).sleep(600)  # and no other thread gets a turn

    run_node(Clinging)
    """
)


def test_a_node_is_not_collected_and_ends_though_it_cannot_leave_the_graph(monkeypatch):
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'OFF')
    process = subprocess.Popen([sys.executable, '-c', NODE], stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout.readline() == 'up\n'
        process.terminate()
        said, _ = process.communicate(timeout=60.0)
        assert (said, process.returncode) == ('frozen\n', 1)
    finally:
        process.kill()
        process.wait()
