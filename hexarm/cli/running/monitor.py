"""`hexarm monitor`: the diagnostics of a machine's nodes, live in the terminal."""

import argparse
import contextlib
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from hexarm.cli.answers import Answer, answering
from hexarm.namespaces import namespace_of, no_machine_in
from manipulator.nodes.devices.terminal import Terminal
from manipulator.nodes.stop_signal import Interrupted, StopSignal

if TYPE_CHECKING:
    from rich.console import Group

    from hexarm.client import Client

REDRAW = 0.25
REPORTED_WITHIN = 1.5
"""Seconds in which each node reports, which it does every second."""
SILENT = 3.0
"""Seconds after which a node that reports every second is shown as silent."""

COLOURS = {b'\0': 'green', b'\1': 'yellow', b'\2': 'red', b'\3': 'red'}
"""By the level of a DiagnosticStatus: OK, WARN, ERROR, STALE."""


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('monitor')
    parser.add_argument(
        'namespace', nargs='?', type=namespace_of, default='hexapod', help='default: hexapod'
    )
    parser.add_argument('--json', action='store_true', help='once, as an answer for programs')
    parser.set_defaults(run=lambda arguments: (once if arguments.json else run)(arguments))


def answer(arguments: argparse.Namespace) -> Answer:
    """The machine's state and the last report of each of its nodes."""
    from hexarm.client import Client  # noqa: PLC0415 (needs ROS)

    view = View(arguments.namespace)
    with Client(arguments.namespace) as client:
        client.await_machine()
        client.spin(REPORTED_WITHIN)
        view.note(client, time.monotonic())
        nodes = {
            node: {
                'level': int.from_bytes(report.level, 'little'),
                'message': report.message,
                'values': {pair.key: pair.value for pair in report.values},
            }
            for node, (report, _) in sorted(view.reports.items())
        }
        state, motion = client.machine_state.message, client.motion_status.message
        space = f'/{arguments.namespace}'
        return {'namespace': space, 'state': state, 'motion': motion, 'nodes': nodes}, []


once = answering(answer)


def run(arguments: argparse.Namespace) -> int:
    """Draws until q or Ctrl-C; needs a terminal and rich."""
    from rich.live import Live  # noqa: PLC0415 (other commands do without)

    from hexarm.client import Client  # noqa: PLC0415 (needs ROS)

    stop = StopSignal()
    namespace = arguments.namespace
    view = View(namespace)
    with (
        Terminal() as terminal,
        Client(namespace, stop.check) as client,
        Live(screen=True, auto_refresh=False) as live,
        contextlib.suppress(Interrupted),
    ):
        while terminal.read() not in (b'q', None):
            view.note(client, time.monotonic())
            live.update(view.drawn(client, time.monotonic()), refresh=True)
            client.spin(REDRAW)
    return 0


@dataclass
class View:
    """The last report of each node in `namespace`, and when it came (s, monotonic)."""

    namespace: str
    reports: dict[str, tuple[Any, float]] = field(default_factory=dict)

    def note(self, client: 'Client', now: float) -> None:
        """Keeps the reports that are new."""
        for name, report in client.diagnostics.items():
            space, _, node = name.rpartition('/')
            if space == self.namespace and self.reports.get(node, (None,))[0] is not report:
                self.reports[node] = report, now

    def drawn(self, client: 'Client', now: float) -> 'Group':
        """One head line for the machine, then a block for each node."""
        from rich.columns import Columns  # noqa: PLC0415
        from rich.console import Group  # noqa: PLC0415
        from rich.text import Text  # noqa: PLC0415

        blocks: list[Text | Columns] = [
            Text(f'/{self.namespace}: {client.summary}', style='bold'),
            Text('q or Ctrl-C ends this', style='dim'),
        ]
        for node, (report, at) in sorted(self.reports.items()):
            age = now - at
            message = f'silent for {age:.0f} s' if age > SILENT else report.message
            colour = 'red' if age > SILENT else COLOURS[bytes(report.level)]
            blocks.append(Text.assemble('\n', (node, f'bold {colour}'), f'  {message}'))
            values = [f'{pair.key} {pair.value}' for pair in report.values if pair.value]
            blocks.append(Columns([Text(value) for value in values], equal=True, padding=(0, 3)))
        if not self.reports:
            message = no_machine_in(self.namespace, client.topics, client.domain)
            blocks.append(Text(f'\nnothing received yet: {message}'))
        return Group(*blocks)
