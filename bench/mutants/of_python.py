"""Small changes of a module's source, each at one place, for `bench.mutants`.

Found by `ast`, made in the text: a comparison flipped or its end moved, a number or truth value
changed, an arithmetic or boolean operator swapped, a `not` or minus dropped, a statement left out.
"""

import ast
import re
from collections.abc import Iterator

from bench.mutants.mutation import Mutation

COMPARISONS: dict[type, tuple[str, tuple[str, ...]]] = {
    ast.Lt: ('<', ('<=', '>=')),
    ast.LtE: ('<=', ('<', '>')),
    ast.Gt: ('>', ('>=', '<=')),
    ast.GtE: ('>=', ('>', '<')),
    ast.Eq: ('==', ('!=',)),
    ast.NotEq: ('!=', ('==',)),
    ast.Is: ('is', ('is not',)),
    ast.IsNot: ('is not', ('is',)),
    ast.In: ('in', ('not in',)),
    ast.NotIn: ('not in', ('in',)),
}
ARITHMETIC: dict[type, tuple[str, str]] = {
    ast.Add: ('+', '-'),
    ast.Sub: ('-', '+'),
    ast.Mult: ('*', '/'),
    ast.Div: ('/', '*'),
    ast.FloorDiv: ('//', '*'),
    ast.Mod: ('%', '*'),
    ast.Pow: ('**', '*'),
    ast.BitAnd: ('&', '|'),
    ast.BitOr: ('|', '&'),
    ast.LShift: ('<<', '>>'),
    ast.RShift: ('>>', '<<'),
}
UNTOUCHED = (ast.JoinedStr, ast.Import, ast.ImportFrom)
"""Words of messages are not worth a test; annotations and docstrings are left alone, too."""


def mutations(source: bytes) -> list[Mutation]:
    """All of a module, in its order; each parses, and is another program."""
    tree, found = ast.parse(source), []
    original = ast.dump(tree)
    for mutation in _Finder(source).of(tree):
        try:
            mutant = ast.parse(mutation.applied(source))
        except SyntaxError:
            continue
        if ast.dump(mutant) != original:
            found.append(mutation)
    return sorted(found, key=lambda m: (m.start, m.after))


class _Finder:
    """Walks a tree; the places are offsets in the source's bytes, as `ast` counts columns."""

    def __init__(self, source: bytes) -> None:
        self._source = source
        lines = source.splitlines(keepends=True)
        self._offsets = [0]
        for line in lines:
            self._offsets.append(self._offsets[-1] + len(line))

    def of(self, node: ast.AST, statement: int = 1) -> Iterator[Mutation]:
        if isinstance(node, UNTOUCHED):
            return
        statement = node.lineno if isinstance(node, ast.stmt) else statement
        for start, end, after in self._changes(node):
            before = self._source[start:end].decode()
            line = self._source.count(b'\n', 0, start) + 1
            yield Mutation(start, end, before, after, line, statement)
        for name, value in ast.iter_fields(node):
            if name in ('annotation', 'returns', 'decorator_list'):
                continue
            for child in value if isinstance(value, list) else [value]:
                if isinstance(child, ast.AST):
                    yield from self.of(child, statement)

    def _changes(self, node: ast.AST) -> Iterator[tuple[int, int, str]]:
        match node:
            case ast.Compare():
                operands = [node.left, *node.comparators]
                for k, operator in enumerate(node.ops):
                    word, others = COMPARISONS[type(operator)]
                    yield from self._between(operands[k], operands[k + 1], word, others)
            case ast.BinOp() if type(node.op) in ARITHMETIC:
                word, other = ARITHMETIC[type(node.op)]
                yield from self._between(node.left, node.right, word, (other,))
            case ast.BoolOp():
                word, other = ('and', 'or') if isinstance(node.op, ast.And) else ('or', 'and')
                for left, right in zip(node.values, node.values[1:], strict=False):
                    yield from self._between(left, right, word, (other,))
            case ast.UnaryOp(op=ast.Not() | ast.USub()):
                start = self._start(node)
                yield start, start + (3 if isinstance(node.op, ast.Not) else 1), ''
            case ast.Constant(value=bool() | int() | float()):
                yield self._start(node), self._end(node), _other_number(node.value)
            case ast.Expr(value=ast.Call()) | ast.Raise() | ast.AugAssign():
                yield self._start(node), self._end(node), 'pass'
            case ast.Assign(targets=[ast.Attribute() | ast.Subscript()]):
                yield self._start(node), self._end(node), 'pass'

    def _between(
        self, left: ast.expr, right: ast.expr, word: str, others: tuple[str, ...]
    ) -> Iterator[tuple[int, int, str]]:
        begin, end = self._end(left), self._start(right)
        pattern = re.escape(word).replace(r'\ ', r'\s+').encode()
        place = re.search(pattern, self._source[begin:end])
        if place is not None:
            for other in others:
                yield begin + place.start(), begin + place.end(), other

    def _start(self, node: ast.stmt | ast.expr) -> int:
        return self._offsets[node.lineno - 1] + node.col_offset

    def _end(self, node: ast.stmt | ast.expr) -> int:
        assert node.end_lineno is not None and node.end_col_offset is not None
        return self._offsets[node.end_lineno - 1] + node.end_col_offset


def _other_number(value: bool | int | float) -> str:
    if isinstance(value, bool):
        return str(not value)
    return repr(value + 1)
