"""A board that is stopped stays so for the next bridge; `hexarm up` waits for the clear."""

import pytest
from std_msgs.msg import Bool

from hexarm.graph import Executable, Graph
from manipulator.nodes.qos import EVERY_WORD
from patient_user import WITHOUT_BOARD, PatientUser

pytestmark = pytest.mark.graph

SPACE = 'stop_before_up'


def stop_by_a_bridge_that_ends(port):
    """The board obeys a STOP of a bridge that is no more when this returns."""
    parameters = {'machine': 'robocake', 'port': str(port)}
    bridge = Executable('serial_bridge', parameters, needs=port)
    with Graph([bridge], 'before'), PatientUser('before') as user:
        stops = user.node.create_publisher(Bool, 'emergency_stop', EVERY_WORD)
        user.wait('the bridge', lambda: stops.get_subscription_count() == 1)
        user.wait('the board', lambda: user.machine_state.message not in WITHOUT_BOARD)
        stops.publish(Bool(data=True))
        user.wait_for_state('stopped')


def cleared(hexarm, port):
    """A `hexarm up` that waited for the clear; None where the board was lost behind it."""
    stop_by_a_bridge_that_ends(port)
    process = hexarm('up', 'hexapod', '--port', str(port), '--namespace', SPACE)
    if not any('clear_fault std_srvs' in line for line in process.stdout):
        return None
    with PatientUser(SPACE) as user:
        user.wait('a clear', lambda: user.accepts('serial_bridge/clear_fault'))
    return process if any('and enabled' in line for line in process.stdout) else None


def test_up_waits_until_a_stop_from_before_is_cleared(hexarm, ends_parked, tmp_path):
    port = tmp_path / 'board'
    fake = {'machine': 'robocake', 'link': str(port)}
    with Graph([Executable('fake_hardware', fake)], SPACE):
        process = next(filter(None, (cleared(hexarm, port) for _ in range(5))))
        ends_parked(process)
