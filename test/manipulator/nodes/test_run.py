"""A node's process: it ends when it is asked to, and no tick waits for garbage collections."""

import subprocess
import sys
import textwrap

import pytest

NODE = textwrap.dedent(
    """
    import ctypes
    import gc
    from rclpy.node import Node
    from manipulator.nodes.run import run_nodes

    class Clinging(Node):
        def __init__(self):
            super().__init__('clinging')
            print('up', flush=True)

        def close(self):
            print('frozen' if gc.get_freeze_count() > 10_000 else 'collected', flush=True)

        def destroy_node(self):
            ctypes.PyDLL(None).sleep(600)  # and no other thread gets a turn

    run_nodes([Clinging])
    """
)


@pytest.mark.processes
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


RAISING = textwrap.dedent(
    """
    import time
    from rclpy.node import Node
    from manipulator.nodes.run import context, spinning

    class Raising(Node):
        def __init__(self):
            super().__init__('raising')
            self.create_timer(0.01, self.fail)

        def fail(self):
            raise ValueError('a fault of ours')

        def close(self):
            print('closed', flush=True)

    with context([]), spinning([Raising]) as is_alive:
        while is_alive():
            time.sleep(0.01)
        print('ended', flush=True)
    """
)


def test_nodes_in_a_thread_report_when_an_error_has_ended_them(monkeypatch):
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'OFF')
    command = [sys.executable, '-c', RAISING]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0
    assert done.stdout == 'ended\nclosed\n'
    assert 'ValueError: a fault of ours' in done.stderr
