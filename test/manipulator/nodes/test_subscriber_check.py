from manipulator.nodes.graph_check import PATIENCE, SubscriberCheck

HEXAPOD = '/hexapod on ROS domain 7'


def test_nobody_is_reported_once_and_only_after_the_time_that_discovery_takes():
    check = SubscriberCheck(HEXAPOD, 10.0)
    assert check.update(False, 10.0 + 0.9 * PATIENCE) == ''
    text = check.update(False, 10.0 + PATIENCE)
    assert text == f'no machine subscribes in {HEXAPOD}: is it started there?'
    assert check.update(False, 20.0) == ''


def test_somebody_is_reported_at_once_and_a_loss_after_a_while():
    check = SubscriberCheck(HEXAPOD, 10.0)
    assert check.update(True, 10.1) == f'a machine subscribes in {HEXAPOD}'
    assert check.update(True, 30.0) == ''
    assert check.update(False, 30.5) == ''
    assert check.update(True, 31.0) == ''
    assert check.update(False, 31.0 + PATIENCE).startswith('no machine subscribes')
    assert check.update(True, 60.0).startswith('a machine subscribes')


def test_outside_of_every_namespace_the_option_is_reported():
    text = SubscriberCheck('/ on ROS domain 0', 0.0).update(False, PATIENCE)
    assert text.endswith('-r __ns:=/hexapod')
