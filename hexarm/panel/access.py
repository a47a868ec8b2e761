"""Who may open the page's connection: the page itself, not whatever else a browser shows.

Browsers let any site open a WebSocket to this computer, and tell where the script came from. So
a connection must come from a page of the same address (Origin and Host agree), and the address
must be one that no foreign name server can answer for: a number, localhost, or this computer's
name. Programs that are no browser send no Origin; they could move the machine over ROS as well.
"""

import ipaddress
from collections.abc import Collection
from urllib.parse import urlsplit


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
