"""The kernel's functions (kernel/python.h): float64 arrays, C-contiguous, for one or N items.

Those named after what they write fill it in. Shapes are those of one item; see kernel/*.h.
"""

from manipulator.arrays import Array

def crank_inverse(
    legs: Array, position: Array, rotation: Array, near: Array | None, angles: Array
) -> int:
    """How many legs do not close; `angles` is written: see kernel/crank.h."""

def crank_elbows(legs: Array, position: Array, rotation: Array, out: Array, inside: Array) -> int:
    """How many legs do not close; both angles are written: kernel/crank.h."""

def linear_inverse(legs: Array, position: Array, rotation: Array, lengths: Array) -> int:
    """0; `lengths` is written: kernel/crank.h."""

def base_points(legs: Array, joints: Array, points: Array) -> int:
    """0; `points` (6, 3) is written: kernel/rods.h."""

def crank_gains(legs: Array, joints: Array, units: Array, gains: Array) -> int:
    """0; `gains` is written: kernel/rods.h."""

def leg_jacobian(
    platform_points: Array,
    base_points: Array,
    position: Array,
    rotation: Array,
    units: Array,
    jacobian: Array,
) -> int:
    """0; `units` (6, 3) and `jacobian` (6, 6) are written: kernel/rods.h."""

def smallest_singular_value(length: Array, jacobian: Array, sigma: Array) -> int:
    """0; `sigma` is written: kernel/matrix6.h."""

def forward_by_lengths(
    platform_points: Array,
    rules: Array,
    base_points: Array,
    lengths: Array,
    start_position: Array,
    start_rotation: Array,
    position: Array,
    rotation: Array,
    report: Array,
) -> int:
    """0; the last three are written: kernel/newton.h."""

def platform_forward(
    platform: Array,
    rules: Array,
    joints: Array,
    start_position: Array,
    start_rotation: Array,
    position: Array,
    rotation: Array,
    report: Array,
) -> int:
    """0; the last three are written: kernel/platform.h."""

def limited_values(
    platform: Array, position: Array, rotation: Array, joints: Array, values: Array
) -> int:
    """0; `values` is written: kernel/limits.h."""

def limit_ranges(platform: Array, low: Array, high: Array, ranges: Array) -> int:
    """0; `ranges` is written: kernel/limits.h."""

def keeps_limits(
    platform: Array, ranges: Array, position: Array, rotation: Array, joints: Array, kept: Array
) -> int:
    """How many configurations keep all ranges; `kept` is 1 for these and 0 for others."""

def rotation_exp(vector: Array, rotation: Array) -> int:
    """0; `rotation` is written: kernel/se3.h."""

def rotation_log(rotation: Array, vector: Array) -> int:
    """0; `vector` is written: kernel/se3.h."""

def moved(
    position: Array, rotation: Array, twist: Array, new_position: Array, new_rotation: Array
) -> int:
    """How many poses are not finite; the last two are written: kernel/se3.h."""

def twist_between(
    position: Array, rotation: Array, to_position: Array, to_rotation: Array, twist: Array
) -> int:
    """0; `twist` is written: kernel/se3.h."""

def least_distance(target: Array, normals: Array, slack: Array, multipliers: Array) -> int:
    """1 where a point is found, else 0; `multipliers` are written: kernel/least_distance.h."""

def descended(
    platform: Array,
    low: Array,
    high: Array,
    pivot: Array,
    clearance_and_steps: Array,
    target_position: Array,
    target_rotation: Array,
    start_position: Array,
    start_rotation: Array,
    position: Array,
    rotation: Array,
) -> int:
    """0; the last two are written: kernel/descent.h."""

def first_free_way(
    platform: Array,
    ranges: Array,
    frame: Array,
    bounds: Array,
    position: Array,
    rotation: Array,
    joints: Array,
    rates: Array,
    twists: Array,
    ways: Array,
) -> int:
    """The first of the twists that can be braked, or how many there are: kernel/braking.h."""
