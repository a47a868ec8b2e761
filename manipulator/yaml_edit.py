"""New values in the text of a YAML file, with every other character left as it was.

Comments, order, spacing and quotes survive because the file is never rewritten: PyYAML knows
the span of each value, and only those characters are replaced.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, TypeAlias

import yaml

from manipulator.errors import ConfigError

Place: TypeAlias = tuple[str | int, ...]
"""Keys and list indices from the top: ('servos', 'joints', 0, 'sign')."""

_BEHIND = re.compile(r'(\s+\w+):[^#]*?(\s*#.*)$').match


def with_values(text: str, values: Mapping[Place, str]) -> str:
    """The text with new scalars or flow lists at places that exist; ConfigError names others."""
    root = _composed(text)
    spans = [(*_span(_node(root, place)), new) for place, new in values.items()]
    for start, end, new in sorted(spans, reverse=True):
        text = text[:start] + new + text[end:]
    return text


def flow_list(numbers: Iterable[float], digits: int = 4) -> str:
    """The numbers, rounded, as a flow list; without a -0.0."""
    return f'[{", ".join(str(round(float(n), digits) + 0.0) for n in numbers)}]'


def with_section(text: str, key: str, lines: Sequence[str]) -> str:
    """The text with the values under a top-level key exchanged for `lines`.

    Comments that have a line of their own stay, ahead of the new lines, and those behind a key
    that is there again; ConfigError where there is no such key.
    """
    node = _node(_composed(text), (key,))
    old = text.split('\n')
    first = next(i for i, line in enumerate(old) if re.match(rf'{re.escape(key)}\s*:', line))
    last = max(_last_lines(node))
    comments = [line for line in old[first + 1 : last + 1] if line.lstrip().startswith('#')]
    behind = {found[1]: found[2] for line in old[first + 1 : last + 1] if (found := _BEHIND(line))}
    lines = [line + behind.get(line.split(':')[0], '') for line in lines]
    head = old[first] if node.start_mark.line > first else f'{key}:'
    return '\n'.join([*old[:first], head, *comments, *lines, *old[last + 1 :]])


def _composed(text: str) -> Any:
    if '\r' in text:
        raise ConfigError(['has Windows line ends: save it with those of Linux first'])
    try:
        return yaml.compose(text, Loader=yaml.SafeLoader)
    except yaml.YAMLError as error:
        raise ConfigError([' '.join(str(error).split())]) from error


def _node(root: Any, place: Place) -> Any:
    """The node at `place`."""
    node = root
    for depth, step in enumerate(place):
        found = None
        if isinstance(node, yaml.MappingNode):
            found = next((value for name, value in node.value if name.value == step), None)
        elif isinstance(node, yaml.SequenceNode) and isinstance(step, int):
            found = node.value[step] if step < len(node.value) else None
        if found is None:
            raise ConfigError([f'{".".join(map(str, place[: depth + 1]))}: missing'])
        node = found
    return node


def _span(node: Any) -> tuple[int, int]:
    """The span of a value in the text, in characters."""
    if not isinstance(node, yaml.ScalarNode) and not node.flow_style:
        raise ConfigError([f'line {node.start_mark.line + 1}: a value over several lines'])
    return node.start_mark.index, node.end_mark.index


def _last_lines(node: Any) -> Iterator[int]:
    """The lines on which the values within a node end; a block ends where its last value does."""
    if isinstance(node, yaml.ScalarNode) or node.flow_style:
        yield node.end_mark.line
        return
    for entry in node.value:
        for inner in entry if isinstance(entry, tuple) else (entry,):
            yield from _last_lines(inner)
