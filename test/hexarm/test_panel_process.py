"""The panel beside a machine's graph: which port, and what is said where viser is missing."""

import importlib.util
import socket

import pytest

from hexarm.cli.main import main
from hexarm.panel_process import offered_panel, panel_address, panel_process


@pytest.fixture
def without_viser(monkeypatch):
    find = importlib.util.find_spec
    monkeypatch.setattr(
        importlib.util, 'find_spec', lambda name: None if name == 'viser' else find(name)
    )


def test_a_port_that_is_taken_is_passed_over(monkeypatch):
    with socket.socket() as taken:
        taken.bind(('127.0.0.1', 0))
        taken.listen()
        first = taken.getsockname()[1]
        monkeypatch.setattr('hexarm.panel_process.FIRST_PORT', first)
        panel = panel_process('robocake')
    assert int(panel.parameters['port']) > first
    assert panel_address(panel) == f'http://127.0.0.1:{panel.parameters["port"]}'


def test_without_viser_the_demo_goes_on_and_reports_what_is_missing(without_viser):
    text = []
    assert offered_panel('robocake', text.append) == []
    assert 'pip install viser' in text[0]


def test_without_viser_up_reports_what_to_install_before_anything_starts(without_viser, capsys):
    assert main(['up', 'hexapod', '--panel']) == 1
    assert 'hexarm: needs the Python module viser: ' in capsys.readouterr().err
