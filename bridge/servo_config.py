"""The `servos`, `link` and `simulation` sections of a machine file, unconverted.

A machine's joints are rotary (degrees) or linear (millimetres), never both.
"""

import math
from dataclasses import dataclass
from typing import Literal

from bridge.protocol import MAX_JOINTS
from manipulator.config import PLACE_MM, RATE, build, key, quantity
from manipulator.errors import ConfigError
from manipulator.formatting import counted, shown, told_apart
from manipulator.machine import MachineFile

PARK = 'positions at which the servos are switched on and off, in the order of joints'
MAX_NAME = 64
"""Characters of a joint's name, which messages repeat."""


@dataclass(frozen=True)
class ServoConfig:
    """One servo: position = centre + sign · (pulse − centre_us) / us_per_…"""

    name: str = key('that of the joint: crank_1, leg_1, joint_1 …; free for a gripper')
    channel: int = quantity(0, MAX_JOINTS - 1, "the board's output (docs/wiring.md)")
    sign: int = quantity(-1, 1, '-1 where longer pulses turn the joint back')
    centre_us: float = quantity(100, 30_000, 'pulse at centre_deg or centre_mm')
    pulse_range_us: tuple[float, float] = quantity(100, 30_000, 'shortest and longest pulse')
    centre_deg: float | None = quantity(-720, 720, 'joint angle at centre_us', default=None)
    us_per_deg: float | None = quantity(1e-3, 1e5, 'pulse per joint angle', default=None)
    centre_mm: float | None = quantity(*PLACE_MM, 'leg length at centre_us', default=None)
    us_per_mm: float | None = quantity(1e-3, 1e5, 'pulse per leg length', default=None)
    is_gripper: bool = key('whether it opens and closes a gripper', default=False)

    def __post_init__(self) -> None:
        problems = []
        if len(self.name) > MAX_NAME:
            text = (
                f'{shown(self.name)}: {len(self.name)} characters, a name has at most {MAX_NAME}'
            )
            raise ConfigError([text])
        rotary = (self.centre_deg, self.us_per_deg)
        linear = (self.centre_mm, self.us_per_mm)
        if not (None not in rotary and linear == (None, None)) and not (
            None not in linear and rotary == (None, None)
        ):
            problems.append('needs centre_deg and us_per_deg, or centre_mm and us_per_mm')
        if self.sign not in (-1, 1):
            problems.append(f'sign: {self.sign} is neither 1 nor -1')
        low, high = self.pulse_range_us
        if not low <= self.centre_us <= high:
            centre, *ends = told_apart([self.centre_us, low, high])
            problems.append(f'centre_us: {centre} outside [{", ".join(ends)}]')
        if problems:
            raise ConfigError([f'{self.name}: {problem}' for problem in problems])

    @property
    def is_linear(self) -> bool:
        """Millimetres instead of degrees."""
        return self.centre_mm is not None

    @property
    def centre(self) -> float:
        """The position at `centre_us`, in ° or mm as in the file."""
        return self.centre_mm if self.centre_mm is not None else self.centre_deg or 0.0


@dataclass(frozen=True)
class ServosConfig:
    """All servos of a machine; lists follow the order of `joints`."""

    joints: tuple[ServoConfig, ...] = key(
        f'one for each channel, 1 to {MAX_JOINTS}; the Mega has 8'
    )
    speed_deg_s: float | None = quantity(*RATE, 'of the servos without load', default=None)
    speed_mm_s: float | None = quantity(*RATE, 'likewise, of linear ones', default=None)
    park_deg: tuple[float, ...] | None = quantity(-720, 720, PARK, default=None)
    park_mm: tuple[float, ...] | None = quantity(*PLACE_MM, PARK, default=None)
    arm_interval_ms: int = quantity(
        0, 5000, 'between servos, as they are switched on one by one', default=150
    )
    minimum_battery_v: float = quantity(0, 60, 'below it the board refuses to arm', default=0.0)

    def __post_init__(self) -> None:
        problems = []
        if not 1 <= len(self.joints) <= MAX_JOINTS:
            problems.append(f'joints: {counted(len(self.joints), "joint")}, 1 to {MAX_JOINTS} fit')
        names = [joint.name for joint in self.joints]
        if len(set(names)) < len(names):
            problems.append(f'joints: duplicate names in {names}')
        if sum(joint.is_gripper for joint in self.joints) > 1:
            problems.append('joints: more than one is the gripper')
        problems += self._channel_problems()
        problems += self._unit_problems()
        if problems:
            raise ConfigError(problems)

    def _channel_problems(self) -> list[str]:
        channels = [joint.channel for joint in self.joints]
        if sorted(channels) == list(range(len(channels))):
            return []
        problem = f'joints: channels {channels} are not 0 to {len(channels) - 1}'
        for channel in sorted(set(channels)):
            users = [joint.name for joint in self.joints if joint.channel == channel]
            if len(users) > 1:
                problem += f'; {channel} is that of {" and ".join(users)}'
        return [problem]

    def _unit_problems(self) -> list[str]:
        if len({joint.is_linear for joint in self.joints}) > 1:
            return ['joints: some are in degrees, others in millimetres']
        is_linear = all(joint.is_linear for joint in self.joints)
        unit = 'mm' if is_linear else 'deg'
        speed = self.speed_mm_s if is_linear else self.speed_deg_s
        park = self.park_mm if is_linear else self.park_deg
        other = ('speed_deg_s', 'park_deg') if is_linear else ('speed_mm_s', 'park_mm')
        given = [name for name in other if getattr(self, name) is not None]
        problems = [f'{name}: the joints are in {unit}' for name in given]
        if speed is None:
            problems.append(f'speed_{unit}_s: missing')
        if park is None:
            problems.append(f'park_{unit}: missing')
        elif len(park) != len(self.joints):
            joints = counted(len(self.joints), 'joint')
            problems.append(f'park_{unit}: {counted(len(park), "value")} for {joints}')
        return problems


@dataclass(frozen=True)
class LinkConfig:
    """The serial line, and what the board does when setpoints cease."""

    on_link_loss: Literal['hold', 'release'] = key('what the board does after the deadline')
    baud: int = quantity(9600, 4_000_000, "of the serial line; the firmware's")
    setpoint_deadline_ms: int = quantity(20, 2000, 'how long a setpoint is good for')


@dataclass(frozen=True)
class SimulationConfig:
    """What the fake board's servos and battery do; joints: what the board reports of them.

    drives: servos, each at its own full speed, or steppers, which interpolate together.
    """

    hysteresis_deg: float = quantity(0, 45, 'play of each servo', default=0.0)
    hysteresis_mm: float = quantity(0, 100, 'play of each linear servo', default=0.0)
    dead_band_us: float = quantity(0, 200, 'change of pulse that a servo ignores', default=5.0)
    battery_v: float = quantity(0, 60, 'what the board measures', default=7.6)
    joints: Literal['commanded', 'measured'] = key('what the board reports', default='commanded')
    drives: Literal['servos', 'steppers'] = key(
        'each at its own speed, or all together', default='servos'
    )


@dataclass(frozen=True)
class BoardConfig:
    """The bridge's three sections of a machine file."""

    servos: ServosConfig
    link: LinkConfig
    simulation: SimulationConfig

    @property
    def hysteresis(self) -> float:
        """The play of each simulated servo, in rad (or m)."""
        if self.servos.joints[0].is_linear:
            return 1e-3 * self.simulation.hysteresis_mm
        return math.radians(self.simulation.hysteresis_deg)

    @classmethod
    def from_machine(cls, machine: MachineFile, source: str = '') -> 'BoardConfig':
        """Checked against the schemas above; ConfigError lists everything that is wrong."""
        if machine.driver != 'serial':
            problem = f'driver: {machine.driver}, the machine has no board and no servos of ours'
            raise ConfigError([problem], source)
        sections = {
            'servos': machine.servos,
            'link': machine.link,
            'simulation': machine.simulation or {},
        }
        return build(cls, sections, source=source)
