"""The report that is made of findings: as Markdown for people, as JSON for programs."""

import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass

from hexarm.papers.finding import Finding, Missing, Table, minus

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


def _finding(f: Finding) -> str:
    return _row([f.topic, f.claim.text, f.ours, f.verdict, f.claim.rule(f.unit), f.reason])


def _row(cells: Iterable[str]) -> str:
    return f'| {" | ".join(cell.replace("|", "∣") for cell in cells)} |'
