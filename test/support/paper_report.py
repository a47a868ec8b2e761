"""The committed report of the papers, read again and compared with a fresh one."""

import json

from hexarm.papers.finding import Claim, Finding, Missing, Table
from hexarm.papers.report import Report


def differences(committed, fresh):
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


def from_json(text):
    """What `to_json` wrote."""
    parts = json.loads(text)
    return Report(
        tuple(_read_finding(row) for row in parts['findings']),
        tuple(Missing(**row) for row in parts['missing']),
        tuple(_read_table(row) for row in parts['tables']),
    )


def _read_finding(row):
    claim = {**row['claim'], 'values': tuple(row['claim']['values'])}
    rest = {k: v for k, v in row.items() if k not in ('claim', 'values', 'verdict')}
    return Finding(**rest, claim=Claim(**claim), values=tuple(row['values']))


def _read_table(row):
    rows = tuple(tuple(r) for r in row['rows'])
    return Table(row['key'], row['title'], tuple(row['head']), rows, row['tolerance'])
