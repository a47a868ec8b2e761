from hexarm.recording.topics import missing_topics, nothing_recorded

THERE = ['/hexapod/pose', '/hexapod/joint_states', '/hexapod/machine_state', '/rosout']


def test_misspelt_topic_is_distinguished_from_one_that_is_silent():
    asked = ['/hexapod/poes', '/hexapod/joint_states', '/hexapod/pose', '/zzz']
    assert missing_topics(asked, received={'/hexapod/pose'}, there=THERE) == [
        '/hexapod/joint_states exists, but nothing was published on it',
        'there is no topic /hexapod/poes, did you mean /hexapod/pose?',
        'there is no topic /zzz',
    ]


def test_namespace_without_topics_is_reported_with_domain_and_the_machines_that_there_are():
    assert nothing_recorded('arm', [], ['/rosout'], 7) == (
        'no machine found in /arm on ROS domain 7: is it running there?'
    )
    assert nothing_recorded('hexa', [], THERE, 7).endswith('there? There are machines in /hexapod')


def test_machine_that_is_there_is_not_blamed():
    lines = ['there is no topic /hexapod/poes']
    assert nothing_recorded('hexapod', lines, THERE, 7) == lines[0]
    assert nothing_recorded('hexapod', [], THERE, 7) == 'nothing was published in /hexapod'
