"""`hexarm enable`, `disable`, `clear`, `stop` as processes beside a running graph."""

import pytest

pytestmark = pytest.mark.graph


@pytest.fixture
def says(hexarm):
    """Runs `hexarm …` to its end: status and what it said."""

    def run(*words):
        process = hexarm(*words)
        said, _ = process.communicate(timeout=60)
        return process.returncode, said

    return run


def test_a_machine_is_enabled_stopped_cleared_and_disabled_without_ros2(user, says):
    assert says('enable') == (0, '/hexapod: machine enabled, motion idle\n')
    status, said = says('stop', 'hexapod')
    assert status == 0
    assert said.startswith('/hexapod: machine stopped')
    assert said.endswith('hexarm clear hexapod\n')
    user.wait('the stop', lambda: user.machine_state.message == 'stopped', 10.0)
    status, said = says('enable', '/hexapod')
    assert (status, said.count('\n')) == (2, 1)
    assert 'the board is stopped: clear the stop first' in said
    assert 'hexarm clear hexapod' in said
    status, said = says('clear')
    assert (status, said[:25]) == (0, '/hexapod: machine enabled')
    status, said = says('disable')
    assert (status, said[:26]) == (0, '/hexapod: machine disarmed')
    user.wait('the end', lambda: user.machine_state.message == 'disarmed', 10.0)


def test_where_nobody_answers_namespace_and_domain_are_named_and_where_somebody_is(user, says):
    status, said = says('enable', 'hexapd')
    assert (status, said.count('\n')) == (1, 1)
    assert 'hexarm: nobody answers in /hexapd on ROS domain ' in said
    assert said.endswith('there are machines in /hexapod\n')
