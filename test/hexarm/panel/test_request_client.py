"""How the panel speaks to the graph, and of the graph to the page."""

from types import SimpleNamespace

import pytest

from hexarm.panel.nodes.request_client import SERVICES, RequestClient
from hexarm.panel.page_requests import Request


class Node:
    """Stands for a node: remembers what is published how, and which services are asked."""

    def __init__(self, is_ready=True):
        self.depths, self.published, self.asked, self.is_ready = {}, {}, [], is_ready
        self.heard = {}

    def create_publisher(self, _, topic, qos):
        self.depths[topic] = qos.depth
        return SimpleNamespace(publish=lambda message: self.published.update({topic: message}))

    def create_client(self, _, name):
        return Service(self, name)

    def create_subscription(self, _, topic, callback, qos):
        self.heard[topic] = callback


class Service:
    """Stands for a client of a service, which is also its only future."""

    def __init__(self, node, name):
        self.node, self.name = node, name

    def service_is_ready(self):
        return self.node.is_ready

    def call_async(self, request):
        self.node.asked.append((self.name, getattr(request, 'data', None)))
        return self

    def add_done_callback(self, callback):
        self.answer = callback

    def result(self):
        return SimpleNamespace(success=False, message='because')


def requested(node, *requests):
    client = RequestClient(node, bool)
    for request in requests:
        client.take(request)
    client.new()
    return client


def test_many_stops_in_a_row_all_arrive():
    node = Node()
    RequestClient(node, bool)
    assert node.depths['emergency_stop'] == 100


@pytest.mark.parametrize('do', SERVICES)
def test_a_refusal_and_silence_are_told_by_the_name_of_the_button(do):
    button, name, is_on = SERVICES[do]
    node = Node()
    client = requested(node, Request(do))
    assert node.asked == [(name, is_on)]
    client._clients[name].answer(client._clients[name])
    assert client.notice == f'{button}: because'
    silent = requested(Node(is_ready=False), Request(do))
    assert silent.notice == f'{button}: nothing answers, does hexarm up run?'


def test_a_tool_is_sent_by_its_name():
    node = Node()
    requested(node, Request('tool', name='probe'))
    assert node.published['tool'].data == 'probe'


def test_the_outcome_of_a_saved_pose_is_shown_and_none_where_there_is_none_yet():
    node = Node()
    client = RequestClient(node, bool)
    for outcome in ('up: saved', ''):
        node.heard['saved_pose_status'](SimpleNamespace(data=outcome))
        assert client.notice == 'saved poses: up: saved'
