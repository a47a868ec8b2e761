"""Servos that hobby machines are made of; beside each row the sheet that states its numbers."""

from dataclasses import dataclass

KG_CM = 0.0980665
"""N·m."""


@dataclass(frozen=True)
class Servo:
    """One model: no-load speed in °/s, stall torque in N·m, mass in g, and a note on both.

    pulse_us are the pulses at the ends of travel_deg; None for a servo on a bus, which other
    software drives.
    """

    speed_deg_s: float
    torque_n_m: float
    mass_g: float
    travel_deg: float
    pulse_us: tuple[float, float] | None
    note: str

    @property
    def us_per_deg(self) -> float:
        """Of pulse per angle; 0 on a bus."""
        return (self.pulse_us[1] - self.pulse_us[0]) / self.travel_deg if self.pulse_us else 0.0


# Speed: a sixth of a turn by the seconds that the sheet gives for 60°; torque at the same voltage.
# Travel and pulses: makers of analogue servos promise 1000 to 2000 µs alone, over 90° to 120°.
# What follows is the whole travel as distributors' sheets state it; a sample may be off by 100 µs:
# calibrate (hexarm calibrate servos).
SERVOS = {
    # TowerPro, data sheet SG90 9 g Micro Servo: 0.1 s/60° and 1.8 kgf·cm at 4.8 V, 9 g, 180°.
    # Pulses 500 to 2400 µs: the same sheet as distributors print it.
    'SG90': Servo(600.0, 1.8 * KG_CM, 9.0, 180.0, (500.0, 2400.0), '4.8 V'),
    # TowerPro, data sheet MG90S: 0.1 s/60° and 1.8 kgf·cm at 4.8 V, 13.4 g, "approximately 180°".
    # No pulses: those of the SG90, whose electronics it has.
    'MG90S': Servo(600.0, 1.8 * KG_CM, 13.4, 180.0, (500.0, 2400.0), '4.8 V'),
    # TowerPro, data sheet MG996R High Torque: 0.14 s/60° and 11 kgf·cm at 6 V, 55 g. It promises
    # 120° (1000 to 2000 µs); distributors state 180° for 500 to 2500 µs.
    'MG996R': Servo(428.6, 11.0 * KG_CM, 55.0, 180.0, (500.0, 2500.0), '6 V'),
    # Dsservo, product specification DS3218: 0.14 s/60° and 21.5 kgf·cm at 6.8 V, 60 g, 180° or
    # 270° (two versions) for 500 to 2500 µs.
    'DS3218': Servo(428.6, 21.5 * KG_CM, 60.0, 180.0, (500.0, 2500.0), '6.8 V, 180° version'),
    'DS3218-270': Servo(428.6, 21.5 * KG_CM, 60.0, 270.0, (500.0, 2500.0), '6.8 V, 270° version'),
    # ROBOTIS e-Manual, XL330-M288-T, Specifications: 103 rev/min and 0.52 N·m at 5 V, 18 g, a
    # contactless encoder for 360°.
    'XL330': Servo(618.0, 0.52, 18.0, 360.0, None, 'XL330-M288-T at 5 V'),
    # Feetech, product specification STS3215-C018: 45 rev/min (0.222 s/60°) and 30 kgf·cm at 12 V,
    # 55 g, an encoder for 360°.
    'STS3215': Servo(270.0, 30.0 * KG_CM, 55.0, 360.0, None, '12 V version'),
}
