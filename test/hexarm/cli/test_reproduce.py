"""`hexarm reproduce`: the committed report is what a fresh run finds."""

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from paper_report import differences, from_json

from hexarm.board import build as firmware_build
from hexarm.cli.main import main
from hexarm.papers import pictures
from hexarm.papers.finding import ARM, Missing
from hexarm.papers.report import Report, rendered, to_json
from hexarm.papers.reproduction import PARTS, reproduced

DOCS = Path(__file__).parents[3] / 'docs'
LARGEST_PICTURE = 150_000
SLOW = 'noise_moving_'
"""Rows that only THOROUGH=1 computes again: half a minute."""
IS_THOROUGH = os.environ.get('THOROUGH') == '1'
ON_CHIP = (
    'step_c167',
    'step_mf167',
    'sine_c167',
    'sine_mf167',
    'time_geometric',
    'time_algebraic',
)


@pytest.fixture(scope='module')
def committed():
    return from_json((DOCS / 'reproduction.json').read_text())


@pytest.fixture(scope='module')
def fresh():
    return reproduced(not IS_THOROUGH, lambda stage, share: None).report


def without(report, left_out):
    return replace(report, findings=tuple(f for f in report.findings if not left_out(f.key)))


@pytest.mark.long
def test_a_fresh_run_finds_the_committed_values(committed, fresh):
    """Each within its own tolerance, each verdict; without a compiler, all but the chip's rows."""
    is_without_chip = bool(firmware_build.missing_tools())

    def is_left_out(key):
        return (key.startswith(SLOW) and not IS_THOROUGH) or (is_without_chip and key in ON_CHIP)

    assert list(differences(without(committed, is_left_out), fresh)) == []
    assert [m.topic for m in fresh.missing] == ['times on a controller'] * is_without_chip


def test_the_committed_report_is_complete_and_rendered_from_its_findings(committed):
    assert committed.missing == ()
    keys = [finding.key for finding in committed.findings]
    assert len(set(keys)) == len(keys)
    assert set(ON_CHIP) < set(keys)
    figures = [(f'figures/{name}', caption) for name, caption in pictures.NAMES.items()]
    assert (DOCS / 'reproduction.md').read_text() == rendered(committed, figures)


def test_every_verdict_and_every_value_matters_to_the_comparison(committed):
    """Each value moved by twice its tolerance is a difference, and so is a lost row."""
    for finding in committed.findings:
        values = (finding.values[0] + 2 * finding.tolerance, *finding.values[1:])
        changed = [replace(f, values=values) if f is finding else f for f in committed.findings]
        found = list(differences(committed, replace(committed, findings=tuple(changed))))
        assert found, finding.key
        assert all(finding.key in line for line in found)
    lost = replace(committed, findings=committed.findings[1:])
    assert list(differences(committed, lost)) == ['home_alike: not in the fresh run']
    assert list(differences(lost, committed)) == ['home_alike: not in the committed report']


def test_a_changed_table_is_a_difference(committed):
    table = committed.tables[0]
    rows = ((*table.rows[0][:-1], 1.01 * table.rows[0][-1]), *table.rows[1:])
    changed = replace(committed, tables=(replace(table, rows=rows),))
    assert len(list(differences(committed, changed))) == 1
    assert list(differences(committed, replace(committed, tables=()))) == ['the tables are others']


def test_figures_are_there_and_small():
    for name in pictures.NAMES:
        picture = (DOCS / 'figures' / name).read_bytes()
        assert picture.startswith(b'\x89PNG')
        assert len(picture) <= LARGEST_PICTURE


def test_a_report_survives_json(committed):
    report = replace(committed, missing=(Missing(ARM, 'times', 'no compiler'),))
    assert from_json(to_json(report)) == report


@pytest.mark.long
def test_a_part_that_this_installation_lacks_is_said_to_be_missing(tmp_path):
    """Without mujoco and without the sources: the other rows, and why these are not there.

    A None in sys.modules is how Python takes a module for missing.
    """
    output = tmp_path / 'new' / 'report.md'
    program = f"""
import sys
sys.modules['mujoco'] = None
from hexarm.board import build
build.missing_tools = lambda: ['the source tree of hexarm']
from hexarm.papers import reproduction
reproduction.PARTS = [p for p in reproduction.PARTS if p[1] != 'workspace']
from hexarm.cli.main import main
sys.exit(main(['reproduce', '--output', {str(output)!r}]))
"""
    words = [sys.executable, '-c', program]
    done = subprocess.run(words, capture_output=True, text=True, check=False, timeout=600)
    assert done.returncode == 0, done.stderr
    assert 'missing: Prokopovich 2019, moving model: mujoco is not installed' in done.stdout
    assert 'times on a controller: not there: the source tree of hexarm' in done.stdout
    written = from_json(output.with_suffix('.json').read_text())
    assert {f.key for f in written.findings} >= {'range_x', 'operating_torque', 'calls_whole'}
    assert '## Not computed here' in output.read_text()
    assert not (output.parent / 'figures' / 'fig-13.png').exists()
    assert (output.parent / 'figures' / 'fig-9.png').exists()


def test_without_an_output_nothing_of_the_source_tree_is_written(monkeypatch, tmp_path, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr('hexarm.papers.reproduction.PARTS', PARTS[:1])
    monkeypatch.setattr('hexarm.papers.pictures.NAMES', {})
    before = (DOCS / 'reproduction.md').stat().st_mtime_ns
    (tmp_path / 'docs').mkdir()
    (tmp_path / 'docs' / 'reproduction.md').write_text('theirs')
    assert main(['reproduce', '--quick']) == 0
    assert (tmp_path / 'reproduction' / 'reproduction.md').exists()
    assert (tmp_path / 'docs' / 'reproduction.md').read_text() == 'theirs'
    assert (DOCS / 'reproduction.md').stat().st_mtime_ns == before


def test_a_report_of_another_kind_is_refused(capsys):
    assert main(['reproduce', '--output', 'report.txt']) == 2
    assert 'must end in .md' in capsys.readouterr().err


def test_an_empty_report_can_be_rendered():
    assert rendered(Report(()), []).startswith('# Reproduction of the papers')
