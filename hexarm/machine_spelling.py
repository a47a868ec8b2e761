"""Misspelt keys of a machine file: named, and read as they were meant, to check the rest.

Of the check alone: what drives a machine takes no key for another.
"""

import dataclasses
import typing
from collections.abc import Mapping
from typing import Any

from manipulator.config import fitting_form, forms_of, unknown_key


def corrected(schema: Any, content: object, where: str, problems: list[str]) -> Any:
    """The content with each misspelt key under its right name; `problems` gets a line for each.

    A key whose right name is there as well, or that is like none, stays as it is.
    """
    if isinstance(content, list):
        kinds = [form for form in forms_of(schema) if typing.get_origin(form) is tuple]
        inner = typing.get_args(kinds[0])[0] if kinds else None
        return [corrected(inner, v, f'{where}[{i}]', problems) for i, v in enumerate(content)]
    forms = [form for form in forms_of(schema) if dataclasses.is_dataclass(form)]
    form = fitting_form(forms, content) if forms and isinstance(content, Mapping) else None
    if form is None or not isinstance(content, Mapping):
        return content
    hints, fields = typing.get_type_hints(form), [f.name for f in dataclasses.fields(form)]
    result: dict[Any, Any] = {}
    for name, value in content.items():
        right, problem = name, ''
        if name not in fields:
            near, problem = unknown_key(where, name, fields)
            right = near if near and near not in content and near not in result else name
        if right != name:
            problems.append(problem)
        place = f'{where}.{right}' if where else str(right)
        result[right] = corrected(hints.get(right), value, place, problems)
    return result
