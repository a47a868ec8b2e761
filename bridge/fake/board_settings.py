"""What the board's program has from the machine file."""

import itertools
from dataclasses import dataclass
from typing import Literal

from bridge.calibration import Calibration
from bridge.fake.program import CrankHexapod, Machine
from bridge.programs import CountTable
from bridge.protocol import PROTOCOL_VERSION
from bridge.servo_config import BoardConfig

PULSE_PERIOD_US = 20_000


@dataclass(frozen=True)
class BoardSettings:
    """What the firmware has from the machine file; ranges and speeds in counts, per channel.

    hexapod: the inverse kinematics by which the board plays cycles; None: it has none.
    table: what is in its flash beside the program.
    """

    count_ranges: tuple[tuple[int, int], ...]
    count_speeds: tuple[float, ...]
    on_link_loss: Literal['hold', 'release'] = 'hold'
    arm_interval_us: int = 150_000
    minimum_battery_mv: int = 0
    boot_us: int = 300_000
    version: int = PROTOCOL_VERSION
    baud: int = 250_000
    hexapod: CrankHexapod | None = None
    table: CountTable | None = None

    @classmethod
    def from_config(
        cls, config: BoardConfig, boot_s: float, hexapod: CrankHexapod | None = None
    ) -> 'BoardSettings':
        """The settings of a machine whose board takes `boot_s` to start."""
        calibration = Calibration.from_config(config.servos)
        return cls(
            count_ranges=calibration.count_ranges,
            count_speeds=calibration.count_speeds,
            on_link_loss=config.link.on_link_loss,
            arm_interval_us=1000 * config.servos.arm_interval_ms,
            minimum_battery_mv=round(1000 * config.servos.minimum_battery_v),
            boot_us=round(1e6 * boot_s),
            baud=config.link.baud,
            hexapod=hexapod,
        )

    @property
    def machine(self) -> Machine:
        """The same as the program's structure."""
        machine = Machine(
            protocol_version=self.version,
            joint_count=len(self.count_ranges),
            releases_on_link_loss=self.on_link_loss == 'release',
            arm_interval_ms=self.arm_interval_us // 1000,
            minimum_battery_mv=self.minimum_battery_mv,
            baud=self.baud,
            hexapod=self.hexapod or CrankHexapod(),
        )
        pairs = zip(self.count_ranges, self.count_speeds, strict=True)
        for channel, ((low, high), speed) in enumerate(pairs):
            machine.lowest_counts[channel] = low
            machine.highest_counts[channel] = high
            machine.step_counts[channel] = speed * PULSE_PERIOD_US * 1e-6
        return machine

    @property
    def can_loop(self) -> bool:
        """No servo is outrun from the table's last row to the first."""
        if self.table is None:
            return False
        ends = zip(self.table.rows[-1], self.table.rows[0], self.count_speeds, strict=True)
        step = 1e-3 * self.table.step_ms
        return all(abs(a - b) <= speed * step for a, b, speed in ends)

    @property
    def table_counts(self) -> tuple[int, ...]:
        """The table row by row; empty where there is none."""
        return () if self.table is None else tuple(itertools.chain(*self.table.rows))
