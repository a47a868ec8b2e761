"""Machine files of kinds of legs that no shipped machine has."""

from pathlib import Path

FOLDER = Path(__file__).parent / 'machines'
TILTED_CRANKS, FLAT_CRANKS, RAILS, HANGING_LEGS, SCREW_LEGS = (
    str(FOLDER / f'{name}.yaml')
    for name in ('tilted_cranks', 'flat_cranks', 'rails', 'hanging_legs', 'screw_legs')
)
