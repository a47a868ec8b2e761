"""Services that answer later, without a thread that waits: from a tick, once the outcome is known.

rclpy sends the response as soon as a callback returns, and its EventsExecutor runs no coroutine
that could wait. Here the callback only begins the work; the response is sent later.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from rclpy.node import Node

MOST_WAITING = 8
"""Requests of one service that may wait for their answer."""


@dataclass(frozen=True, eq=False)
class Call:
    """One request, and its response to fill in."""

    request: Any
    response: Any
    send: Callable[[], None]


def create_late_service(
    node: Node, service_type: Any, name: str, begin: Callable[[Call], None]
) -> list[Call]:
    """A service whose requests go to `begin`; each is answered when its `send` is called.

    Returns the list that holds the calls which are not answered yet. What comes while
    MOST_WAITING wait is answered at once, with an empty response.
    """
    waiting: list[Call] = []
    requests: list[Any] = []

    def receive(request: Any, response: Any) -> Any:
        requests.append(request)
        return response

    service = node.create_service(service_type, name, receive)
    answer = service.send_response

    def keep(response: Any, header: Any) -> None:
        def send() -> None:
            waiting.remove(call)
            answer(response, header)

        call = Call(requests.pop(), response, send)
        waiting.append(call)
        if len(waiting) > MOST_WAITING:
            send()
        else:
            begin(call)

    service.send_response = keep
    return waiting
