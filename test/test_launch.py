"""The launch files, read with a stand-in for `launch`, which no index of wheels has.

The stand-in takes the arguments that launch and launch_ros of Jazzy take, and no others; how they
start processes is their own affair.
"""

import ast
import re
import runpy
import sys
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from manipulator.errors import ConfigError, Refused

ROOT = Path(__file__).resolve().parents[1]
FILES = sorted((ROOT / 'launch').glob('*.launch.py'))
SETUP = (ROOT / 'setup.py').read_text()
KINDS = ('hexapod', 'arm')
MACHINE = 'hexarm_machine'
NODES = {MACHINE: ('ik', 'pose', 'trajectory', 'serial_bridge'), 'hexarm_panel': ('panel',)}
"""What an executable holds whose name is not that of its one node."""


@dataclass(frozen=True)
class LaunchConfiguration:
    variable_name: str

    def perform(self, context):
        return context[self.variable_name]


@dataclass(frozen=True)
class IfCondition:
    predicate_expression: LaunchConfiguration

    def evaluate(self, context):
        return {'true': True, 'false': False}[self.predicate_expression.perform(context).lower()]


@dataclass
class DeclareLaunchArgument:
    name: str
    default_value: str = field(kw_only=True)
    description: str = field(kw_only=True)


@dataclass(kw_only=True)
class OpaqueFunction:
    function: Any
    args: list[Any] = field(default_factory=list)


@dataclass(kw_only=True)
class Node:
    package: str
    executable: str
    namespace: str
    parameters: list[dict[str, Any]]
    output: str
    condition: Any = None


@dataclass(kw_only=True)
class ExecuteProcess:
    cmd: list[str]
    additional_env: dict[str, str]
    output: str


@dataclass
class LaunchDescription:
    initial_entities: list[Any]


CONTENT = {
    'launch': {'LaunchDescription': LaunchDescription, 'LaunchContext': dict},
    'launch.actions': {
        kind.__name__: kind for kind in (DeclareLaunchArgument, ExecuteProcess, OpaqueFunction)
    },
    'launch.conditions': {'IfCondition': IfCondition},
    'launch.substitutions': {'LaunchConfiguration': LaunchConfiguration},
    'launch_ros': {},
    'launch_ros.actions': {'Node': Node},
}


@pytest.fixture(autouse=True)
def stand_in(monkeypatch):
    """`launch` and `launch_ros` as modules, for this test only."""
    for name, content in CONTENT.items():
        module = ModuleType(name)
        vars(module).update(content)
        monkeypatch.setitem(sys.modules, name, module)
    monkeypatch.delitem(sys.modules, 'hexarm.launch_graph', raising=False)
    yield
    sys.modules.pop('hexarm.launch_graph', None)


def arguments_of(kind):
    path = ROOT / 'launch' / f'{kind}.launch.py'
    return runpy.run_path(str(path))['generate_launch_description']().initial_entities


def started(kind, **chosen):
    """The processes that run with these arguments, after their conditions."""
    *declared, opaque = arguments_of(kind)
    context = {a.name: a.default_value for a in declared} | chosen
    actions = opaque.function(context, *opaque.args)
    conditions = [getattr(a, 'condition', None) for a in actions]
    return [
        a for a, c in zip(actions, conditions, strict=True) if c is None or c.evaluate(context)
    ]


def executables():
    return set(re.findall(r"^\s+'(\w+) = [\w.]+:\w+',$", SETUP, re.MULTILINE))


def parameters_of(executable):
    """What the table of the node in docs/interfaces.md lists."""
    text = (ROOT / 'docs' / 'interfaces.md').read_text()
    found = set()
    for node in NODES.get(executable, (executable,)):
        section = text.split(f'\n## {node}\n')[1].split('\n## ')[0].split('| parameter |')[1]
        found |= set(re.findall(r'^\| `([\w.]+)` \|', section, re.MULTILINE))
    return found


@pytest.mark.parametrize('kind', KINDS)
def test_arguments_are_those_of_the_document(kind):
    *declared, _ = arguments_of(kind)
    text = (ROOT / 'docs' / 'viewers.md').read_text()
    rows = re.findall(r'^\| `(\w+)` \| (\S*) \|', text.split('## ros2 launch')[1], re.MULTILINE)
    machine = {'hexapod': 'robocake', 'arm': 'arm_6r'}[kind]
    reported = dict(rows) | {'machine': machine, 'namespace': kind}
    reported['frame_prefix'] = ''
    assert {a.name: a.default_value for a in declared} == reported
    assert all(a.description for a in declared)


@pytest.mark.parametrize('kind', KINDS)
def test_default_is_the_whole_graph_on_the_fake_board(kind):
    nodes = started(kind)
    assert {n.executable for n in nodes} == {MACHINE, 'fake_hardware'}
    assert {n.namespace for n in nodes} == {kind}
    by_name = {n.executable: n.parameters[0] for n in nodes}
    assert by_name[MACHINE]['port'] == by_name['fake_hardware']['link']


@pytest.mark.parametrize('kind', KINDS)
def test_real_port_starts_no_fake_board(kind):
    nodes = started(kind, port='/dev/ttyACM0', namespace='/lab/left', frame_prefix='left/')
    assert {n.executable for n in nodes} == {MACHINE}
    assert {n.namespace for n in nodes} == {'lab/left'}
    by_name = {n.executable: n.parameters[0] for n in nodes}
    assert by_name[MACHINE]['port'] == '/dev/ttyACM0'
    assert by_name[MACHINE]['frame_prefix'] == 'left/'


@pytest.mark.parametrize('kind', KINDS)
def test_executables_and_parameters_exist(kind):
    for node in started(kind):
        assert node.package == 'hexarm'
        assert node.executable in executables()
        assert set(node.parameters[0]) <= parameters_of(node.executable)


@pytest.mark.parametrize('kind', KINDS)
def test_panel_runs_only_where_it_is_asked_for(kind):
    (panel,) = (n for n in started(kind, panel='true') if n not in started(kind))
    assert panel.executable == 'hexarm_panel'
    assert panel.namespace == kind
    assert set(panel.parameters[0]) <= parameters_of('hexarm_panel')


@pytest.mark.parametrize(
    ('chosen', 'error', 'reason'),
    [
        ({'machine': 'arm_6r'}, Refused, 'hexarm up arm_6r'),
        ({'machine': 'robocaek'}, ConfigError, "did you mean 'robocake'"),
        ({'namespace': 'two words'}, Refused, 'is not a ROS name'),
    ],
)
def test_arguments_that_do_not_fit_start_nothing(chosen, error, reason):
    with pytest.raises(error, match=reason):
        started('hexapod', **chosen)


@pytest.mark.usefixtures('chip_tools')
def test_chip_on_a_simulator_is_a_process_of_its_own():
    nodes = started('hexapod', port='simavr')
    (chip,) = (n for n in nodes if isinstance(n, ExecuteProcess))
    assert {'__ns:=/hexapod', 'machine:=robocake'} <= set(chip.cmd)
    assert str(ROOT) in chip.additional_env['PYTHONPATH']
    assert {n.executable for n in nodes if n is not chip} == {MACHINE}


def test_launch_files_and_viewers_are_installed():
    installed = {
        'launch': [f.name for f in FILES],
        'viewers': [f.name for f in (ROOT / 'viewers').iterdir()],
    }
    calls = ast.unparse(ast.parse(SETUP))
    for folder, files in installed.items():
        assert files
        assert f"f'share/{{NAME}}/{folder}'" in calls
