"""The schemas of a recording: every type with all that it is made of."""

import pytest
from rosbags.typesys import get_types_from_msg

from hexarm.recording.log_parser import SEPARATOR, UnknownType, mentioned, schema_text


def test_a_type_brings_what_it_is_made_of_once():
    parts = schema_text('visualization_msgs/msg/MarkerArray').split(f'\n{SEPARATOR}\nMSG: ')
    names = [part.split('\n')[0] for part in parts[1:]]
    assert names[0] == 'visualization_msgs/Marker'
    assert len(names) == len(set(names))
    assert {'std_msgs/Header', 'builtin_interfaces/Time', 'geometry_msgs/Quaternion'} < set(names)


@pytest.mark.parametrize('name', ['DiagnosticArray', 'DiagnosticStatus'])
def test_constants_and_comments_are_no_types(name):
    types = get_types_from_msg(
        schema_text(f'diagnostic_msgs/msg/{name}'), f'diagnostic_msgs/msg/{name}'
    )
    assert 'diagnostic_msgs/msg/KeyValue' in types


def test_arrays_bounds_and_own_types_are_understood():
    text = (
        'uint8 OK=0 # a/B c\nstring<=10 name\nfloat64[36] m\nPoint[<=3] p\n'
        'geometry_msgs/msg/Pose q\nstd_msgs/Header header\nwstring[] w\n'
    )
    assert mentioned(text, 'own') == ['own/Point', 'geometry_msgs/Pose', 'std_msgs/Header']


@pytest.mark.parametrize('name', ['nobody_msgs/msg/None', 'std_msgs/msg/Nothing'])
def test_unknown_types_are_named(name):
    with pytest.raises(UnknownType, match=name):
        schema_text(name)
