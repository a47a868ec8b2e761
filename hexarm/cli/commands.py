"""The subcommands of `hexarm`, in the order of its help; a module is imported once it is used."""

import argparse
from collections.abc import Iterable
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any


@dataclass(frozen=True)
class Command:
    """A subcommand: the module that declares it, a line of help, and one that one can type."""

    name: str
    module: str
    help: str
    example: str


COMMANDS = (
    Command('up', 'hexarm.cli.running.up',
            'start a whole graph and enable the servos', 'up hexapod --panel'),
    Command('enable', 'hexarm.cli.running.machine_calls',
            'switch the servos on, one by one, at the park pose', 'enable hexapod'),
    Command('disable', 'hexarm.cli.running.machine_calls',
            'switch the servos off: they hold nothing any more', 'disable hexapod'),
    Command('clear', 'hexarm.cli.running.machine_calls',
            'end a stop or a fault; nothing moves', 'clear hexapod'),
    Command('stop', 'hexarm.cli.running.stop',
            'emergency stop: the board holds at once, until `hexarm clear`', 'stop hexapod'),
    Command('go', 'hexarm.cli.running.drive',
            'move a running machine to a pose', 'go hexapod --xyz 0 0 0.047 --rpy 0 0 0.1'),
    Command('home', 'hexarm.cli.running.drive',
            'move a running machine to its home pose', 'home hexapod'),
    Command('park', 'hexarm.cli.running.drive',
            'move a running machine to where its servos are switched on and off', 'park arm'),
    Command('pose', 'hexarm.cli.running.drive',
            'print the measured pose of a running machine', 'pose hexapod --units mm'),
    Command('joints', 'hexarm.cli.running.drive',
            'print the measured joints of a running machine', 'joints arm --json'),
    Command('save', 'hexarm.cli.running.teach',
            'save the measured pose of a running machine under a name', 'save arm above_cup'),
    Command('poses', 'hexarm.cli.running.teach',
            'list the saved poses and sequences of a running machine', 'poses arm'),
    Command('delete', 'hexarm.cli.running.teach',
            'delete a saved pose', 'delete arm above_cup'),
    Command('replay', 'hexarm.cli.running.teach',
            'move a running machine through saved poses and sequences',
            'replay arm above_cup at_cup --pause 0.5 --repeat 3'),
    Command('demo', 'hexarm.cli.demo',
            'drive the RoboCake and an arm on fake boards, within a minute', 'demo'),
    Command('monitor', 'hexarm.cli.running.monitor',
            'show the diagnostics of the nodes, live', 'monitor hexapod'),
    Command('record', 'hexarm.cli.running.record',
            "write a machine's messages into an MCAP file", 'record hexapod -o tour.mcap'),
    Command('foxglove', 'hexarm.cli.running.foxglove',
            'serve the messages of a machine to Foxglove, live', 'foxglove hexapod'),
    Command('plot', 'hexarm.cli.running.plot',
            'draw a recording', 'plot tour.mcap --from 2 --to 8'),
    Command('ik', 'hexarm.cli.ik',
            'print the joints of a pose, or why it is out of reach',
            'ik robocake --xyz 0 0 0.045 --rpy 0 0 0.1'),
    Command('fk', 'hexarm.cli.fk',
            'print the pose of joint positions', 'fk robocake 2.1 2.1 2.1 2.1 2.1 2.1'),
    Command('new', 'hexarm.cli.new',
            'make a machine file of your measures, by questions', 'new my_machine.yaml'),
    Command('import', 'hexarm.cli.import_arm',
            "make a machine file of an arm's URDF", 'import ur3e.urdf --tip tool0'),
    Command('draw', 'hexarm.cli.draw',
            'draw a machine at a pose, with its measures', 'draw robocake --rpy 0 0 0.1'),
    Command('mjcf', 'hexarm.cli.export',
            'write a machine as a MuJoCo model', 'mjcf robocake --output robocake.xml'),
    Command('urdf', 'hexarm.cli.export',
            'write an arm as URDF', 'urdf arm_6r --output arm.urdf'),
    Command('simulate', 'hexarm.cli.simulate',
            'run a periodic motion as rigid bodies with servos',
            'simulate robocake --picture simulated.png'),
    Command('reproduce', 'hexarm.cli.reproduce',
            'compute the figures of the three papers, in a minute or two', 'reproduce --quick'),
    Command('reach', 'hexarm.cli.reach',
            'print which limits a pose meets, and the nearest reachable pose',
            'reach robocake --xyz 0.03 0 0.045'),
    Command('workspace', 'hexarm.cli.workspace',
            'compute ranges, volumes and pictures of the workspace',
            'workspace robocake --picture workspace.png'),
    Command('accuracy', 'hexarm.cli.accuracy',
            'compute pose errors from servos and geometry', 'accuracy robocake --noise 0.01'),
    Command('leg-motion', 'hexarm.cli.leg_motion',
            'compute how far from straight a platform goes while its legs move linearly',
            'leg-motion stewart_6_6 --legs 0.15 --to 0.02 0.02 0.2'),
    Command('machines', 'hexarm.cli.check',
            'list the machine files that are shipped', 'machines'),
    Command('check', 'hexarm.cli.check',
            'print all problems of a machine file', 'check config/robocake.yaml'),
    Command('calibrate', 'hexarm.calibration.command',
            'set a machine file right by the machine',
            'calibrate servos robocake --output mine.yaml'),
    Command('firmware-header', 'hexarm.board.header',
            "print a machine file as the board's C header", 'firmware-header robocake'),
)  # fmt: skip

BY_NAME = {command.name: command for command in COMMANDS}


if TYPE_CHECKING:
    SubParsers = argparse._SubParsersAction[argparse.ArgumentParser]
else:
    SubParsers = argparse._SubParsersAction


class Commands(SubParsers):
    """The modules add their parsers to it; their help comes from the table above."""

    def add_parser(self, name: str, **options: Any) -> argparse.ArgumentParser:
        """As argparse's, with the subcommand's help, and its example at the end."""
        command = BY_NAME[name]
        note, example = options.get('epilog'), f'example:\n  hexarm {command.example}'
        own = {
            'help': command.help,
            'description': f'{command.help[0].upper()}{command.help[1:]}.',
            'epilog': f'{example}\n\n{note}' if note else example,
            'formatter_class': argparse.RawDescriptionHelpFormatter,
        }
        return super().add_parser(name, **options | own)


def declare(commands: 'argparse._SubParsersAction[Any]', words: Iterable[str]) -> None:
    """Declares the subcommand that the words begin with; of all others the names and help."""
    name = next((word for word in words if not word.startswith('-')), '')
    if name in BY_NAME:
        import_module(BY_NAME[name].module).add_parser(commands)
        return
    for command in COMMANDS:
        commands.add_parser(command.name)
