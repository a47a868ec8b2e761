"""Services that answer from a tick, under both of rclpy's executors."""

import time

import pytest

pytest.importorskip('rclpy')

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from std_srvs.srv import Trigger

from manipulator.nodes.late_answers import MOST_WAITING, create_late_service

PATIENCE = 60.0


@pytest.fixture(params=[EventsExecutor, SingleThreadedExecutor])
def spun(request):
    """A server and a client on one executor, and what spins them until something is so."""
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=77)
    server, client = (Node(name, context=context) for name in ('server', 'client'))
    executor = request.param(context=context)
    executor.add_node(server)
    executor.add_node(client)

    def until(is_so):
        end = time.monotonic() + PATIENCE
        while not is_so():
            assert time.monotonic() < end
            executor.spin_once(timeout_sec=0.05)

    yield server, client, until
    executor.shutdown()
    for node in (server, client):
        node.destroy_node()
    rclpy.shutdown(context=context)


def test_an_answer_goes_out_when_it_is_sent_and_to_whom_it_belongs(spun):
    server, client, until = spun
    begun = []
    create_late_service(server, Trigger, 'slow', begun.append)
    caller = client.create_client(Trigger, 'slow')
    until(caller.service_is_ready)
    futures = [caller.call_async(Trigger.Request()) for _ in range(3)]
    until(lambda: len(begun) == 3)
    assert not any(future.done() for future in futures)
    for k, call in reversed(list(enumerate(begun))):
        call.response.message = str(k)
        call.send()
    until(lambda: all(future.done() for future in futures))
    assert [future.result().message for future in futures] == ['0', '1', '2']


def test_more_calls_than_may_wait_are_answered_at_once(spun):
    server, client, until = spun
    begun = []
    waiting = create_late_service(server, Trigger, 'slow', begun.append)
    caller = client.create_client(Trigger, 'slow')
    until(caller.service_is_ready)
    futures = [caller.call_async(Trigger.Request()) for _ in range(MOST_WAITING + 2)]
    until(lambda: sum(future.done() for future in futures) == 2)
    assert len(begun) == len(waiting) == MOST_WAITING
    assert not futures[-1].result().success
    for call in begun:
        call.send()
    until(lambda: all(future.done() for future in futures))
    assert not waiting
