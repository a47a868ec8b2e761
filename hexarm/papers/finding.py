"""One figure of a paper beside ours, and the report that is made of such findings."""

import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Literal

from manipulator.errors import InvalidInput

ROTARY = 'Prokopovich 2019'
LINEAR = 'Lapikov et al. 2014'
ARM = 'Fadeev, Loginov'
HEAD = '| quantity | paper | ours | verdict | reason |'
Verdict = Literal['agrees', 'partly', 'contradicts', 'not stated']


@dataclass(frozen=True)
class Finding:
    """What `source` says of `topic`, and what we found: `ours` as it is shown, `value` to compare.

    A fresh run must give `value` again to within `tolerance`, both in the unit of `ours`.
    """

    key: str
    source: str
    topic: str
    paper: str
    ours: str
    value: float
    tolerance: float
    verdict: Verdict
    reason: str


def rendered(findings: Iterable[Finding], figures: Iterable[tuple[str, str]]) -> str:
    """The report as Markdown; figures are (file beside the report, caption)."""
    lines = [
        '# Reproduction of the papers',
        '',
        '`hexarm reproduce` generates this page; a test repeats the computation and compares. '
        'Each row shows the result of a paper and ours, with the reason for a difference. Masses '
        'and drives are those of `config/robocake.yaml`, many of them estimates '
        '([physics.md](physics.md)).',
        '',
    ]
    groups: dict[str, list[Finding]] = {}
    for finding in findings:
        groups.setdefault(finding.source, []).append(finding)
    for source, members in groups.items():
        lines += [f'## {source}', '', HEAD, '|' + '---|' * 5]
        lines += [
            f'| {f.topic} | {f.paper} | {f.ours} | {f.verdict} | {f.reason} |' for f in members
        ]
        lines.append('')
    lines.append('## Figures')
    for path, caption in figures:
        lines += ['', f'![{caption}]({path})', '', f'*{caption}*']
    return '\n'.join(lines) + '\n'


def to_json(findings: Iterable[Finding]) -> str:
    """The findings for programs, one a line."""
    rows = (json.dumps(asdict(f), ensure_ascii=False) for f in findings)
    return '[\n' + ',\n'.join(rows) + '\n]\n'


def from_json(text: str) -> list[Finding]:
    """What `to_json` wrote; InvalidInput for anything else."""
    try:
        return [Finding(**row) for row in json.loads(text)]
    except (ValueError, TypeError) as error:
        raise InvalidInput(f'these are no findings: {error}') from error
