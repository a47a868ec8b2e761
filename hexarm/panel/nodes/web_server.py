"""viser's server with two things added: who may connect, and the joystick's own connection.

viser admits any site that a browser shows, and its buttons tell presses but not whose hand is
still there. Both are added where it opens its one port, so that a single address serves all.
"""

import contextlib
import functools
import http
import io
import socket
from collections.abc import Awaitable, Callable, Iterator
from typing import Any

import viser
import websockets.asyncio.server as websockets_server
from websockets.asyncio.server import ServerConnection
from websockets.http11 import Request, Response

from hexarm.panel.access import refusal
from manipulator.errors import Refused
from manipulator.requirements import INSTALL
from manipulator.words import shown

JOYSTICK_PATH = '/joystick'

Handler = Callable[[ServerConnection], Awaitable[None]]


def start_server(host: str, port: int, label: str, serve_joystick: Handler) -> Any:
    """A running viser server on the first free port from `port`; Refused says what is wrong."""
    _check_host(host)
    quiet = contextlib.redirect_stdout(io.StringIO())  # the node says its address itself
    with _extended_serve(serve_joystick) as opened, quiet:
        server = viser.ViserServer(host, port, label, verbose=False)
    if not opened:
        server.stop()
        raise Refused(
            f'viser {viser.__version__} opens its port in a way that this panel does not know: '
            f'{INSTALL["viser"]}'
        )
    server.request_share_url = _refuse_to_share
    return server


def stop_server(server: Any) -> None:
    """Closes every page's connection, without viser's own word about it."""
    with contextlib.redirect_stdout(io.StringIO()):
        server.stop()


def address(host: str, port: int) -> str:
    """What to type into a browser on this computer, or on another where the page is for all."""
    everybody = host in ('0.0.0.0', '::', '')
    name = socket.gethostname() if everybody else host
    return f'http://[{name}]:{port}' if ':' in name else f'http://{name}:{port}'


def _check_host(host: str) -> None:
    try:
        socket.getaddrinfo(host or None, None)
        with socket.socket(socket.AF_INET6 if ':' in host else socket.AF_INET) as probe:
            probe.bind((host, 0))
    except OSError as error:
        raise Refused(
            f'host {shown(host)} is no address of this computer: {error.strerror}'
        ) from error


@contextlib.contextmanager
def _extended_serve(serve_joystick: Handler) -> Iterator[list[int]]:
    """While viser opens its port; yields a list that is not empty once it has done so."""
    opened: list[int] = []
    original = websockets_server.serve

    @functools.wraps(original)
    def serve(handler: Handler, host: str, port: int, **options: Any) -> Any:
        opened.append(port)
        options['process_request'] = _checked(options.get('process_request'))

        async def handle(connection: ServerConnection) -> None:
            is_joystick = connection.request.path == JOYSTICK_PATH
            await (serve_joystick if is_joystick else handler)(connection)

        return original(handle, host, port, **options)

    websockets_server.serve = serve
    try:
        yield opened
    finally:
        websockets_server.serve = original


def _checked(serve_file: Any) -> Callable[[ServerConnection, Request], Response | None]:
    """Refuses what is not our own page; hands on what is no WebSocket."""
    own_names = (socket.gethostname(), f'{socket.gethostname()}.local', socket.getfqdn())

    def process_request(connection: ServerConnection, request: Request) -> Response | None:
        headers = request.headers
        reason = refusal(headers.get('Host', ''), headers.get('Origin'), own_names)
        if reason:
            return connection.respond(http.HTTPStatus.FORBIDDEN, f'{reason}\n')
        found: Response | None = None if serve_file is None else serve_file(connection, request)
        return found

    return process_request


def _refuse_to_share(*arguments: object, **options: object) -> None:
    """A client may ask viser to publish its page on the internet; not this one."""
