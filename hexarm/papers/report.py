"""The report that is made of findings: as Markdown for people, as JSON for programs."""

import json
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from typing import Any

from hexarm.papers.finding import Claim, Finding, Missing, Table, minus
from manipulator.errors import InvalidInput

INTRODUCTION = (
    '# Reproduction of the papers',
    '',
    '`hexarm reproduce --output docs/reproduction.md` generates this page from a fresh run; '
    'a test repeats the computation and compares, each value within a tolerance of its own. Each '
    'row shows what a paper states and what we found. The verdict is computed: our value is '
    'compared with the number and the tolerance in the column *rule*. Rows without a number in '
    'the paper have the verdict *not stated*. Masses and drives are those of '
    '`config/robocake.yaml`, many of them estimates ([physics.md](physics.md)).',
    '',
)
HEAD = ('quantity', 'paper', 'ours', 'verdict', 'rule', 'reason')


@dataclass(frozen=True)
class Report:
    """All findings in the report's order, what could not be computed, and tables."""

    findings: tuple[Finding, ...]
    missing: tuple[Missing, ...] = ()
    tables: tuple[Table, ...] = ()


def rendered(report: Report, figures: Iterable[tuple[str, str]]) -> str:
    """The report as Markdown; figures are (file beside the report, caption)."""
    lines = [*INTRODUCTION]
    for source in dict.fromkeys(f.source for f in report.findings):
        lines += [f'## {source}', '', _row(HEAD), _row(['---'] * len(HEAD))]
        lines += [_finding(f) for f in report.findings if f.source == source]
        lines.append('')
    if report.missing:
        lines += ['## Not computed here', '']
        lines += [f'- {m.source}, {m.topic}: {m.why}' for m in report.missing]
        lines.append('')
    for table in report.tables:
        lines += [f'## {table.title}', '', _row(table.head), _row(['---'] * len(table.head))]
        lines += [_row([minus(f'{v:.4g}') for v in row]) for row in table.rows]
        lines.append('')
    lines.append('## Figures')
    for path, caption in figures:
        lines += ['', f'![{caption}]({path})', '', f'*{caption}*']
    return '\n'.join(lines) + '\n'


def differences(committed: Report, fresh: Report) -> Iterator[str]:
    """Where a fresh run differs from a committed one by more than the committed tolerances."""
    found = {finding.key: finding for finding in fresh.findings}
    for finding in committed.findings:
        other = found.pop(finding.key, None)
        if other is None:
            yield f'{finding.key}: not in the fresh run'
            continue
        if other.claim != finding.claim or other.verdict != finding.verdict:
            yield f'{finding.key}: {finding.verdict}, now {other.verdict} of {other.claim}'
        pairs = list(zip(finding.values, other.values, strict=True))
        if any(not abs(a - b) <= finding.tolerance for a, b in pairs):
            yield f'{finding.key}: {finding.values}, now {other.values} ± {finding.tolerance:g}'
    yield from (f'{key}: not in the committed report' for key in found)
    if [t.key for t in committed.tables] != [t.key for t in fresh.tables]:
        yield 'the tables are others'
    for table, now in zip(committed.tables, fresh.tables, strict=False):
        for row, again in zip(table.rows, now.rows, strict=True):
            if any(abs(a - b) > table.tolerance * abs(a) for a, b in zip(row, again, strict=True)):
                yield f'{table.key}: {row}, now {again}'


def to_json(report: Report) -> str:
    """For programs, a finding a line."""
    findings = [{**asdict(f), 'verdict': f.verdict} for f in report.findings]
    parts = {
        'findings': findings,
        'missing': [asdict(m) for m in report.missing],
        'tables': [asdict(t) for t in report.tables],
    }
    blocks = []
    for name, items in parts.items():
        rows = ',\n'.join(json.dumps(item, ensure_ascii=False) for item in items)
        blocks.append(f'"{name}": [\n{rows}\n]')
    return '{' + ',\n'.join(blocks) + '}\n'


def from_json(text: str) -> Report:
    """What `to_json` wrote; InvalidInput for anything else."""
    try:
        parts = json.loads(text)
        return Report(
            tuple(_read_finding(row) for row in parts['findings']),
            tuple(Missing(**row) for row in parts['missing']),
            tuple(_read_table(row) for row in parts['tables']),
        )
    except (ValueError, TypeError, KeyError) as error:
        raise InvalidInput(f'this is no report: {error}') from error


def _read_finding(row: dict[str, Any]) -> Finding:
    claim = {**row['claim'], 'values': tuple(row['claim']['values'])}
    rest = {k: v for k, v in row.items() if k not in ('claim', 'values', 'verdict')}
    return Finding(**rest, claim=Claim(**claim), values=tuple(row['values']))


def _read_table(row: dict[str, Any]) -> Table:
    rows = tuple(tuple(r) for r in row['rows'])
    return Table(row['key'], row['title'], tuple(row['head']), rows, row['tolerance'])


def _finding(f: Finding) -> str:
    return _row([f.topic, f.claim.text, f.ours, f.verdict, f.claim.rule(f.unit), f.reason])


def _row(cells: Iterable[str]) -> str:
    return f'| {" | ".join(cell.replace("|", "∣") for cell in cells)} |'
