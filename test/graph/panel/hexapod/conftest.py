"""The hexapod's whole graph on a fake board, and its page, open twice."""

import pytest

from hexarm.graph import Graph, machine_graph
from hexarm.panel_process import panel_process

CIRCLE = {
    'cycle.amplitude': '[0.006, 0.006, 0.0, 0.0, 0.0, 0.0]',
    'cycle.phase': '[0.0, 1.5708, 0.0, 0.0, 0.0, 0.0]',
}
"""A cycle on which some servo is always on its way: nothing else would tell when it stops."""


@pytest.fixture(scope='module')
def panel(browser, patient_robocake):
    return panel_process(patient_robocake)


@pytest.fixture(scope='module')
def hexapod_graph(patient_robocake, panel, with_cycle, tmp_path_factory):
    """The hexapod's processes and its panel."""
    link = tmp_path_factory.mktemp('port') / 'board'
    nodes = with_cycle(machine_graph(patient_robocake, 'fake', link), CIRCLE)
    with Graph([*nodes, panel], 'hexapod') as graph:
        yield graph


@pytest.fixture(scope='module')
def two_pages(open_page, panel, user):
    """The hexapod's panel, open twice."""
    user.wait('the panel', lambda: 'hexapod/panel' in user.diagnostics, 30.0)
    return [open_page(panel) for _ in range(2)]


@pytest.fixture
def page(two_pages):
    return two_pages[0]


@pytest.fixture
def machine(user, two_pages, seen):
    """The hexapod as seen from outside; at home and able to move."""
    with seen(user) as hexapod:
        yield hexapod
    for page in two_pages:
        page.let_go()
