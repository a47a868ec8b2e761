"""`hexarm enable`, `disable`, `clear`, `stop` as processes beside a running graph."""

import pytest
from std_msgs.msg import Bool

from bridge.stop_socket import domain_here, send_stop, stop_address
from manipulator.nodes.qos import EVERY_WORD

pytestmark = pytest.mark.graph


@pytest.fixture
def says(hexarm, user):
    """Runs `hexarm …` to its end: status and what it said."""
    return lambda *words: user.end_of(hexarm(*words))


def test_a_machine_is_enabled_stopped_cleared_and_disabled_without_ros2(user, says):
    def go():
        user.make_ready()
        user.disable()
        user.wait_for_state('disarmed')
        assert says('enable') == (0, '/hexapod: machine enabled, motion idle\n')
        status, text = says('stop', 'hexapod')
        assert status == 0
        assert text.startswith('/hexapod: machine stopped')
        assert text.endswith('hexarm clear hexapod\n')
        user.wait_for_state('stopped')
        status, text = says('enable', '/hexapod')
        assert (status, text.count('\n')) == (2, 1)
        assert 'the board is stopped: clear the stop first' in text
        assert 'hexarm clear hexapod' in text
        status, text = says('clear')
        assert (status, text[:25]) == (0, '/hexapod: machine enabled')
        status, text = says('clear')
        assert status == 0
        assert text.endswith(' (nothing to clear: the machine is enabled)\n')
        status, text = says('disable')
        assert (status, text[:26]) == (0, '/hexapod: machine disarmed')
        user.wait_for_state('disarmed')

    user.persist(go)


def test_where_nobody_answers_namespace_and_domain_are_named_and_where_somebody_is(user, says):
    status, text = says('enable', 'hexapd')
    assert (status, text.count('\n')) == (1, 1)
    assert 'hexarm: no machine found in /hexapd on ROS domain ' in text
    assert text.endswith('There are machines in /hexapod\n')


def test_a_stop_from_the_same_computer_needs_no_ros(enabled):
    assert send_stop(stop_address('/hexapod/serial_bridge', domain_here()))
    enabled.wait_for_state('stopped')
    enabled.make_ready()


def test_a_stop_goes_out_over_ros_before_the_machine_has_reported_anything(user, hexarm):
    received = []
    listener = user.node.create_subscription(
        Bool, '/silent/emergency_stop', received.append, EVERY_WORD
    )
    process = hexarm('stop', 'silent')
    user.wait('the stop', lambda: received)
    assert received[0].data
    user.wait('the end', lambda: process.poll() is not None)
    user.node.destroy_subscription(listener)
    assert process.returncode == 1
    assert 'no machine found in /silent' in process.stdout.read()
