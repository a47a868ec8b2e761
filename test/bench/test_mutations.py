import pytest

from bench.mutations import mutations


def changes(text):
    source = text.encode()
    return {mutation.applied(source).decode() for mutation in mutations(source)}


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
    assert changes(text) == expected


def test_a_mutant_is_shown_by_its_line_and_knows_where_its_statement_begins():
    source = b'x = [\n    1,\n    a < b,\n]\nf(\n    2,\n)\n'
    shown = {(m.line, m.statement, *m.texts(source)) for m in mutations(source)}
    assert shown == {
        (2, 1, '1,', '2,'),
        (3, 1, 'a < b,', 'a <= b,'),
        (3, 1, 'a < b,', 'a >= b,'),
        (5, 5, 'f(', 'pass'),
        (6, 5, '2,', '3,'),
    }
