"""One style for all pictures: colours that differ in grey, fonts, units, how files are written."""

import math
import os
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np

mpl.use('Agg')

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d import Axes3D

from manipulator.errors import InvalidInput
from manipulator.formatting import reason

INK, SOFT, LIGHT, PAPER = '#22313f', '#4a5a6a', '#9aa5b1', '#ffffff'
LIMIT = '#b3261e'
AXES = ('#0b4f78', '#c75b28', '#8fb94b')
"""Of x, y and z: dark, middle and light, so that they differ in grey, too."""
JOINTS = ('#0b3d5c', '#2f7fb0', '#79b8c9', '#8a3b12', '#d1703d', '#e8ab6a')
DASHES = ('-', (0, (6, 2)), (0, (1.5, 1.5)))
JOINT_DASHES = (*DASHES, (0, (9, 3)), (0, (1, 2.5)), (0, (6, 2, 1, 2)))
"""Of x, y and z, and of joints: of curves on one another, as of a platform's mirrored legs, all
show, for those with wider gaps lie above.
"""
MAP, RATE_MAP = 'viridis', 'magma_r'
"""Both change evenly in brightness."""
FONT = {
    'font.size': 9, 'axes.titlesize': 10, 'legend.fontsize': 8, 'legend.frameon': False,
    'legend.handlelength': 3.0,
    'axes.spines.top': False, 'axes.spines.right': False, 'axes.edgecolor': SOFT,
    'text.color': INK, 'axes.labelcolor': INK, 'xtick.color': SOFT, 'ytick.color': SOFT,
    'grid.color': LIGHT, 'grid.alpha': 0.35, 'lines.linewidth': 1.3, 'savefig.facecolor': PAPER,
}  # fmt: skip
NEAR_LIMIT = 4.0
"""Times the largest value in view, so far a limit is drawn as a line."""
MOST_NUMBERS = 5
"""Beside the longest axis in space."""
BESIDE_NUMBERS = 9.0
"""Points from the axis z to its name, which is upright in a tall box."""
LEAST_SHARE = 0.35
"""Of the longest axis in space, what the others are at least."""
WIDTH = 11.0
"""Inches of a picture with several plots."""


def use() -> None:
    """Sets matplotlib's defaults; every picture begins with it."""
    plt.rcParams.update(FONT)


def title(figure: Figure, text: str, below: str = '') -> None:
    """At the top on the left, with a softer line below."""
    inch = 1.0 / figure.get_size_inches()[1]
    figure.text(0.02, 1.0 - 0.32 * inch, text, size=13, weight='bold')
    if below:
        figure.text(0.02, 1.0 - 0.57 * inch, below, color=SOFT)


def plotted(axes: Axes) -> Axes:
    """Axes with a grid."""
    axes.grid(True)
    return axes


def curve(k: int) -> dict[str, Any]:
    """How the k-th of some curves is drawn: six colours, six ways of dashes."""
    dashes = JOINT_DASHES[k % len(JOINT_DASHES)]
    return {'color': JOINTS[k % len(JOINTS)], 'ls': dashes, 'zorder': 3.0 - ink(dashes)}


def ink(dashes: Any) -> float:
    """Which share of a curve is not gaps."""
    return 1.0 if dashes == '-' else sum(dashes[1][::2]) / sum(dashes[1])


def axis(k: int) -> dict[str, Any]:
    """How x, y or z is drawn."""
    return {'color': AXES[k], 'ls': DASHES[k], 'lw': 1.5}


def space(axes: Axes3D, zoom: float = 0.9) -> None:
    """Axes in mm at one scale, with few numbers; after all was drawn on them."""
    axes.set(xlabel='x (mm)', ylabel='y (mm)', zlabel='z (mm)')
    ends = np.array([axes.get_xlim3d(), axes.get_ylim3d(), axes.get_zlim3d()])
    sizes = np.maximum(np.ptp(ends, axis=1), LEAST_SHARE * np.ptp(ends, axis=1).max())
    for name, middle, size in zip('xyz', ends.mean(axis=1), sizes, strict=True):
        getattr(axes, f'set_{name}lim3d')(middle - size / 2, middle + size / 2)
        numbers = MaxNLocator(max(2, round(MOST_NUMBERS * size / sizes.max())))
        getattr(axes, f'{name}axis').set_major_locator(numbers)
    axes.zaxis.labelpad = BESIDE_NUMBERS
    axes.set_box_aspect(sizes / sizes.max(), zoom=zoom)


def limits(axes: Axes, limit: float, unit: str) -> None:
    """Lines at ± a limit, in view if it is not four times further than the curves; in words."""
    if not math.isfinite(limit):
        return
    furthest = max(abs(end) for end in axes.get_ylim())
    text = f'limit ±{limit:.4g} {unit}'
    if limit > NEAR_LIMIT * furthest:
        axes.set_title(f'{text}, outside of the plot', loc='right', size=8, color=LIMIT)
        return
    axes.set_ylim(-max(furthest, 1.15 * limit), max(furthest, 1.15 * limit))
    for side in (-1.0, 1.0):
        axes.axhline(side * limit, color=LIMIT, lw=0.9, ls='--')
    axes.set_title(text, loc='right', size=8, color=LIMIT)


def save(figure: Figure, picture: Path) -> Path:
    """Writes the picture whole or not at all, and closes the figure; InvalidInput if it cannot."""
    part = picture.with_name(f'.{picture.stem}.part{picture.suffix}')
    try:
        figure.savefig(part)
        os.replace(part, picture)
    except (OSError, ValueError) as error:
        raise InvalidInput(f'cannot save {picture}: {reason(error)}') from error
    finally:
        plt.close(figure)
        part.unlink(missing_ok=True)
    return picture
