"""The graph of a stack of three sections: 18 joints on one fake board, and a user of it."""

import re
from pathlib import Path

import pytest

from hexarm.cli.up import check_alive
from hexarm.graph import Graph, machine_graph
from patient_user import PatientUser

SHIPPED = Path(__file__).resolve().parents[3] / 'config' / 'stack_6_6.yaml'


@pytest.fixture(scope='package')
def stack_graph(tmp_path_factory):
    """The stack's processes; its board waits longer than a busy test machine may stall."""
    folder = tmp_path_factory.mktemp('stack')
    patient = re.sub('setpoint_deadline_ms: .*', 'setpoint_deadline_ms: 1000', SHIPPED.read_text())
    (folder / 'stack.yaml').write_text(patient)
    with Graph(
        machine_graph(str(folder / 'stack.yaml'), 'fake', folder / 'board'), 'hexapod'
    ) as graph:
        yield graph


@pytest.fixture
def stack(stack_graph):
    """A user of the enabled stack."""
    with PatientUser('hexapod', lambda: check_alive(stack_graph)) as user:
        user.make_ready()
        yield user
