"""`hexarm go`, `home`, `park`, `pose`, `joints` as processes beside a running graph."""

import json

import pytest

pytestmark = pytest.mark.graph


@pytest.fixture
def says(hexarm, enabled):
    """Runs `hexarm …` to its end: status and what it said; again where the machine was lost."""

    def says(*words, status=0):
        def once():
            ended, text = enabled.end_of(hexarm(*words))
            assert ended == status, text
            return text

        return enabled.persist(once)

    return says


def numbers(line, unit):
    *_, name = line.split()
    assert name == unit
    return [float(word) for word in line.split()[-4:-1]]


def arrives(go, unit, position, within):
    """What it prints; again until the measured pose is there: the board may be behind."""
    for _ in range(5):
        lines = go().splitlines()
        if numbers(lines[0], unit) == pytest.approx(position, abs=within):
            return lines
    raise AssertionError(lines)


def test_a_machine_is_moved_and_measured_from_the_command_line(says, enabled):
    def go():
        words = ('go', 'hexapod', '--xyz', '0.002', '0', '0.045', '--rpy', '0', '0', '0.05')
        _, turns = arrives(lambda: says(*words), 'm', [0.002, 0, 0.045], 5e-4)
        assert numbers(turns, 'rad') == pytest.approx([0, 0, 0.05], abs=0.01)
        words = ('go', '--xyz', '0', '-2', '44', '--units', 'mm')
        _, turns = arrives(lambda: says(*words), 'mm', [0, -2, 44], 0.5)
        assert numbers(turns, '°')[2] == pytest.approx(2.86, abs=0.5)
        measured = json.loads(says('pose', '/hexapod', '--json'))
        assert measured['pose']['xyz'] == pytest.approx([0, -0.002, 0.044], abs=5e-4)
        says('home')
        joints = json.loads(says('joints', '--json'))['joints']
        assert joints['names'] == [f'crank_{leg}' for leg in range(1, 7)]
        assert joints['positions'] == pytest.approx([2.0945] * 6, abs=0.01)
        assert 'x, y, z' in says('park')

    enabled.persist(go)


def test_state_and_reports_are_there_for_programs(says, enabled):
    def reports():
        answer = json.loads(says('enable', '--json'))
        assert (answer['namespace'], answer['state']) == ('/hexapod', 'enabled')
        for _ in range(10):  # it listens for 1.5 s only
            monitored = json.loads(says('monitor', '--json'))
            if 'trajectory' in monitored['nodes']:
                break
        assert monitored['state'] == 'enabled'
        assert monitored['nodes']['trajectory']['values']['result']

    enabled.persist(reports)


def test_out_of_reach_is_status_3_and_what_is_not_understood_2(says, enabled):
    def go():
        said = says('go', '--xyz', '0.04', '0', '0.045', status=3)
        assert 'rod too short' in said, said
        error = json.loads(says('go', '--rpy', '0', '0', '45', '--json', status=2))['error']
        assert 'are these degrees?' in error, error

    enabled.persist(go)
    assert 'go where?' in says('go', status=2)


def test_poses_are_saved_by_name_gone_to_replayed_and_deleted(says, enabled):
    def go():
        says('go', '--xyz', '0.002', '0', '0.045', '--rpy', '0', '0', '0.05')
        assert 'saved right' in says('save', 'hexapod', 'right')
        says('go', '--xyz', '-0.002', '0', '0.045')
        name = json.loads(says('save', '--json'))['name']
        assert name.startswith('pose_')
        arrives(lambda: says('go', 'hexapod', 'right'), 'm', [0.002, 0, 0.045], 5e-4)
        words = ('replay', 'hexapod', 'right', name, '--repeat', '2', '--speed', '0.05', '--json')
        ends = (json.loads(says(*words).splitlines()[-1])['pose']['xyz'] for _ in range(5))
        there = pytest.approx([-0.002, 0, 0.045], abs=5e-4)
        assert any(end == there for end in ends)  # the board may be behind
        assert 'no saved pose is called' in says('go', 'hexapod', 'rihgt', status=2)
        says('delete', 'hexapod', name)
        kept = json.loads(says('poses', '--json'))['poses']
        assert ('right' in kept, name in kept) == (True, False)
        refused = says('delete', 'hexapod', name, status=2)
        assert f"hexarm: no saved pose is called '{name}'" in refused

    enabled.persist(go)
