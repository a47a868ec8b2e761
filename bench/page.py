"""One table of all that was measured: as text for the terminal, as Markdown for docs/."""

from collections.abc import Sequence
from itertools import chain

from bench.row import Row
from bench.section import Section

HEAD = """\
# Performance

`make bench WRITE=docs/performance.md` generates this page from one run. To change it, repeat the
run. `make bench` alone prints the same table.

Times are medians of calls in alternation, so that other load on the computer affects all of them
alike. "× a 6×6 solve" is the time divided by that of one 6×6 `numpy.linalg.solve` in the same
alternation; "ours … = 0.50×" is our time divided by the other's: below 1, ours is faster. Missed
goals are marked MISSED.

"""


def table(computer: dict[str, str], sections: Sequence[Section]) -> str:
    """Columns name, value, goal, MISSED; sections under their titles."""
    every = [cells(row) for section in sections for row in section.rows]
    widths = [max(len(text) for text in column) for column in zip(*every, strict=True)]
    lines = [f'{name}: {value}' for name, value in computer.items()]
    for section in sections:
        lines += ['', f'{section.title}  ({section.name}, {section.seconds:.0f} s)']
        lines += [aligned(cells(row), widths) for row in section.rows]
    return '\n'.join([*lines, '', summary(sections)])


def cells(row: Row) -> tuple[str, str, str, str]:
    goal = f'goal {row.goal}' if row.goal else ''
    return row.name, row.value, goal, '' if row.reached else 'MISSED'


def aligned(texts: Sequence[str], widths: Sequence[int]) -> str:
    columns = (text.ljust(width) for text, width in zip(texts, widths, strict=True))
    return '  ' + '  '.join(columns).rstrip()


def summary(sections: Sequence[Section]) -> str:
    """How many goals there were, and which were missed."""
    rows = list(chain.from_iterable(section.rows for section in sections))
    goals = [row for row in rows if row.goal or not row.reached]
    missed = [row.name for row in goals if not row.reached]
    seconds = sum(section.seconds for section in sections)
    told = f'{len(rows)} figures in {seconds:.0f} s; of {len(goals)} goals {len(missed)} missed'
    return told + (f': {"; ".join(missed)}.' if missed else '.')


def page(computer: dict[str, str], sections: Sequence[Section]) -> str:
    """The same as a Markdown document."""
    lines = ['| | |', '|---|---|']
    lines += [f'| {name} | {escaped(value)} |' for name, value in computer.items()]
    lines += ['', escaped(summary(sections))]
    for section in sections:
        lines += ['', f'## {section.title}', '', f'`python -m bench {section.name}`', '']
        lines += ['| figure | measured | goal | |', '|---|---|---|---|']
        for row in section.rows:
            told = map(escaped, (row.name, row.value, row.goal, '' if row.reached else 'MISSED'))
            lines.append(f'| {" | ".join(told)} |')
    return HEAD + '\n'.join(lines) + '\n'


def escaped(text: str) -> str:
    """A value on one line, with no bar that would end its cell."""
    return ' '.join(text.split()).replace('|', '\\|')
