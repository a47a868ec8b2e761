"""Small changes of a C file, each at one place, for `bench.mutants`.

Found in the text, which clang-format's spaces make regular: a comparison flipped or its end moved,
a number changed, an arithmetic or logical operator swapped, a `!` dropped, a call or an assignment
left out. Comments, texts, includes and the lengths of arrays are left alone. A change that does
not compile, or compiles to the same, is for `bench.mutants` to find.
"""

import re
from collections.abc import Iterator

from bench.mutants.mutation import Mutation

SWAPPED = {
    '<': ('<=', '>='),
    '<=': ('<', '>'),
    '>': ('>=', '<='),
    '>=': ('>', '<'),
    '==': ('!=',),
    '!=': ('==',),
    '&&': ('||',),
    '||': ('&&',),
    '+': ('-',),
    '-': ('+',),
    '*': ('/',),
    '/': ('*',),
    '&': ('|',),
    '|': ('&',),
    '+=': ('-=',),
    '-=': ('+=',),
}
COMMENT = re.compile(rb'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', re.DOTALL)
DIRECTIVE = re.compile(rb'^[ \t]*#[ \t]*(?!define)[^\n]*', re.MULTILINE)
OPERATOR = re.compile(rb'(?<=[\w)\]] )(?:[<>=!]=|&&|\|\||[-+]=|[-+*/<>&|])(?=\s)')
NUMBER = re.compile(rb'(?<![\w.])(?:0x[0-9a-fA-F]+|\d+\.?\d*(?:e[-+]?\d+)?)(?=[uUlLf]*\b)(?!\.)')
NOT = re.compile(rb'!(?=[\w(])')
STATEMENT = re.compile(
    rb'^[ \t]+(\w+\([^;{}]*\)|[*\w]+(?:->|\.|\[)[^;{}]*? [-+|&*/]?= [^;{}]*);$', re.MULTILINE
)
TYPE = rb'(?:(?:static|const) )*(?:real|float|double|int|char|bool|u?int\d+_t|struct \w+|[A-Z]\w+)'
DECLARED = re.compile(
    rb'(?:^|[(,;{]) *' + TYPE + rb' [^=;()]*(?:\(\*\w+\)(?:\[[^\]]*\])*)?\[[^\]]*$'
)


def mutations(source: bytes) -> list[Mutation]:
    """All of a file, in its order."""
    code = source
    for left_out in (COMMENT, DIRECTIVE):
        code = left_out.sub(lambda found: re.sub(rb'[^\n]', b' ', found.group()), code)
    found = [_mutation(source, *change) for change in _changes(code)]
    return sorted(found, key=lambda m: (m.start, m.after))


def _changes(code: bytes) -> Iterator[tuple[int, int, str]]:
    for match in OPERATOR.finditer(code):
        for other in () if _is_length(code, match.start()) else SWAPPED[match.group().decode()]:
            yield *match.span(), other
    for match in NUMBER.finditer(code):
        if not _is_length(code, match.start()):
            yield *match.span(), _other_number(match.group().decode())
    for match in NOT.finditer(code):
        yield *match.span(), ''
    for match in STATEMENT.finditer(code):
        yield *match.span(1), ''


def _is_length(code: bytes, place: int) -> bool:
    """Whether a number is how many elements a declared array has."""
    return bool(DECLARED.search(code[code.rfind(b'\n', 0, place) + 1 : place]))


def _mutation(source: bytes, start: int, end: int, after: str) -> Mutation:
    line = source.count(b'\n', 0, start) + 1
    return Mutation(start, end, source[start:end].decode(), after, line, line)


def _other_number(text: str) -> str:
    if text.isdigit() or text.startswith('0x'):
        return str(int(text, 0) + 1)
    return repr(float(text) + 1)
