"""Changes to a machine file on the disc: only what was changed, all of it or nothing."""

import contextlib
import os
import tempfile
from pathlib import Path

from hexarm.machine_check import problems_of
from hexarm.machines import find, shipped, text_of
from manipulator.errors import ConfigError


class MachineWriter:
    """The file that a calibration reads, and the one that it writes to."""

    def __init__(self, machine: str, output: str | None) -> None:
        """ConfigError where it could not be written later: said before anybody does any work."""
        self.source = find(machine).resolve()
        self.target = Path(output).expanduser() if output else self.source
        self.text = text_of(self.source)
        if output is None and self.source in {path.resolve() for path in shipped().values()}:
            raise ConfigError(
                [
                    f'{self.source.name} came with the package and stays as it is: '
                    f'name a file of your own with --output my_{self.source.name}'
                ]
            )
        if output is not None and self.target.exists():
            raise ConfigError([f'{self.target} exists already: it is not overwritten'])
        folder = self.target.parent
        if not folder.is_dir():
            raise ConfigError([f'{folder} is no folder'])
        if not os.access(folder, os.W_OK) or (
            output is None and not os.access(self.target, os.W_OK)
        ):
            raise ConfigError([f'{self.target} cannot be written: name another with --output'])

    def write(self, text: str) -> list[str]:
        """Puts the new text in place at once; returns what `hexarm check` would say of it.

        ConfigError where somebody else has changed the file meanwhile.
        """
        if text_of(self.source) != self.text:
            raise ConfigError([f'{self.source} was changed meanwhile: nothing was written'])
        if self.target != self.source and self.target.exists():
            raise ConfigError([f'{self.target} was made meanwhile: it is not overwritten'])
        found = new_problems(self.text, text)
        try:
            self._replace(text)
        except OSError as error:
            raise ConfigError([f'{self.target} cannot be written: {error.strerror}']) from error
        return found

    def _replace(self, text: str) -> None:
        number, name = tempfile.mkstemp(prefix=f'.{self.target.name}.', dir=self.target.parent)
        try:
            with os.fdopen(number, 'w', encoding='utf-8', newline='') as file:
                file.write(text)
                file.flush()
                os.fsync(file.fileno())
            Path(name).chmod(self.source.stat().st_mode & 0o777 | 0o600)
            os.replace(name, self.target)
        except BaseException:
            with contextlib.suppress(OSError):
                os.unlink(name)
            raise


def new_problems(before: str, after: str) -> list[str]:
    """What is wrong with a machine file after a change and was not before."""
    old = set(problems_of(before))
    return [problem for problem in problems_of(after) if problem not in old]
