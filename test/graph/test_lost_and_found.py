"""A machine whose computer sleeps for longer than the middleware keeps it in mind."""

import os
import signal
from dataclasses import replace
from pathlib import Path

import pytest

import hexarm
from hexarm.graph import Graph, check_alive, machine_graph
from manipulator.pose import Pose
from patient_user import PatientUser

pytestmark = pytest.mark.graph

LOOPBACK = Path(hexarm.__file__).with_name('fastdds_loopback.xml')
ELSEWHERE = Pose.from_xyz_rpy((-0.002, 0.0, 0.045))


@pytest.fixture
def short_lease(tmp_path):
    """The environment in which others forget a process after 1 s of silence, not after 20."""
    path = tmp_path / 'short.xml'
    head, rest = LOOPBACK.read_text().split('<discovery_config>')
    lease = '<leaseDuration><sec>1</sec></leaseDuration>'
    path.write_text(f'{head}<discovery_config>{lease}{rest}')
    return 'env', f'FASTRTPS_DEFAULT_PROFILES_FILE={path}'


def test_it_takes_goals_again_from_those_that_had_lost_it(patient_robocake, tmp_path, short_lease):
    *board, machine = machine_graph(patient_robocake, 'fake', tmp_path / 'board')
    with (
        Graph([*board, replace(machine, prefix=short_lease)], 'hexapod') as graph,
        PatientUser('hexapod', lambda: check_alive(graph)) as user,
    ):
        user.make_ready()
        user.reach_home()
        pid = graph.pids()['machine']
        os.kill(pid, signal.SIGSTOP)
        try:
            user.wait('its end', lambda: not user.node.count_subscribers('goal_pose'))
            user.spin(1.0)  # the middleware forgets one thing after the other
        finally:
            os.kill(pid, signal.SIGCONT)
        user.reach(ELSEWHERE)
