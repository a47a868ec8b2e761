"""The bridge to a driver of other software, as a node in this process."""

import time

import pytest

pytest.importorskip('rclpy')

import rclpy

from bridge.nodes.topic_bridge_node import TopicBridge
from bridge.stop_socket import send_stop, stop_address
from hexarm.machines import load
from manipulator.nodes.intra_process import IntraProcess
from manipulator.nodes.run import context, on_executor
from manipulator.states import MachineState

LONG = 30.0


def test_a_stop_by_datagram_stops_a_machine_without_a_board(monkeypatch):
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'OFF')
    arguments = ['--ros-args', '-r', '__ns:=/without_board']
    with (
        context(arguments),
        on_executor([lambda: TopicBridge(load, 'ur5', IntraProcess())]) as ((bridge,), executor),
    ):
        domain = rclpy.get_default_context().get_domain_id()
        assert send_stop(stop_address(bridge.get_fully_qualified_name(), domain))
        until = time.monotonic() + LONG
        while bridge._driver.status(0.0).state != MachineState.STOPPED:
            assert time.monotonic() < until
            executor.spin_once(timeout_sec=0.02)
