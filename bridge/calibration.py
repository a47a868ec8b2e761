"""Joint positions to counts on the wire and back: sign, centre, scale and range of each servo."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from bridge.servo_config import ServoConfig, ServosConfig
from manipulator.arrays import Array, frozen
from manipulator.errors import ConfigError, InvalidInput
from manipulator.formatting import counted

COUNTS_PER_US = 2.0


class OutOfRange(InvalidInput):
    """A position beyond the range of a servo; `joint` holds its name."""

    def __init__(self, message: str, joint: str) -> None:
        super().__init__(message)
        self.joint = joint


@dataclass(frozen=True)
class Calibration:
    """All joints of a machine. Positions in rad (or m), in the machine file's order of `names`;
    counts in the order of the board's channels.

    scale in counts per rad (or m), signed; `lowest` and `highest` are the pulse range in counts;
    speed is the servos' rated speed in rad/s (or m/s).
    """

    names: tuple[str, ...]
    unit: str
    channels: tuple[int, ...]
    centre: Array
    centre_count: Array
    scale: Array
    lowest: tuple[int, ...]
    highest: tuple[int, ...]
    park: Array
    speed: float

    @classmethod
    def from_config(cls, config: ServosConfig) -> 'Calibration':
        """SI units and radians; ConfigError where the park position cannot be reached."""
        is_linear = config.joints[0].is_linear
        per_unit = 1e-3 if is_linear else np.radians(1.0)
        park = config.park_mm if is_linear else config.park_deg
        speed = config.speed_mm_s if is_linear else config.speed_deg_s
        calibration = cls(
            names=tuple(joint.name for joint in config.joints),
            unit='m' if is_linear else 'rad',
            channels=tuple(joint.channel for joint in config.joints),
            centre=frozen([joint.centre * per_unit for joint in config.joints]),
            centre_count=frozen([COUNTS_PER_US * joint.centre_us for joint in config.joints]),
            scale=frozen([_counts_per_config_unit(j) / per_unit for j in config.joints]),
            lowest=tuple(_count(joint.pulse_range_us[0]) for joint in config.joints),
            highest=tuple(_count(joint.pulse_range_us[1]) for joint in config.joints),
            park=frozen(np.array(park) * per_unit),
            speed=float(speed or 0.0) * per_unit,
        )
        try:
            calibration.counts(calibration.park)
        except OutOfRange as error:
            raise ConfigError([f'servos.park: {error}']) from error
        return calibration

    def counts(self, positions: ArrayLike) -> tuple[int, ...]:
        """What goes on the wire; the whole vector is refused where one joint cannot be there.

        InvalidInput names the joint where a position is not finite, OutOfRange where it is
        beyond the servo's pulse range.
        """
        target = np.asarray(positions, dtype=np.float64)
        if target.shape != (len(self.names),):
            raise InvalidInput(f'{counted(target.size, "position")}, needs {len(self.names)}')
        exact = self._exact_counts(target)
        for i, count in enumerate(exact):
            if not self.lowest[i] - 0.5 <= count <= self.highest[i] + 0.5:
                raise self._refusal(i, float(target[i]))
        on_wire = [0] * len(exact)
        for i, channel in enumerate(self.channels):
            on_wire[channel] = min(max(round(exact[i]), self.lowest[i]), self.highest[i])
        return tuple(on_wire)

    def nearest_counts(self, positions: Array) -> tuple[int, ...]:
        """Counts in channel order, of positions that need not be within the pulse ranges."""
        exact, on_wire = self._exact_counts(positions), [0] * len(positions)
        for i, channel in enumerate(self.channels):
            on_wire[channel] = round(exact[i])
        return tuple(on_wire)

    def positions(self, counts: Sequence[float]) -> Array:
        """Positions of all joints from counts in channel order."""
        ordered = np.array([counts[channel] for channel in self.channels], dtype=np.float64)
        return self.centre + (ordered - self.centre_count) / self.scale

    @property
    def count_ranges(self) -> tuple[tuple[int, int], ...]:
        """Lowest and highest count of each channel, as the board knows them."""
        by_channel = sorted(zip(self.channels, self.lowest, self.highest, strict=True))
        return tuple((low, high) for _, low, high in by_channel)

    @property
    def count_speeds(self) -> tuple[float, ...]:
        """Rated speed of each channel in counts per second."""
        by_channel = sorted(zip(self.channels, np.abs(self.scale).tolist(), strict=True))
        return tuple(scale * self.speed for _, scale in by_channel)

    def range_of(self, i: int) -> tuple[float, float]:
        """Lowest and highest position of joint i."""
        ends = [
            float(self.centre[i] + (count - self.centre_count[i]) / self.scale[i])
            for count in (self.lowest[i], self.highest[i])
        ]
        return min(ends), max(ends)

    def _exact_counts(self, positions: Array) -> list[float]:
        exact: list[float] = (self.centre_count + self.scale * (positions - self.centre)).tolist()
        return exact

    def _refusal(self, i: int, value: float) -> InvalidInput:
        if not np.isfinite(value):
            return InvalidInput(f'{self.names[i]}: {value} is not finite')
        low, high = self.range_of(i)
        text = f'{self.names[i]}: {value:.4g} {self.unit} outside [{low:.4g}, {high:.4g}]'
        return OutOfRange(text, self.names[i])


def _count(pulse_us: float) -> int:
    return round(COUNTS_PER_US * pulse_us)


def _counts_per_config_unit(joint: ServoConfig) -> float:
    scale = joint.us_per_mm if joint.us_per_mm is not None else joint.us_per_deg or 0.0
    return COUNTS_PER_US * joint.sign * scale
