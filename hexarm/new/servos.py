"""Servos that hobby machines are made of, by their makers' data sheets."""

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


# Speeds are a sixth of a turn by the seconds that data sheets give for 60°, torques at the same
# voltage. Data sheets of analogue servos promise 1000 to 2000 µs; the pulses here are those in
# common use for the whole travel, of which a sample may be off by 100 µs: calibrate.
SERVOS = {
    # TowerPro SG90: 0.1 s/60° and 1.8 kg·cm at 4.8 V, 9 g.
    'SG90': Servo(600.0, 1.8 * KG_CM, 9.0, 180.0, (500.0, 2400.0), '4.8 V'),
    # TowerPro MG90S: 0.1 s/60° and 1.8 kg·cm at 4.8 V, 13.4 g.
    'MG90S': Servo(600.0, 1.8 * KG_CM, 13.4, 180.0, (500.0, 2400.0), '4.8 V'),
    # TowerPro MG996R: 0.14 s/60° and 11 kg·cm at 6 V, 55 g.
    'MG996R': Servo(428.6, 11.0 * KG_CM, 55.0, 180.0, (500.0, 2500.0), '6 V'),
    # Dsservo DS3218, 180° version: 0.14 s/60° and 21.5 kg·cm at 6.8 V, 60 g.
    'DS3218': Servo(428.6, 21.5 * KG_CM, 60.0, 180.0, (500.0, 2500.0), '6.8 V, 180° version'),
    # The 270° version.
    'DS3218-270': Servo(428.6, 21.5 * KG_CM, 60.0, 270.0, (500.0, 2500.0), '6.8 V, 270° version'),
    # ROBOTIS e-manual, XL330-M288-T: 103 rev/min and 0.52 N·m at 5 V, 18 g.
    'XL330': Servo(618.0, 0.52, 18.0, 360.0, None, 'XL330-M288-T at 5 V'),
    # Feetech STS3215, 12 V version (C018): 45 rev/min and 30 kg·cm, 55 g.
    'STS3215': Servo(270.0, 30.0 * KG_CM, 55.0, 360.0, None, '12 V version'),
}
