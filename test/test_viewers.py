"""The layouts for RViz and Foxglove: they can be read, and name only what there is."""

import json
import re
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[1]
FOXGLOVE = sorted((ROOT / 'viewers').glob('*.json'))
RVIZ = sorted((ROOT / 'viewers').glob('*.rviz'))
TYPES = {
    'MarkerArray': 'visualization_msgs/msg/MarkerArray',
    'Pose': 'geometry_msgs/msg/PoseStamped',
    'Path': 'nav_msgs/msg/Path',
}
FRAME = 'base'


def documented():
    """{name: type} of every topic and service of docs/interfaces.md."""
    text = (ROOT / 'docs' / 'interfaces.md').read_text()
    row = r'^\| `([\w/]+)` \| (?:in|out|service) \| (\S+) \|'
    return dict(re.findall(row, text, re.MULTILINE))


def machine_of(path):
    return path.stem.removeprefix('foxglove_')


def strings(value):
    """Every key and value of nested dicts and lists that is text."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, list):
        for entry in value:
            yield from strings(entry)
    elif isinstance(value, dict):
        for key, entry in value.items():
            yield from (key, *strings(entry))


def displays(path):
    return yaml.safe_load(path.read_text())['Visualization Manager']['Displays']


def test_there_is_one_of_each_for_both_kinds():
    assert [machine_of(p) for p in FOXGLOVE] == [machine_of(p) for p in RVIZ] == ['arm', 'hexapod']


@pytest.mark.parametrize('path', FOXGLOVE + RVIZ, ids=lambda path: path.name)
def test_every_topic_and_service_is_of_the_document(path):
    text = path.read_text()
    content = json.loads(text) if path.suffix == '.json' else yaml.safe_load(text)
    names = {re.split(r'[.\[]', word)[0] for word in strings(content) if word.startswith('/')}
    space = f'/{machine_of(path)}/'
    assert f'{space}markers' in names
    for name in names - {'/diagnostics'}:
        assert name.startswith(space), name
        assert name.removeprefix(space) in documented(), name


@pytest.mark.parametrize('path', FOXGLOVE, ids=lambda path: path.name)
def test_every_panel_is_placed_once(path):
    content = json.loads(path.read_text())

    def panels(node):
        if isinstance(node, str):
            return [node]
        assert node['direction'] in ('row', 'column')
        return panels(node['first']) + panels(node['second'])

    placed = panels(content['layout'])
    assert sorted(placed) == sorted(content['configById'])
    assert content['configById']['3D!machine']['followTf'] == FRAME


@pytest.mark.parametrize('path', RVIZ, ids=lambda path: path.name)
def test_displays_are_of_the_topics_types(path):
    options = yaml.safe_load(path.read_text())['Visualization Manager']['Global Options']
    assert options['Fixed Frame'] == FRAME
    for display in displays(path):
        kind = display['Class'].removeprefix('rviz_default_plugins/')
        if kind in TYPES:
            name = display['Topic']['Value'].removeprefix(f'/{machine_of(path)}/')
            assert documented()[name] == TYPES[kind]


@pytest.mark.parametrize('path', FOXGLOVE, ids=lambda path: path.name)
def test_buttons_ask_for_services_only(path):
    panels = json.loads(path.read_text())['configById']
    called = [p['serviceName'] for name, p in panels.items() if name.startswith('CallService!')]
    assert f'/{machine_of(path)}/serial_bridge/stop' in called
    for name in called:
        assert '/srv/' in documented()[name.removeprefix(f'/{machine_of(path)}/')]
