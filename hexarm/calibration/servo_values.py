"""What a walk through the servos has found, as values of the machine file."""

from bridge.servo_config import ServoConfig
from manipulator.yaml_edit import Place

FIELDS = ('sign', 'centre_us', 'centre_deg', 'centre_mm', 'us_per_deg', 'us_per_mm')


def changed_values(
    before: tuple[ServoConfig, ...], after: tuple[ServoConfig, ...]
) -> dict[Place, str]:
    """Where the machine file changes, and to what."""
    found: dict[Place, str] = {}
    for i, (old, new) in enumerate(zip(before, after, strict=True)):
        place: Place = ('servos', 'joints', i)
        for name in FIELDS:
            if getattr(old, name) != getattr(new, name):
                field = (*place, name)
                found[field] = str(getattr(new, name))
        for end, (was, now) in enumerate(zip(old.pulse_range_us, new.pulse_range_us, strict=True)):
            if was != now:
                bound = (*place, 'pulse_range_us', end)
                found[bound] = str(now)
    return found


def in_words(before: tuple[ServoConfig, ...], after: tuple[ServoConfig, ...]) -> list[str]:
    """One line a value that has changed."""
    lines = []
    for old, new in zip(before, after, strict=True):
        for name in (*FIELDS, 'pulse_range_us'):
            was, now = getattr(old, name), getattr(new, name)
            if was != now:
                lines.append(f'  {old.name} {name}: {_text(was)} → {_text(now)}')
    return lines


def _text(value: object) -> str:
    if isinstance(value, tuple):
        return f'[{", ".join(f"{end:g}" for end in value)}]'
    return f'{value:g}' if isinstance(value, int | float) else str(value)
