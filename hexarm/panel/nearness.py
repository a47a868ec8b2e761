"""What is near to meeting something, in the 3D view: sleeves around parts, boxes in their colour.

A sleeve is thicker than the part that it is around, so it is seen without colours as well.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from hexarm.panel.pieces import RADII, bar, bars_between
from hexarm.panel.room import COMFORTABLE, colour
from hexarm.panel.view import Stance
from manipulator.arrays import Array
from manipulator.limits.clearance import Clearance
from manipulator.machine import Machine

BOX_COLOUR = (120, 128, 138)
ROOM = 0.15
"""Of the machine's size: a clearance as wide as this, or as at home, is the whole of its room."""
SLEEVE = 1.7
"""Radius of a sleeve by that of its part."""


class Nearness:
    """Draws in a viser scene, lengths times `scale`; boxes are its obstacles by their number."""

    def __init__(
        self, scene: Any, machine: Machine, scale: float, boxes: Mapping[int, Any]
    ) -> None:
        limits = machine.constraints.limits
        self._clearance = next((one for one in limits if isinstance(one, Clearance)), None)
        self._kinematics, self._scale, self._boxes = machine.kinematics, scale, boxes
        if self._clearance is None:
            return
        self._hold(self._clearance)
        count = len(self._clearance.names)
        vertices, faces = bar()
        self._sleeves = scene.add_batched_meshes_simple(
            '/near', vertices, faces, np.tile([1.0, 0.0, 0.0, 0.0], (count, 1)),
            np.zeros((count, 3)), batched_scales=np.zeros((count, 3), dtype=np.float32),
            batched_colors=np.zeros((count, 3), dtype=np.uint8), opacity=0.8, lod='off',
            cast_shadow=False, receive_shadow=False,
        )  # fmt: skip

    def show(self, stance: Stance, tip: Array) -> None:
        """Of the machine at a stance; tip (3,) is the point of the tool in force, if any."""
        clearance = self._clearance
        if clearance is None:
            return
        if clearance.tip is not None and not np.array_equal(clearance.tip, tip):
            clearance = self._hold(replace(clearance, tip=tip))
        segments = clearance.segments(stance.pose, stance.joints)
        shares = clearance.distances(segments) / self._room
        of_parts, of_boxes = np.ones(len(clearance.names)), np.ones(len(clearance.obstacles))
        between, room = np.split(shares, [clearance.pairs.shape[1]])
        for side in clearance.pairs:
            np.minimum.at(of_parts, side, between)
        for found, side in zip((of_parts, of_boxes), clearance.faced, strict=True):
            np.minimum.at(found, side, room)
        self._put_sleeves(segments * self._scale, of_parts)
        for i, box in self._boxes.items():
            tint = colour(of_boxes[i]) if of_boxes[i] < COMFORTABLE else BOX_COLOUR
            if tuple(box.color) != tint:
                box.color = tint

    def _hold(self, clearance: Clearance) -> Clearance:
        """With the room that each clearance has, by what it is at home."""
        home = self._kinematics.home
        at_home = clearance.distances(clearance.segments(home, self._kinematics.inverse(home)))
        self._room = np.clip(at_home, 1e-6, ROOM / self._scale)
        self._clearance = clearance
        self._radii = SLEEVE * np.maximum(clearance.radii * self._scale, _drawn(clearance.names))
        return clearance

    def _put_sleeves(self, segments: Array, shares: Array) -> None:
        found = bars_between(segments[:, :3], segments[:, 3:], self._radii)
        is_near = shares < COMFORTABLE
        sizes = np.where(is_near[:, None], found.sizes, 0.0).astype(np.float32)
        if not is_near.any() and not self._sleeves.batched_scales.any():
            return
        self._sleeves.batched_positions = found.starts.astype(np.float32)
        self._sleeves.batched_wxyzs = found.wxyz.astype(np.float32)
        self._sleeves.batched_scales = sizes
        self._sleeves.batched_colors = np.array([colour(s) for s in shares], dtype=np.uint8)


def _drawn(names: Sequence[str]) -> list[float]:
    """The radii with which parts of these names are drawn."""
    usual = RADII['link' if any('link' in name for name in names) else 'rod']
    return [next((r for part, r in RADII.items() if part in name), usual) for name in names]
