"""`hexarm reproduce`: the committed report is what a fresh run finds."""

from pathlib import Path

import pytest

from hexarm.board import build as firmware_build
from hexarm.cli import reproduce
from hexarm.cli.main import main
from hexarm.papers import crank_dynamics, pictures
from hexarm.papers.finding import from_json, rendered, to_json
from manipulator.errors import InvalidInput

DOCS = Path(__file__).parents[3] / 'docs'
LARGEST_PICTURE = 150_000


@pytest.fixture(scope='module')
def committed():
    return from_json((DOCS / 'reproduction.json').read_text())


@pytest.fixture(scope='module')
def fresh():
    simulated = crank_dynamics.reproduced().findings
    found = reproduce.computed(True, lambda stage, share: None, simulated)
    return {finding.key: finding for finding in found}


def test_a_fresh_run_finds_the_committed_values(committed, fresh):
    """Fewer samples than the committed run; what takes a minute, or a chip, may be left out."""
    missing = {finding.key for finding in committed} - set(fresh)
    assert missing <= {'volume_turned', 'step_time', 'sine_time'}
    assert 'step_time' in fresh or firmware_build.missing_tools()
    for finding in committed:
        if finding.key in fresh:
            value = fresh[finding.key].value
            assert abs(value - finding.value) <= finding.tolerance, finding.key
            assert fresh[finding.key].verdict == finding.verdict


def test_no_finding_is_missing_from_the_committed_report(committed, fresh):
    keys = [finding.key for finding in committed]
    assert set(fresh) <= set(keys)
    assert len(set(keys)) == len(keys)


def test_the_report_is_made_of_the_committed_findings(committed):
    figures = [(f'figures/{name}', caption) for name, caption in pictures.NAMES.items()]
    assert (DOCS / 'reproduction.md').read_text() == rendered(committed, figures)


def test_figures_are_there_and_small():
    for name in pictures.NAMES:
        picture = (DOCS / 'figures' / name).read_bytes()
        assert picture.startswith(b'\x89PNG')
        assert len(picture) <= LARGEST_PICTURE


def test_findings_survive_json(committed):
    assert from_json(to_json(committed)) == committed
    with pytest.raises(InvalidInput, match='no findings'):
        from_json('[{"key": 1}]')


def test_a_report_of_another_kind_is_refused(capsys):
    assert main(['reproduce', '--output', 'report.txt']) == 1
    assert 'must end in .md' in capsys.readouterr().err
