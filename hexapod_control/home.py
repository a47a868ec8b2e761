"""What is wrong with a platform's home, in the words and units of its machine file."""

import numpy as np

from hexapod_control.rails import RailPlatform
from hexapod_control.rotary import RotaryHexapod
from manipulator.limits.wording import degrees_in_words, in_words, millimetres_in_words
from manipulator.machine import Machine

OF_A_BEND = ('crank angle', 'crank joint tilt', 'platform joint swing', 'singularity margin')
"""What is different where a crank is bent the other way."""
PAGE = 'docs/machine-files.md, Cranks bent the other way'


def home_problems(machine: Machine, has_tangents: bool = True) -> list[str]:
    """One sentence for each limit that home is beyond, and what to write for the other bend.

    has_tangents: the file has the key crank_tangents.
    """
    kinematics = machine.kinematics
    home = kinematics.home
    found = machine.constraints.violations(home, kinematics.inverse(home))
    angles, bend = in_words(v for v in found if v.quantity == OF_A_BEND[0]), ''
    if angles and isinstance(kinematics, RotaryHexapod):
        bend = _other_bend(machine, kinematics, has_tangents)
    if bend:
        others = in_words(v for v in found if v.quantity not in OF_A_BEND)
        return [f'limits: home has {words}' for words in (angles[0] + bend, *others)]
    problems = [f'limits: home has {words}' for words in in_words(found)]
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
    words = ['behind' if side > 0.0 else 'ahead' for side in sides]
    write = words[0] if len(set(words)) == 1 else f'[{", ".join(words)}]'
    places = millimetres_in_words(other[is_out])
    return f"; on their joints' other side they are at {places}: write carriages: {write}"


def _other_bend(machine: Machine, kinematics: RotaryHexapod, has_tangents: bool) -> str:
    """What to write for cranks that are out of range, and in it if bent the other way."""
    low, high = machine.joint_ranges
    bends = kinematics.inverse_all(kinematics.home)
    joints, other = bends[0], bends[-1]
    is_out = (joints < low) | (joints > high)
    if not is_out.any() or not ((other >= low) & (other <= high))[is_out].all():
        return ''
    ranges = np.degrees(np.stack([low, high], axis=1))
    turned = np.where(is_out[:, None], 180.0 - ranges[:, ::-1], ranges)
    pairs = [f'[{first:.6g}, {last:.6g}]' for first, last in turned]
    ends = pairs[0] if len(set(pairs)) == 1 else f'[{", ".join(pairs)}]'
    write = (
        'negate their crank_tangents (and crank_axes, if there are any) and count the angles '
        f'from there: crank_range_deg: {ends}, '
        'centre_deg and park_deg of these legs 180 minus what they are, and each sign the other'
    )
    if not has_tangents:
        write = 'give the geometry by coordinates, with crank_tangents'
    angles, legs = degrees_in_words(other[is_out]), np.flatnonzero(is_out) + 1
    where = 'all legs' if is_out.all() else f'legs {", ".join(map(str, legs))}'
    return f'; bent the other way it is {angles} on {where}: {write} ({PAGE})'
