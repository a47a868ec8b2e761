"""Every key of a machine file: from the schemas that check them to a page and a JSON schema.

`python -m hexarm.machine_keys` writes both, docs/machine-files.md and config/machine.schema.json.
"""

import dataclasses
import functools
import json
import operator
import re
import types
import typing
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from arm_control import load as arms
from bridge.servo_config import LinkConfig, ServosConfig, SimulationConfig
from hexapod_control import load as hexapods
from hexapod_control.stacks import load as load_stack
from hexarm.simulation.dynamics_config import SCHEMAS, StackDynamicsConfig
from manipulator.config import forms_of, is_required
from manipulator.frames import FramesConfig, ToolConfig
from manipulator.limits.surroundings import BodiesConfig, SurroundingsConfig
from manipulator.limits.task_space import TaskSpaceConfig
from manipulator.machine import Kind, MachineFile
from manipulator.motion_limits import MotionConfig

KINDS: dict[str, Kind[Any]] = {**hexapods.KINDS, **arms.KINDS, 'stack': load_stack.KIND}
OF_KINDS = ('geometry', 'limits', 'dynamics')
BRIDGE: dict[str, Any] = {
    'servos': ServosConfig,
    'link': LinkConfig,
    'simulation': SimulationConfig,
}

UNITS = {
    'mm_s3': 'mm/s³', 'mm_s2': 'mm/s²', 'mm_s': 'mm/s', 'us_per_mm': 'µs/mm', 'g_mm2': 'g·mm²',
    'deg_s3': '°/s³', 'deg_s2': '°/s²', 'deg_s': '°/s', 'us_per_deg': 'µs/°', 'n_m': 'N·m',
    'mm': 'mm', 'deg': '°', 'us': 'µs', 'ms': 'ms', 'g': 'g', 'n': 'N', 'v': 'V', 'baud': 'bit/s',
}  # fmt: skip
"""By the end of a key's name, longest first."""
WORDS = {float: 'number', int: 'whole number', str: 'text', bool: 'true or false'}
TYPES = {float: 'number', int: 'integer', str: 'string', bool: 'boolean'}

ROOT = Path(__file__).resolve().parent.parent
PAGE, SCHEMA = ROOT / 'docs' / 'machine-files.md', ROOT / 'config' / 'machine.schema.json'
GENERATED = '<!-- From here on generated: python -m hexarm.machine_keys -->\n'


def sections_of(kind: str) -> dict[str, Any]:
    """The schema of each section that depends on the kind, and of the bridge's."""
    room = KINDS[kind]
    return {
        'geometry': room.geometry,
        'limits': room.limits,
        'dynamics': SCHEMAS.get(kind, StackDynamicsConfig),
        **BRIDGE,
    }


@dataclasses.dataclass(frozen=True)
class Key:
    """One key of a section: its place as in `joints[].channel`, and its dataclass field."""

    place: str
    field: 'dataclasses.Field[Any]'
    type: Any

    @property
    def unit(self) -> str:
        """Empty where it has none."""
        name = self.field.name
        return next((u for end, u in UNITS.items() if re.search(rf'(^|_){end}$', name)), '')

    @property
    def kind(self) -> str:
        """What its value is, in words."""
        return _words(self.type)

    @property
    def range(self) -> str:
        """Empty where any value will do."""
        if typing.get_origin(self.type) is typing.Literal:
            return ', '.join(map(str, typing.get_args(self.type)))
        bounds = self.field.metadata.get('range', ())
        return ' … '.join(f'{end:g}'.replace('e+0', 'e').replace('e-0', 'e-') for end in bounds)

    @property
    def default(self) -> str:
        """Empty where the file must have it, or where there is none."""
        value = self.field.default
        if is_required(self.field):
            return 'required'
        if value is None or value is dataclasses.MISSING or value == '':
            return ''
        return f'{list(value)}' if isinstance(value, tuple) else str(value).lower()


def keys_of(schema: Any, place: str = '') -> Iterator[Key]:
    """Those of a dataclass, each followed by those within it."""
    hints = typing.get_type_hints(schema)
    for field in dataclasses.fields(schema):
        inner, path = _without_none(hints[field.name]), f'{place}{field.name}'
        yield Key(path, field, inner)
        is_list = typing.get_origin(inner) is tuple
        for form in forms_of(typing.get_args(inner)[0] if is_list else inner):
            if dataclasses.is_dataclass(form):
                yield from keys_of(form, f'{path}[].' if is_list else f'{path}.')


def tables() -> str:
    """The generated part of docs/machine-files.md."""
    kinds = ', '.join(f'`{kind}`' for kind in KINDS)
    lines = ['## The file', '', *_table(MachineFile, is_flat=True), f'Kinds: {kinds}.', '']
    for kind in KINDS:
        for name in OF_KINDS:
            schema = sections_of(kind)[name]
            for form in filter(dataclasses.fields, forms_of(schema)):
                lines += [f'### `{name}` of a `{kind}`{_form(form, schema)}', '', *_table(form)]
    others = {
        'frames': FramesConfig,
        'tools': ToolConfig,
        'task_space': TaskSpaceConfig,
        'surroundings': SurroundingsConfig,
        'bodies': BodiesConfig,
    }
    for name, schema in {'motion': MotionConfig, **BRIDGE, **others}.items():
        lines += [f'### `{name}`', '', *_table(schema)]
    return '\n'.join(lines).rstrip('\n') + '\n'


def json_schema() -> dict[str, Any]:
    """What editors know of machine files; `hexarm check` knows more."""
    top = _object(MachineFile)
    top['properties']['kind']['enum'] = list(KINDS)
    for name, schema in BRIDGE.items():
        top['properties'][name] |= _schema(schema)
    kinds = []
    for kind in KINDS:
        own = {n: _schema(s) for n, s in sections_of(kind).items() if n in OF_KINDS}
        kinds.append(
            {
                'if': {'properties': {'kind': {'const': kind}}, 'required': ['kind']},
                'then': {'properties': own},
            }
        )
    head = {'$schema': 'http://json-schema.org/draft-07/schema#', 'title': 'hexarm machine file'}
    return {**head, **top, 'allOf': kinds}


def _table(schema: Any, is_flat: bool = False) -> list[str]:
    rows = ['| key | holds | unit | range | default | meaning |', '|---|---|---|---|---|---|']
    for key in keys_of(schema):
        if is_flat and '.' in key.place:
            continue
        meaning = re.sub(r'docs/(\S+\.md)', r'[\1](\1)', key.field.metadata['meaning'])
        cells = (f'`{key.place}`', key.kind, key.unit, key.range, key.default, meaning)
        rows.append(f'| {" | ".join(cells)} |')
    return [*rows, '']


def _form(form: Any, schema: Any) -> str:
    return f' by `{dataclasses.fields(form)[0].name}`' if len(forms_of(schema)) > 1 else ''


def _without_none(kind: Any) -> Any:
    """The type of a value that is there."""
    if typing.get_origin(kind) not in (typing.Union, types.UnionType):
        return kind
    inner = [a for a in typing.get_args(kind) if a is not type(None)]
    return functools.reduce(operator.or_, inner)


def _words(kind: Any) -> str:
    origin, arguments = typing.get_origin(kind), typing.get_args(kind)
    if origin is typing.Literal:
        return 'choice'
    if origin in (typing.Union, types.UnionType):
        return ' or '.join(map(_words, arguments))
    if origin is tuple:
        count = 'list of' if arguments[-1] is Ellipsis else str(len(arguments))
        return f'{count} {_plural(_words(arguments[0]))}'
    return WORDS.get(kind, 'section')


def _plural(words: str) -> str:
    plurals = {'3 numbers': 'points', '2 numbers': 'pairs'}
    return plurals.get(words, words if words[0].isdigit() else f'{words}s')


def _schema(kind: Any, bounds: Any = None) -> dict[str, Any]:
    """A JSON schema of values of this type."""
    kind = _without_none(kind)
    origin, arguments = typing.get_origin(kind), typing.get_args(kind)
    if dataclasses.is_dataclass(kind):
        return _object(kind)
    if origin in (typing.Union, types.UnionType):
        return {'anyOf': [_schema(argument, bounds) for argument in arguments]}
    if origin is typing.Literal:
        return {'enum': list(arguments)}
    if origin is tuple:
        entries: dict[str, Any] = {'type': 'array', 'items': _schema(arguments[0], bounds)}
        count = len(arguments)
        return (
            entries
            if arguments[-1] is Ellipsis
            else {**entries, 'minItems': count, 'maxItems': count}
        )
    if kind in TYPES:
        ends = {'minimum': bounds[0], 'maximum': bounds[1]} if bounds else {}
        return {'type': TYPES[kind], **ends}
    return {'type': 'object'}


def _object(schema: Any) -> dict[str, Any]:
    hints, fields = typing.get_type_hints(schema), dataclasses.fields(schema)
    properties = {
        f.name: {
            'description': _description(Key(f.name, f, _without_none(hints[f.name]))),
            **_schema(hints[f.name], f.metadata.get('range')),
        }
        for f in fields
    }
    required = [f.name for f in fields if is_required(f)]
    return {
        'type': 'object',
        'properties': properties,
        'required': required,
        'additionalProperties': False,
    }


def _description(key: Key) -> str:
    parts = (key.unit, key.field.metadata['meaning'], key.range and f'({key.range})')
    return ' '.join(filter(None, parts))


def page(text: str) -> str:
    """The page with its generated part made anew."""
    return text.partition(GENERATED)[0] + GENERATED + '\n' + tables()


def schema_text() -> str:
    """The JSON schema as it is written."""
    return json.dumps(json_schema(), ensure_ascii=False, indent=1) + '\n'


if __name__ == '__main__':
    PAGE.write_text(page(PAGE.read_text()))
    SCHEMA.write_text(schema_text())
