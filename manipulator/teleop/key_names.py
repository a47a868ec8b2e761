"""The names of the keys in what a terminal sends; arrow keys come as escape sequences."""

import re

ARROWS = {'A': 'up', 'B': 'down', 'C': 'right', 'D': 'left'}
CONTROLS = {'\r': 'enter', '\n': 'enter', '\x7f': 'backspace', '\x08': 'backspace'}
UNKNOWN = '?'
MOST_AT_ONCE = 12
"""Keys in one reading; more are a paste or a cat, not a hand."""

_KEY = re.compile('\x1b[\\[O](?P<arrow>[A-D])|\x1b(\\[[0-?]*[ -/]*[@-~]|O.)|.', re.DOTALL)


def key_names(characters: bytes) -> tuple[str, ...]:
    """The keys that were pressed, in order; none for a paste, unless a space is in it.

    Letters and signs are named by themselves, a space is 'space'. It is the key that stops, so
    it is never lost: a paste with one in it is one 'space'.
    """
    names = tuple(map(_name, _KEY.finditer(characters.decode(errors='replace'))))
    if len(names) > MOST_AT_ONCE:
        return ('space',) if 'space' in names else ()
    return names


def _name(found: 're.Match[str]') -> str:
    text = found[0]
    if found['arrow']:
        return ARROWS[found['arrow']]
    if text[0] == '\x1b':
        return 'escape' if len(text) == 1 else UNKNOWN
    return 'space' if text == ' ' else CONTROLS.get(text, text)
