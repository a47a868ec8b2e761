"""viser's server with three things added: who may connect, our own page, and its connections.

viser draws the machine; its own controls suit neither a phone nor a hand that must be there. So
the page is ours, with viser's canvas in it. It is added where viser opens its one port: a single
address serves all.

Who may open the page's connection: the page itself, no other page that a browser shows.

Browsers let any site open a WebSocket to this computer, and report where the script came from. So
a connection must come from a page of the same address (Origin and Host agree), and the address
must be one that no foreign name server can answer for: a number, localhost, or this computer's
name. Programs that are no browser send no Origin; they could move the machine over ROS as well.

The page's connections: the joystick's, beats in, answers out; the controls', questions and
requests in, states out.

Runs in the web server's thread; the node calls from its own.
"""

import asyncio
import contextlib
import functools
import http
import io
import ipaddress
import itertools
import socket
import threading
import time
from collections.abc import Awaitable, Callable, Collection, Iterator, Mapping
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import viser
import websockets.asyncio.server as websockets_server
from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response

from hexarm.panel.joystick import Joystick
from hexarm.panel.page_requests import Request as PageRequest
from hexarm.panel.page_requests import answer, beat_of, request_of
from manipulator.arrays import Array
from manipulator.errors import InvalidInput, Refused
from manipulator.formatting import shown
from manipulator.requirements import INSTALL


def refusal(host: str, origin: str | None, own_names: Collection[str]) -> str:
    """Why a connection with these headers is refused; '' where it is welcome."""
    try:
        name = urlsplit(f'//{host}').hostname or ''
        source = host if origin is None else urlsplit(origin).netloc
    except ValueError:
        return f'the address {host[:80]!r} is none'
    if source.lower() != host.lower():
        return f'a page of {source[:80]!r} may not move this machine'
    if not _is_number(name) and name not in ('localhost', *(n.lower() for n in own_names)):
        return f'this computer is not called {name[:80]!r}: use its number, or localhost'
    return ''


def _is_number(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


class JoystickSocket:
    """Beats of all pages into one `Joystick`."""

    def __init__(self, may_move: Callable[[], str]) -> None:
        self._joystick = Joystick()
        self._lock = threading.Lock()
        self._pages = itertools.count()
        self._may_move = may_move

    async def serve(self, connection: ServerConnection) -> None:
        """One page, from its first message until it is gone."""
        page = next(self._pages)
        try:
            async for text in connection:
                await connection.send(self._answer(page, text))
        except InvalidInput as error:
            await connection.close(1008, str(error)[:100])
        except ConnectionClosed:
            pass
        finally:
            with self._lock:
                self._joystick.leave(page)

    def stick(self) -> Array | None:
        """What is held now (6,), None while nothing is."""
        with self._lock:
            return self._joystick.stick(time.monotonic())

    def stop(self) -> None:
        """The owner must release first."""
        with self._lock:
            self._joystick.stop()

    def _answer(self, page: int, text: str | bytes) -> str:
        message = beat_of(text)
        now = time.monotonic()
        with self._lock:
            if isinstance(message, int):
                self._joystick.release(page, message)
            else:
                self._joystick.receive(page, message, now)
            holder, reason = self._joystick.holder(now), self._joystick.reason(page)
        has_it = holder == page
        return answer(now, has_it, holder is not None and not has_it,
                      reason or (self._may_move() if has_it else ''))  # fmt: skip


class ControlsSocket:
    """The controls of all pages: each question is answered with the newest texts.

    `take` is called with each request, in the server's thread: it must return at once.
    """

    def __init__(self, machine: str, take: Callable[[PageRequest], None]) -> None:
        """machine: the text that a page receives first."""
        self._machine, self._take = machine, take
        self.texts = {'state': '', 'nodes': ''}
        self.pages = 0

    async def serve(self, connection: ServerConnection) -> None:
        """One page, from its first message until it is gone."""
        self.pages += 1
        try:
            await connection.send(self._machine)
            async for text in connection:
                request = request_of(text)
                if isinstance(request, PageRequest):
                    self._take(request)
                elif self.texts[request]:
                    await connection.send(self.texts[request])
        except InvalidInput as error:
            await connection.close(1008, str(error)[:100])
        except ConnectionClosed:
            pass
        finally:
            self.pages -= 1


JOYSTICK_PATH, CONTROLS_PATH = '/joystick', '/controls'

Handler = Callable[[ServerConnection], Awaitable[None]]

PAGE = Path(__file__).parents[1] / 'page'
FILES = {
    '/': 'index.html',
    **{f'/{name}': name for name in ('panel.css', 'panel.js', 'plots.js', 'joystick.html')},
}
"""The page's files by path; viser serves its own, /index.html."""
KINDS = {'.html': 'text/html', '.css': 'text/css', '.js': 'text/javascript'}


def start_server(host: str, port: int, label: str, handlers: Mapping[str, Handler]) -> Any:
    """A running viser server on the first free port from `port`; Refused with the reason.

    handlers: of connections, by path.
    """
    _check_host(host)
    quiet = contextlib.redirect_stdout(io.StringIO())  # the node logs its address itself
    with _extended_serve(handlers) as opened, quiet:
        server = viser.ViserServer(host, port, label, verbose=False)
    if not opened or not _made_to_draw_in_any_thread(server):
        server.stop()
        raise Refused(
            f'viser {viser.__version__} is built differently than this panel expects: '
            f'{INSTALL["viser"]}'
        )
    server.request_share_url = _refuse_to_share
    return server


def stop_server(server: Any) -> None:
    """Closes every page's connection, without viser's own message about it."""
    with contextlib.redirect_stdout(io.StringIO()):
        server.stop()


def address(host: str, port: int) -> str:
    """What to type into a browser on this computer, or on another where the page is for all."""
    is_public = host in ('0.0.0.0', '::', '')
    name = socket.gethostname() if is_public else host
    return f'http://[{name}]:{port}' if ':' in name else f'http://{name}:{port}'


def _check_host(host: str) -> None:
    try:
        socket.getaddrinfo(host or None, None)
        with socket.socket(socket.AF_INET6 if ':' in host else socket.AF_INET) as probe:
            probe.bind((host, 0))
    except OSError as error:
        raise Refused(
            f'host {shown(host)} is not an address of this computer: {error.strerror}'
        ) from error


@contextlib.contextmanager
def _extended_serve(handlers: Mapping[str, Handler]) -> Iterator[list[int]]:
    """While viser opens its port; yields a list that is not empty once it has done so."""
    opened: list[int] = []
    original = websockets_server.serve

    @functools.wraps(original)
    def serve(handler: Handler, host: str, port: int, **options: Any) -> Any:
        opened.append(port)
        options['process_request'] = _checked(options.get('process_request'))

        async def handle(connection: ServerConnection) -> None:
            path = '' if connection.request is None else connection.request.path
            await handlers.get(path, handler)(connection)

        return original(handle, host, port, **options)

    websockets_server.serve = serve
    try:
        yield opened
    finally:
        websockets_server.serve = original


def _made_to_draw_in_any_thread(server: Any) -> bool:
    """False where viser is built differently.

    viser wakes what sends to the pages by an asyncio.Event, which no other thread may set. It
    does so in the thread that draws, where that raises an error now and then, and again in its
    own. The second time is enough.
    """
    loop = server.get_event_loop()
    try:
        event = server._websock_server.get_message_buffer().message_event
    except AttributeError:
        return False
    wake = event.set

    def wake_in_the_loop() -> None:
        if asyncio._get_running_loop() is loop:
            wake()

    event.set = wake_in_the_loop
    return True


def _checked(serve_file: Any) -> Callable[[ServerConnection, Request], Response | None]:
    """Refuses what is not our own page; hands on what is no WebSocket."""
    own_names = (socket.gethostname(), f'{socket.gethostname()}.local', socket.getfqdn())

    def process_request(connection: ServerConnection, request: Request) -> Response | None:
        headers = request.headers
        reason = refusal(headers.get('Host', ''), headers.get('Origin'), own_names)
        if reason:
            return connection.respond(http.HTTPStatus.FORBIDDEN, f'{reason}\n')
        path = request.path.partition('?')[0]
        if path in FILES and headers.get('Upgrade') != 'websocket':
            return _file(FILES[path])
        found: Response | None = None if serve_file is None else serve_file(connection, request)
        return found

    return process_request


def _file(name: str) -> Response:
    """A file of the page, never kept by a browser: the next version may be another."""
    content = (PAGE / name).read_bytes()
    headers = Headers(
        {
            'Content-Type': f'{KINDS[Path(name).suffix]}; charset=utf-8',
            'Content-Length': str(len(content)),
            'Cache-Control': 'no-store',
        }
    )
    return Response(http.HTTPStatus.OK, 'OK', headers, content)


def _refuse_to_share(*arguments: object, **options: object) -> None:
    """A client may ask viser to publish its page on the internet; not this one."""
