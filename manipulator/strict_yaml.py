"""YAML without what a machine file has no use for: aliases, repeated keys, tags of Python."""

import re
from typing import Any

import yaml
from yaml.composer import Composer

from manipulator.formatting import shown

NUMBER = re.compile(r'[-+]?(\.\d+|\d+(\.\d*)?)([eE][-+]?\d+)?$')
"""As in YAML 1.2; for PyYAML, which knows 1.1, 3e6 is a text."""


class _Strict(Composer):
    """Refuses aliases (no anchor bombs) and repeated keys."""

    def compose_node(self, parent: Any, index: Any) -> Any:
        if self.check_event(yaml.AliasEvent):  # type: ignore[attr-defined]
            mark = self.peek_event().start_mark  # type: ignore[attr-defined]
            raise yaml.YAMLError(f'line {mark.line + 1}: aliases are not allowed')
        return super().compose_node(parent, index)

    def construct_mapping(self, node: Any, deep: bool = False) -> dict[Any, Any]:
        seen: set[object] = set()
        for key_node, _ in node.value:
            if key_node.value in seen:
                line = key_node.start_mark.line + 1
                raise yaml.YAMLError(f'line {line}: key {shown(key_node.value)} is duplicated')
            if isinstance(key_node.value, str):
                seen.add(key_node.value)
        mapping: dict[Any, Any] = super().construct_mapping(node, deep)  # type: ignore[misc]
        return mapping


class StrictLoader(_Strict, yaml.SafeLoader):
    """In Python, which gives the best error messages."""


StrictLoader.add_implicit_resolver('tag:yaml.org,2002:float', NUMBER, list('-+.0123456789'))


_Events: Any = getattr(yaml, 'CSafeLoader', yaml.SafeLoader)


class QuickLoader(_Strict, _Events):  # type: ignore[misc]
    """On libyaml, where PyYAML has it: several times as fast."""

    def __init__(self, stream: str) -> None:
        _Events.__init__(self, stream)
        Composer.__init__(self)


QuickLoader.add_implicit_resolver('tag:yaml.org,2002:float', NUMBER, list('-+.0123456789'))


def content_of(text: str) -> object:
    """What the text holds: read quickly, or else slowly, for an error that shows the line."""
    try:
        return yaml.load(text, Loader=QuickLoader)
    except (yaml.YAMLError, ValueError, TypeError, OverflowError, RecursionError):
        return yaml.load(text, Loader=StrictLoader)
