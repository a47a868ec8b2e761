"""Machine files: YAML text to frozen dataclasses, with every fault found at once.

A section's dataclass is its schema, and the table of its keys: a field's name carries the unit
(`_mm`, `_deg`, `_us`), `quantity` and `key` its range, default and meaning. The loader, the page
docs/machine-files.md and the JSON schema read them there. A union of dataclasses are the forms
that a section may have; the one with most of the keys is meant.
"""

import dataclasses
import math
import re
import types
import typing
from collections.abc import Mapping
from typing import Any, TypeVar

import yaml

from manipulator.errors import ConfigError
from manipulator.formatting import (
    counted,
    did_you_mean,
    nearest,
    not_one_of,
    shortened,
    shown,
    told_apart,
)
from manipulator.strict_yaml import content_of

T = TypeVar('T')
U = TypeVar('U')
MAX_CHARACTERS = 100_000
MOST_OF_A_REASON = 200
"""Characters of an error of PyYAML, which may repeat the file."""


SIZE_MM = (1e-3, 1e6)
"""Of a length that a machine cannot do without; `unit_hints` judges it beside the others."""
PLACE_MM = (-1e6, 1e6)
TURN_DEG = (-360.0, 360.0)
NAME = re.compile(r'[^\W\d_][\w-]{0,39}')
NAME_RULE = 'a letter, then letters, digits, _ and -, at most 40'
"""What users may call a saved pose, a sequence or a tool."""
RATE = (1e-6, 1e9)
"""Of a speed, acceleration or jerk, whatever the unit."""


def quantity(low: float, high: float, meaning: str = '', **options: Any) -> Any:
    """A dataclass field whose value, or every value of whose list, must lie in [low, high]."""
    return dataclasses.field(metadata={'range': (low, high), 'meaning': meaning}, **options)


def key(meaning: str, **options: Any) -> Any:
    """A dataclass field that is no quantity: a text, a choice, a section, a list of these."""
    return dataclasses.field(metadata={'meaning': meaning}, **options)


def forms_of(schema: Any) -> tuple[Any, ...]:
    """The dataclasses that a section may be: one, or those of a union."""
    return tuple(a for a in typing.get_args(schema) if a is not type(None)) or (schema,)


def parse_yaml(text: str, source: str = '') -> dict[str, Any]:
    """YAML text as a mapping; repeated keys, aliases, tags and huge files are refused."""
    if text.lstrip('\ufeff \t\r\n').startswith('<'):
        raise ConfigError([_markup(text)], source)
    if len(text) > MAX_CHARACTERS:
        raise ConfigError(
            [f'{len(text)} characters, a machine file has at most {MAX_CHARACTERS}'], source
        )
    try:
        content = content_of(text)
    except yaml.MarkedYAMLError as error:
        raise ConfigError([_short(_at_its_line(error))], source) from error
    except yaml.YAMLError as error:
        raise ConfigError([_short(error)], source) from error
    except (ValueError, TypeError, OverflowError) as error:
        # PyYAML lets through what dates, numbers and keys raise that cannot be made.
        problem = f'holds a value that cannot be read: {_short(error)}'
        raise ConfigError([problem], source) from error
    except RecursionError as error:
        raise ConfigError(['nested too deeply'], source) from error
    if not isinstance(content, dict):
        raise ConfigError([f'holds {_kind(content)}, needs a mapping of keys'], source)
    return content


def build(schema: type[T], content: object, where: str = '', source: str = '') -> T:
    """`content` as an instance of the dataclass `schema`; ConfigError lists all that is wrong."""
    problems: list[str] = []
    result = _convert(schema, content, where, problems)
    if problems:
        raise ConfigError(problems, source)
    return typing.cast(T, result)


def build_both(
    first: tuple[type[T], object, str], second: tuple[type[U], object, str]
) -> tuple[T, U]:
    """Two sections as (schema, content, where); ConfigError lists what is wrong in both."""
    problems: list[str] = []
    results = tuple(
        _convert(schema, content, where, problems) for schema, content, where in (first, second)
    )
    if problems:
        raise ConfigError(problems)
    return typing.cast(tuple[T, U], results)


def _convert(expected: Any, value: object, where: str, problems: list[str]) -> Any:
    """`value` as the type `expected`; what does not fit is added to `problems`."""
    origin, arguments = typing.get_origin(expected), typing.get_args(expected)
    if dataclasses.is_dataclass(expected):
        return _convert_section(expected, value, where, problems)
    if origin in (typing.Union, types.UnionType):
        if value is None and type(None) in arguments:
            return None
        kinds = [a for a in arguments if a is not type(None)]
        if isinstance(value, Mapping) and all(map(dataclasses.is_dataclass, kinds)):
            return _convert_form(kinds, value, where, problems)
        counts = [len(typing.get_args(k)) for k in kinds if typing.get_origin(k) is tuple]
        if isinstance(value, list) and len(counts) > 1 and len(value) not in counts:
            problems.append(_wrong_count(where, value, ' or '.join(map(str, counts))))
            return ()
        return _convert(_fitting(kinds, value), value, where, problems)
    if origin is typing.Literal:
        if value not in arguments:
            problems.append(f'{where}: {not_one_of(value, arguments)}')
        return value
    if origin is tuple:
        return _convert_list(arguments, value, where, problems)
    if expected is Any:
        return value
    if origin is dict:
        if not isinstance(value, Mapping):
            problems.append(f'{where}: holds {_kind(value)}, needs a mapping of keys')
        return value
    return _convert_scalar(expected, value, where, problems)


def _fitting(kinds: list[Any], value: object) -> Any:
    """Of the kinds of a union the one that `value` looks like: a list of as many, or no list."""
    if not isinstance(value, list):
        return next((kind for kind in kinds if typing.get_origin(kind) is not tuple), kinds[0])
    lists = [kind for kind in kinds if typing.get_origin(kind) is tuple]
    as_long = (kind for kind in lists if len(typing.get_args(kind)) == len(value))
    return next(as_long, lists[0] if lists else kinds[0])


def _convert_form(
    forms: list[Any], value: Mapping[Any, Any], where: str, problems: list[str]
) -> Any:
    form = fitting_form(forms, value)
    if form is None:
        firsts = [dataclasses.fields(form)[0].name for form in forms]
        problems.append(
            f'{where}: has the keys of no form or of two, needs one of {", ".join(firsts)}'
        )
        return None
    own, *others = ([f.name for f in dataclasses.fields(one)] for one in (form, *forms))
    foreign = {
        name: names[0] for names in others for name in names if name in value and name not in own
    }
    problems += [
        f'{_join(where, name)}: does not go with {own[0]}'
        + (f', but with {first}' if first != name else '')
        for name, first in foreign.items()
    ]
    rest = {name: entry for name, entry in value.items() if name not in foreign}
    return _convert_section(form, rest, where, problems)


def fitting_form(forms: list[Any], value: Mapping[Any, Any]) -> Any:
    """The dataclass that has most of the keys in `value`; None where two have as many."""
    shared = [len({f.name for f in dataclasses.fields(form)} & {*value}) for form in forms]
    best = max(shared)
    return forms[shared.index(best)] if shared.count(best) == 1 else None


def unknown_key(where: str, name: object, known: list[str]) -> tuple[str, str]:
    """The known key that is nearest, empty where none is near; and the problem in words."""
    near = nearest(str(name), known)
    return near, f'{_join(where, name)}: unknown key{did_you_mean(near)}'


def _convert_section(schema: Any, value: object, where: str, problems: list[str]) -> Any:
    if not isinstance(value, Mapping):
        problems.append(f'{where or "file"}: holds {_kind(value)}, needs a mapping of keys')
        return None
    fields = {f.name: f for f in dataclasses.fields(schema) if f.init}
    before, meant = len(problems), set()
    for name in value:
        if name not in fields:
            near, problem = unknown_key(where, name, list(fields))
            meant.add(near)
            problems.append(problem)
    hints = typing.get_type_hints(schema)
    arguments = {}
    for name, field in fields.items():
        place = _join(where, name)
        if name in value:
            arguments[name] = _convert(hints[name], value[name], place, problems)
            _check_range(field, arguments[name], place, problems)
        elif is_required(field) and name not in meant:
            problems.append(f'{place}: missing')
    if len(problems) > before:
        return None
    try:
        return schema(**arguments)
    except ConfigError as error:
        problems.extend(f'{where}: {p}' if where else p for p in error.problems)
        return None


def _convert_list(arguments: Any, value: object, where: str, problems: list[str]) -> Any:
    if not isinstance(value, list):
        problems.append(f'{where}: holds {_kind(value)}, needs a list')
        return ()
    if arguments[-1] is Ellipsis:
        arguments = (arguments[0],) * len(value)
    if len(value) != len(arguments):
        problems.append(_wrong_count(where, value, str(len(arguments))))
        return ()
    return tuple(
        _convert(kind, entry, f'{where}[{i}]', problems)
        for i, (kind, entry) in enumerate(zip(arguments, value, strict=True))
    )


def _wrong_count(where: str, value: list[Any], needed: str) -> str:
    return f'{where}: has {counted(len(value), "entry", "entries")}, needs {needed}'


def _convert_scalar(expected: Any, value: object, where: str, problems: list[str]) -> Any:
    if expected is float and isinstance(value, int | float) and not isinstance(value, bool):
        number = _as_float(value)
        if math.isfinite(number):
            return number
        problems.append(f'{where}: {number} is not finite')
        return None
    if type(value) is expected:
        return value
    problems.append(
        f'{where}: holds {_kind(value)}, needs {_NAMES.get(expected, expected.__name__)}'
    )
    return None


def _check_range(field: Any, value: object, where: str, problems: list[str]) -> None:
    bounds = field.metadata.get('range')
    if bounds is None or value is None:
        return
    if isinstance(value, tuple):
        for i, entry in enumerate(value):
            _check_range(field, entry, f'{where}[{i}]', problems)
    elif isinstance(value, int | float) and not bounds[0] <= value <= bounds[1]:
        number, low, high = told_apart([_as_float(value), *bounds])
        problems.append(f'{where}: {number} outside [{low}, {high}]')


def _as_float(value: float) -> float:
    """Infinite for whole numbers that no float can hold."""
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


_NAMES = {float: 'a number', int: 'a whole number', str: 'a text', bool: 'true or false'}


def _kind(value: object) -> str:
    names = {dict: 'a mapping', list: 'a list', type(None): 'nothing', bool: 'true or false'}
    one = {str: 'the text', int: 'the number', float: 'the number'}.get(type(value), 'the value')
    return names.get(type(value)) or f'{one} {shown(value)}'


def _join(where: str, key: object) -> str:
    name = shortened(str(key))
    return f'{where}.{name}' if where else name


def _at_its_line(error: yaml.MarkedYAMLError) -> str:
    """What YAML does not allow, and the line of the text."""
    mark = error.problem_mark
    if mark is None:
        return str(error)
    place, written = f'line {mark.line + 1}', (mark.get_snippet() or '').split('\n')[0].strip()
    if error.problem and "'\\t'" in error.problem:
        return f'{place} begins with a tab, YAML needs spaces there: {shown(written)}'
    return f'{place}: {", ".join(filter(None, (error.context, error.problem)))}: {shown(written)}'


def _short(error: object) -> str:
    return shortened(' '.join(str(error).split()), MOST_OF_A_REASON)


def _markup(text: str) -> str:
    """What a file that begins with < is."""
    if '<robot' in text:
        return 'is a URDF: hexarm import FILE makes a machine file of it'
    return 'is XML or HTML, needs YAML'


def is_required(field: Any) -> bool:
    """Whether a file must have the key of a dataclass field."""
    missing = dataclasses.MISSING
    return field.default is missing and field.default_factory is missing
