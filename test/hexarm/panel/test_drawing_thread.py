"""The node draws in its own thread, the web server sends in another."""

import asyncio
import threading
from collections import deque
from contextlib import nullcontext
from types import SimpleNamespace

import pytest

from hexarm.panel.nodes import web_server
from hexarm.panel.nodes.web_server import start_server, stop_server
from manipulator.errors import Refused


class Waiters(deque):
    """What waits for an asyncio.Event; remembers which threads woke it."""

    def __init__(self):
        super().__init__()
        self.threads = set()

    def __iter__(self):
        self.threads.add(threading.get_ident())
        return super().__iter__()


@pytest.fixture
def server():
    running = start_server('127.0.0.1', 8300, 'drawn', {})
    yield running
    stop_server(running)


def test_what_sends_to_the_pages_is_woken_in_its_own_thread(server):
    """`deque mutated during iteration` ended a panel: its two threads woke the same senders."""
    event = server._websock_server.get_message_buffer().message_event
    frame, waits = server.scene.add_frame('/frame'), threading.Event()

    async def send():
        event._waiters = waiters = Waiters()
        event.clear()
        waits.set()
        await event.wait()
        return waiters.threads, threading.get_ident()

    sender = asyncio.run_coroutine_threadsafe(send(), server.get_event_loop())
    assert waits.wait(60)
    frame.position = (0.0, 0.0, 0.1)
    woken_by, own = sender.result(60)
    assert woken_by == {own}


def test_a_viser_that_is_built_differently_is_refused_with_what_to_install(monkeypatch):
    other = SimpleNamespace(get_event_loop=bool, stop=bool)
    monkeypatch.setattr(web_server.viser, 'ViserServer', lambda *_, **options: other)
    monkeypatch.setattr(web_server, '_extended_serve', lambda handlers: nullcontext([8300]))
    with pytest.raises(Refused, match=r'is built differently than this panel expects: .*viser'):
        start_server('127.0.0.1', 8300, 'drawn', {})
