"""What is installed, and what is said where it is missing, are the same."""

from pathlib import Path

from manipulator.requirements import INSTALL

ROOT = Path(__file__).resolve().parents[1]


def test_the_page_names_the_viser_that_the_installation_asks_for():
    text = (ROOT / 'setup.py').read_text()
    (asked,) = (words for words in text.split("'") if words.startswith('viser'))
    assert f"'{asked}'" in INSTALL['viser']
    for name in ('package.xml', 'docs/panel.md'):
        assert f"'{asked}'" in (ROOT / name).read_text()
