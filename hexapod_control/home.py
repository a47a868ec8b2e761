"""What is wrong with a platform's home, in the words and units of its machine file."""

import numpy as np

from hexapod_control.rails import RailPlatform
from hexapod_control.rotary import RotaryHexapod
from manipulator.limits.wording import degrees_in_words, in_words
from manipulator.machine import Machine

PAGE = 'docs/machine-files.md, Cranks bent the other way'


def home_problems(machine: Machine, has_tangents: bool = True) -> list[str]:
    """One sentence for each limit that home is beyond, and what to write for the other bend.

    has_tangents: the file has the key crank_tangents.
    """
    kinematics = machine.kinematics
    home = kinematics.home
    found = machine.constraints.violations(home, kinematics.inverse(home))
    problems = [f'limits: home has {words}' for words in in_words(found)]
    if isinstance(kinematics, RotaryHexapod) and len({v.quantity for v in found}) == 1:
        bend = _other_bend(machine, kinematics, has_tangents)
        return [problems[0] + bend] if bend else problems
    if isinstance(kinematics, RailPlatform) and problems:
        problems[0] += _other_side(machine, kinematics)
    return problems


def _other_side(machine: Machine, kinematics: RailPlatform) -> str:
    """What to write for carriages that are out of range, and in it on their joints' other side."""
    low, high = machine.joint_ranges
    joints, other = kinematics.legs.branches(kinematics.home)
    is_out = (joints < low) | (joints > high)
    if not is_out.any() or not ((other >= low) & (other <= high))[is_out].all():
        return ''
    sides = kinematics.geometry.sides * np.where(is_out, -1.0, 1.0)
    words = ', '.join('behind' if side > 0.0 else 'ahead' for side in sides)
    places = ', '.join(f'{1e3 * place:.6g}' for place in other[is_out])
    return f"; on their joints' other side they are at {places} mm: write carriages: [{words}]"


def _other_bend(machine: Machine, kinematics: RotaryHexapod, has_tangents: bool) -> str:
    """What to write for cranks that are all out of range, and in it if bent the other way."""
    low, high = machine.joint_ranges
    bends = kinematics.inverse_all(kinematics.home)
    joints, other = bends[0], bends[-1]
    is_other = ((joints < low) | (joints > high)) & (other >= low) & (other <= high)
    if not is_other.all():
        return ''
    turned = 180.0 - np.degrees(np.stack([high, low], axis=1))
    pairs = [f'[{first:.6g}, {last:.6g}]' for first, last in turned]
    ends = pairs[0] if len(set(pairs)) == 1 else f'[{", ".join(pairs)}]'
    write = (
        'negate the crank_tangents (and crank_axes, if there are any) and count the angles '
        f'from there: crank_range_deg: {ends}, '
        'centre_deg and park_deg 180 minus what they are, and each sign the other'
    )
    if not has_tangents:
        write = 'give the geometry by coordinates, with crank_tangents'
    angles = degrees_in_words(other)
    return f'; bent the other way it is {angles} on all legs: {write} ({PAGE})'
