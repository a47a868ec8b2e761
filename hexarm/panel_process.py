"""The panel as one more process of a machine's graph."""

import errno
import importlib.util
import socket
from collections.abc import Callable

from hexarm.graph import Executable
from manipulator.errors import Refused

HOST = '127.0.0.1'
FIRST_PORT, PORTS = 8080, 100


def panel_process(machine: str) -> Executable:
    """The panel on the first free port from 8080; ModuleNotFoundError where viser is missing."""
    if importlib.util.find_spec('viser') is None:
        raise ModuleNotFoundError('the panel needs viser', name='viser')
    return Executable('panel', {'machine': machine, 'port': str(_free_port())})


def panel_address(panel: Executable) -> str:
    """What to type into a browser on this computer."""
    return f'http://{HOST}:{panel.parameters["port"]}'


def panel_words(panel: Executable) -> str:
    """The address, and a remark where it is not the usual one."""
    is_usual = panel.parameters['port'] == str(FIRST_PORT)
    taken = '' if is_usual else f' ({FIRST_PORT} is taken, perhaps by another page)'
    return panel_address(panel) + taken


def offered_panel(machine: str, echo: Callable[[str], None]) -> list[Executable]:
    """The panel and a line about it; without viser only the line."""
    try:
        panel = panel_process(machine)
    except ModuleNotFoundError:
        echo('(with viser installed, pip install viser, you could watch this in a browser)')
        return []
    echo(f'watch it in a browser: {panel_words(panel)}')
    return [panel]


def _free_port() -> int:
    for port in range(FIRST_PORT, FIRST_PORT + PORTS):
        with socket.socket() as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                probe.bind((HOST, port))
            except OSError as error:
                if error.errno != errno.EADDRINUSE:
                    raise
                continue
            return port
    raise Refused(f'no port from {FIRST_PORT} to {FIRST_PORT + PORTS - 1} is free for the panel')
