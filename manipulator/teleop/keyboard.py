"""Jogging by the keys of a terminal, which reports presses but never releases.

So a key moves for HOLD seconds, and the terminal's auto-repeat of a key that is held extends
that. Auto-repeat begins late (0.25 s to 0.7 s, a setting of the desktop): where that is later
than HOLD, a held key moves, rests, and then moves for good.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from manipulator.arrays import Array
from manipulator.config import quantity
from manipulator.teleop.gamepad import COMPONENTS, Component
from manipulator.teleop.modes import MODES

HOLD = 0.3
"""Seconds for which one press moves."""

STEP = 1.25
"""By which a press of + or - changes the speeds."""

SLOWEST, FASTEST = 0.05, 5.0
"""Parts of the speeds at the start."""

MOST_AT_ONCE = 3
"""Different keys in one reading; more are a paste or a cat, not a hand."""

MOVES: dict[str, tuple[Component, float]] = {
    'w': ('x', 1.0),
    's': ('x', -1.0),
    'a': ('y', 1.0),
    'd': ('y', -1.0),
    'r': ('z', 1.0),
    'f': ('z', -1.0),
    'o': ('roll', 1.0),
    'u': ('roll', -1.0),
    'i': ('pitch', 1.0),
    'k': ('pitch', -1.0),
    'j': ('yaw', 1.0),
    'l': ('yaw', -1.0),
}
GRIPS = {'v': 1, 'c': -1}
FRAMES = ('base', 'tool')
UNKNOWN = '?'

HELP = f"""\
 move  w/s  x + -    a/d  y + -     r/f  z + -
 turn  o/u  roll     i/k  pitch     j/l  yaw
 grip  v    open     c    close
 set   +/-  speed    m/n  mode      b    frame
       h    home     p    save pose
       q    quit     SPACE  stop everything
       one press moves for {HOLD} s      any other key ends the motion"""


def keys_of(characters: bytes) -> tuple[str, ...]:
    """The keys that were pressed; arrow keys and the like are UNKNOWN, a paste is one UNKNOWN."""
    text = characters.decode(errors='replace')
    keys = tuple(re.sub('\x1b(\\[[0-?]*[ -/]*[@-~]|O.|.)?', UNKNOWN, text, flags=re.DOTALL))
    return keys if len(set(keys)) <= MOST_AT_ONCE else (UNKNOWN,)


@dataclass(frozen=True)
class Keyboard:
    """The command of the keys so far; times are of a monotonic clock, in seconds.

    full speeds in m/s and rad/s; `stops`, `homes` and `saves` count the presses of those keys.
    """

    linear_speed: float = quantity(1e-4, 1.0, default=0.02)
    angular_speed: float = quantity(1e-3, 5.0, default=0.2)
    part: float = 1.0
    ends: Mapping[str, float] = field(default_factory=dict)
    mode: str = 'free'
    frame: str = FRAMES[0]
    stops: int = 0
    homes: int = 0
    saves: int = 0
    is_over: bool = False

    def press(self, key: str, now: float) -> 'Keyboard':
        """After one press. An unknown key ends the motion."""
        if key in MOVES or key in GRIPS:
            others = {k: end for k, end in self.ends.items() if end > now and k != _against(key)}
            return replace(self, ends=others | {key: now + HOLD})
        still = replace(self, ends={})
        if key in ('+', '=', '-'):
            part = self.part / STEP if key == '-' else self.part * STEP
            return replace(self, part=min(max(part, SLOWEST), FASTEST))
        changes = {
            ' ': {'stops': self.stops + 1},
            'h': {'homes': self.homes + 1},
            'p': {'saves': self.saves + 1},
            'm': {'mode': _next(tuple(MODES), self.mode, 1)},
            'n': {'mode': _next(tuple(MODES), self.mode, -1)},
            'b': {'frame': _next(FRAMES, self.frame, 1)},
            'q': {'is_over': True},
        }
        return replace(still, **changes.get(key, {}))  # type: ignore[arg-type]

    def is_held(self, now: float) -> bool:
        """Whether some key still moves something."""
        return any(end > now for end in self.ends.values())

    def twist(self, now: float) -> Array:
        """The twist (6,) in m/s and rad/s, in `frame`."""
        speeds = np.repeat([self.linear_speed, self.angular_speed], 3) * self.part
        directions = np.zeros(6)
        for key, end in self.ends.items():
            if end > now and key in MOVES:
                component, direction = MOVES[key]
                directions[COMPONENTS.index(component)] = direction
        twist: Array = directions * speeds
        return twist

    def grip(self, now: float) -> int:
        """+1 to open the gripper, −1 to close it, 0 to rest."""
        return sum(direction for key, direction in GRIPS.items() if self.ends.get(key, now) > now)

    @property
    def line(self) -> str:
        """Speeds, mode and frame, for people."""
        linear, angular = self.linear_speed * self.part * 1e3, self.angular_speed * self.part
        return f'{linear:.3g} mm/s, {angular:.2g} rad/s, mode {self.mode}, frame {self.frame}'


def _against(key: str) -> str:
    """The key of the opposite direction."""
    if key in GRIPS:
        return next(k for k in GRIPS if k != key)
    component, direction = MOVES[key]
    return next(k for k, move in MOVES.items() if move == (component, -direction))


def _next(names: tuple[str, ...], name: str, step: int) -> str:
    return names[(names.index(name) + step) % len(names)]
