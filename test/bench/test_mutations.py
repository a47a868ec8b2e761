import pytest

from bench.mutants import of_c, of_python


def changes(language, text):
    source = text.encode()
    return {mutation.applied(source).decode() for mutation in language.mutations(source)}


@pytest.mark.parametrize(
    ('text', 'expected'),
    [
        ('a < b', {'a <= b', 'a >= b'}),
        ('a is not b', {'a is b'}),
        ('a not in b', {'a in b'}),
        ('(a < c) == b', {'(a <= c) == b', '(a >= c) == b', '(a < c) != b'}),
        ('a + (b * c)', {'a - (b * c)', 'a + (b / c)'}),
        ('a and b or c', {'a or b or c', 'a and b and c'}),
        ('a = not b', {'a =  b'}),
        ('b = -a', {'b = a'}),
        ('a = 0.1', {'a = 1.1'}),
        ('a = True', {'a = False'}),
        ('a.b = c', {'pass'}),
        ('a.b(c)', {'pass'}),
        ('a += b', {'pass'}),
        ('raise a', {'pass'}),
        ('ä = "é" if a > b else c', {'ä = "é" if a >= b else c', 'ä = "é" if a <= b else c'}),
        ('def f(a: x[1]) -> x[2]:\n    """1 < 2"""\n    return a', set()),
        ("a = f'{b + 1}'", set()),
    ],
)
def test_each_place_is_changed_by_itself(text, expected):
    assert changes(of_python, text) == expected


@pytest.mark.parametrize(
    ('text', 'expected'),
    [
        ('return a <= b;', {'return a < b;', 'return a > b;'}),
        ('return a * b + *c;', {'return a / b + *c;', 'return a * b - *c;'}),
        (
            'return !a && b != c;',
            {'return a && b != c;', 'return !a || b != c;', 'return !a && b == c;'},
        ),
        ('#define LONGEST 0x0f', {'#define LONGEST 16'}),
        ('real x = 0.5f;', {'real x = 1.5f;'}),
        ('return x[2];', {'return x[3];'}),
        ('    f(a);', {'    ;'}),
        ('    a->b = c;', {'    ;'}),
        ('    a[i] += b;', {'    ;', '    a[i] -= b;'}),
        ('real x[3], *y, z[4][5];\n#include "2.h"\n/* 1 < 2 */ char *s = "1 < 2";', set()),
    ],
)
def test_each_place_of_a_c_file_is_changed_by_itself(text, expected):
    assert changes(of_c, text) == expected


def test_a_mutant_is_shown_by_its_line_and_knows_where_its_statement_begins():
    source = b'x = [\n    1,\n    a < b,\n]\nf(\n    2,\n)\n'
    shown = {(m.line, m.statement, *m.texts(source)) for m in of_python.mutations(source)}
    assert shown == {
        (2, 1, '1,', '2,'),
        (3, 1, 'a < b,', 'a <= b,'),
        (3, 1, 'a < b,', 'a >= b,'),
        (5, 5, 'f(', 'pass'),
        (6, 5, '2,', '3,'),
    }
