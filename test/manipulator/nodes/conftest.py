"""Nodes of one process, on a ROS domain of their own."""

import os
import time
from contextlib import contextmanager

import pytest
import rclpy
from rclpy.experimental import EventsExecutor
from rclpy.node import Node

PATIENCE = 60.0


class Graph:
    """Nodes in the namespace /here, as apart as processes are; spun while somebody waits."""

    def __init__(self, executor_class):
        self._executor_class = executor_class
        self._executors, self._nodes = [], []

    def node(self, name, namespace='here'):
        context = rclpy.Context()
        rclpy.init(context=context, domain_id=1 + os.getpid() % 100)
        node = Node(name, namespace=namespace, context=context)
        executor = self._executor_class(context=context)
        executor.add_node(node)
        self._executors.append(executor)
        self._nodes.append(node)
        return node

    def wait(self, what, is_so):
        end = time.monotonic() + PATIENCE
        while not is_so():
            assert time.monotonic() < end, what
            for executor in self._executors:
                executor.spin_once(timeout_sec=0.002)

    def close(self):
        for executor, node in zip(self._executors, self._nodes, strict=True):
            executor.shutdown()
            node.destroy_node()
            node.context.try_shutdown()


@pytest.fixture
def graph_of():
    """Makes a Graph whose nodes executors of the given class spin."""

    @contextmanager
    def make(executor_class=EventsExecutor):
        graph = Graph(executor_class)
        try:
            yield graph
        finally:
            graph.close()

    return make


@pytest.fixture
def graph(graph_of):
    with graph_of() as made:
        yield made
