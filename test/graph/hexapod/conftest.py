"""One hexapod's graph for all tests of this folder, and a user of it."""

import pytest

from hexarm.graph import Graph, check_alive, machine_graph
from patient_user import PatientUser


@pytest.fixture(scope='package')
def hexapod_graph(patient_robocake, tmp_path_factory):
    """The hexapod's processes with the fake board; not enabled."""
    link = tmp_path_factory.mktemp('port') / 'board'
    with Graph(machine_graph(patient_robocake, 'fake', link), 'hexapod') as graph:
        yield graph


@pytest.fixture(scope='package')
def user(hexapod_graph):
    """A user's node in the hexapod's namespace."""
    with PatientUser('hexapod', lambda: check_alive(hexapod_graph)) as client:
        yield client


@pytest.fixture
def enabled(user):
    """The same, with the servos on and the platform at home."""
    user.make_ready()
    return user
