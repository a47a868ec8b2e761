"""Finding and loading gamepad mappings: config/joystick_NAME.yaml, or a path."""

from pathlib import Path

from hexarm.machines import folders, text_of
from manipulator.config import build, parse_yaml
from manipulator.errors import ConfigError
from manipulator.formatting import did_you_mean, nearest, shown
from manipulator.teleop.gamepad import Gamepad

PREFIX = 'joystick_'


def shipped() -> dict[str, Path]:
    """The mappings that come with the package, by name."""
    files = (f for folder in reversed(folders()) for f in sorted(folder.glob(f'{PREFIX}*.yaml')))
    return {f.stem.removeprefix(PREFIX): f for f in files}


def load(name_or_path: str) -> Gamepad:
    """The mapping of a shipped name or a path; ConfigError lists all that is wrong."""
    path = Path(name_or_path).expanduser()
    if path.suffix not in ('.yaml', '.yml') and '/' not in name_or_path:
        known = shipped()
        if name_or_path not in known:
            hint = did_you_mean(nearest(name_or_path, known))
            there = ', '.join(sorted(known))
            problem = f'no gamepad is called {shown(name_or_path)}{hint} (shipped: {there})'
            raise ConfigError([problem])
        path = known[name_or_path]
    content = parse_yaml(text_of(path), str(path))
    if not {'deadman', 'sticks'} & {*content}:
        problem = 'this is no mapping of a gamepad: deadman, sticks are missing'
        raise ConfigError([problem], str(path))
    return build(Gamepad, content, source=str(path))
