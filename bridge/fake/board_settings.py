"""What the board's program has from the machine file."""

from dataclasses import dataclass
from typing import Literal

from bridge.calibration import Calibration
from bridge.fake.board_courses import Solver
from bridge.protocol import PROTOCOL_VERSION
from bridge.servo_config import BoardConfig


@dataclass(frozen=True)
class BoardSettings:
    """What the firmware has from the machine file; ranges and speeds in counts, per channel.

    solve: the inverse kinematics by which the board plays cycles; None: it has none.
    """

    count_ranges: tuple[tuple[int, int], ...]
    count_speeds: tuple[float, ...]
    on_link_loss: Literal['hold', 'release'] = 'hold'
    arm_interval_us: int = 150_000
    minimum_battery_mv: int = 0
    boot_us: int = 300_000
    version: int = PROTOCOL_VERSION
    solve: Solver | None = None

    @classmethod
    def from_config(cls, config: BoardConfig, boot_s: float) -> 'BoardSettings':
        """The settings of a machine whose board takes `boot_s` to start."""
        calibration = Calibration.from_config(config.servos)
        return cls(
            count_ranges=calibration.count_ranges,
            count_speeds=calibration.count_speeds,
            on_link_loss=config.link.on_link_loss,
            arm_interval_us=1000 * config.servos.arm_interval_ms,
            minimum_battery_mv=round(1000 * config.servos.minimum_battery_v),
            boot_us=round(1e6 * boot_s),
        )
