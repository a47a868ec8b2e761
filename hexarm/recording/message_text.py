"""The text of a message type with everything it is made of: MCAP's schema encoding `ros2msg`.

https://mcap.dev/spec/registry: the type's own .msg file, then each type that it mentions, behind a
line of 80 equal signs and a line `MSG: package/Name`.
"""

import re
from importlib.util import find_spec
from pathlib import Path

from manipulator.errors import ManipulatorError

SEPARATOR = '=' * 80
PLAIN = re.compile(r'bool|byte|char|float(32|64)|u?int(8|16|32|64)|w?string')


class UnknownType(ManipulatorError, LookupError):
    """A message type whose package is not installed here, or that has no .msg file."""


def schema_text(type_name: str) -> str:
    """The schema of `package/msg/Name`; UnknownType names the type that is missing."""
    package, _, name = type_name.split('/')
    own = message_text(package, name)
    found: dict[str, str] = {}
    waiting = mentioned(own, package)
    while waiting:
        other = waiting.pop(0)
        if other not in found:
            found[other] = message_text(*other.split('/'))
            waiting += mentioned(found[other], other.split('/')[0])
    parts = [f'{SEPARATOR}\nMSG: {other}\n{text}' for other, text in found.items()]
    return '\n'.join([own, *parts])


def message_text(package: str, name: str) -> str:
    """The .msg file of a type, from the share/ folder of the prefix that holds its Python."""
    spec = find_spec(package)
    homes = [Path(place) for place in (spec.submodule_search_locations or [])] if spec else []
    for prefix in (parent for home in homes for parent in home.resolve().parents):
        path = prefix / 'share' / package / 'msg' / f'{name}.msg'
        if path.is_file():
            return path.read_text(encoding='utf-8')
    raise UnknownType(f'{package}/msg/{name} is not installed here')


def mentioned(text: str, package: str) -> list[str]:
    """The types `package/Name` of the fields of a .msg text, in order; its own are unqualified."""
    types = []
    for line in text.splitlines():
        field = re.match(r'\s*([A-Za-z]\w*(?:/[A-Za-z]\w*)*)\S*\s+[A-Za-z]', line.split('#')[0])
        if field is not None and not PLAIN.fullmatch(field[1]):
            words = field[1].split('/')
            types.append(f'{words[0] if len(words) > 1 else package}/{words[-1]}')
    return types
