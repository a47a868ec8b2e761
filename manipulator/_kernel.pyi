"""The kernel's functions (kernel/python.h): float64 arrays, C-contiguous, for one or N items.

Those named after what they write fill it in. Shapes are those of one item; see kernel/*.h.
"""

from manipulator.arrays import Array

def leg_inverse(
    legs: Array, position: Array, rotation: Array, near: Array | None, joints: Array
) -> int:
    """How many legs do not close; `joints` is written: see kernel/legs.h."""

def leg_branches(legs: Array, position: Array, rotation: Array, out: Array, inside: Array) -> int:
    """How many legs do not close; both joints are written: kernel/legs.h."""

def leg_points(legs: Array, joints: Array, points: Array) -> int:
    """0; `points` (6, 3) is written: kernel/legs.h."""

def leg_gains(legs: Array, joints: Array, units: Array, gains: Array) -> int:
    """0; `gains` is written: kernel/legs.h."""

def screw_turns(legs: Array, position: Array, rotation: Array, extra: Array, rows: Array) -> int:
    """0; `extra` (6) and `rows` (6, 6) are written: kernel/screws.h."""

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

def stack_sections(
    stack: Array,
    is_row: Array,
    position: Array,
    rotation: Array,
    free: Array,
    positions: Array,
    rotations: Array,
    settled: Array,
) -> int:
    """0; the last four are written, `free` says where the descent begins: kernel/stack.h."""

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

def quaternion_of(rotation: Array, quaternion: Array) -> int:
    """0; `quaternion` is written: kernel/se3.h."""

def rotation_of(tolerance: Array, quaternion: Array, rotation: Array) -> int:
    """How many quaternions are not of length one within the tolerance; `rotation` is written."""

def moved(
    position: Array, rotation: Array, twist: Array, new_position: Array, new_rotation: Array
) -> int:
    """How many poses are not finite; the last two are written: kernel/se3.h."""

def twist_between(
    position: Array, rotation: Array, to_position: Array, to_rotation: Array, twist: Array
) -> int:
    """0; `twist` is written: kernel/se3.h."""

def chain_forward(chain: Array, joints: Array, position: Array, rotation: Array) -> int:
    """How many poses are not finite; both are written: see kernel/chain.h."""

def chain_displacements(chain: Array, joints: Array, moved: Array) -> int:
    """Writes seven 4 × 4 matrices an item."""

def chain_jacobian(chain: Array, joints: Array, jacobian: Array) -> int:
    """Writes it."""

def chain_sigma_min(chain: Array, length: Array, joints: Array, sigma: Array) -> int:
    """Writes the smallest singular value of each Jacobian, its metres divided by length (1,)."""

def closed_branches(
    form: Array, position: Array, rotation: Array, near: Array, branches: Array
) -> int:
    """Writes eight rows an item: see kernel/closed_forms.h."""

def closed_gap(form: Array, position: Array, rotation: Array, gap: Array) -> int:
    """Writes four numbers an item: see `struct gap`."""

def arm_branches(
    arm: Array, position: Array, rotation: Array, near: Array, branches: Array
) -> int:
    """Writes sixteen rows an item, unwrapped: see kernel/arm.h."""

def arm_inverse(arm: Array, position: Array, rotation: Array, near: Array, joints: Array) -> int:
    """How many poses have no branch; `joints` is written."""

def general_candidates(
    chain: Array, length_and_first: Array, position: Array, rotation: Array, candidates: Array
) -> int:
    """For how many poses they are certain; writes 48 rows an item: see kernel/general.h."""

def arm_miss(arm: Array, position: Array, rotation: Array, miss: Array) -> int:
    """Writes the twist that is left after the best attempt."""

def arm_along(arm: Array, near: Array, position: Array, rotation: Array, joints: Array) -> int:
    """Writes the joints of a row of poses."""

def decompose(chain: Array, length: Array, joints: Array, decomposed: Array) -> int:
    """Writes Jacobians and their singular values: see kernel/line_keeping.h."""

def turning(decomposed: Array, rates: Array, acceleration: Array) -> int:
    """Writes the tool's acceleration at constant joint rates."""

def line_rates(
    decomposed: Array, onset: Array, twist: Array, off_line: Array | None, line: Array
) -> int:
    """Writes what a scaled twist needs of the joints: see `struct line`."""

def damped_rates(decomposed: Array, onset: Array, twist: Array, rates: Array) -> int:
    """Writes them."""

def part_driven(
    decomposed: Array,
    length_and_dt: Array,
    twist: Array,
    rates: Array,
    off_line: Array,
    part: Array,
    moving: Array,
) -> int:
    """Writes the part of a scaled twist that `rates` drive, and their own twist, unscaled.

    Adds to `off_line` what is missed in dt, unscaled.
    """

def scale_rates(
    limits: Array, joints: Array, rates: Array, bend: Array, dt_and_slowing: Array, scale: Array
) -> int:
    """Writes the part of rates that can be driven, and what sets it."""

def follow_rates(
    limits: Array, rates: Array, part_and_dt: Array, before: Array, joints: Array
) -> int:
    """Changes rates and joints to what they are dt later."""

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

def first_free_path(
    platform: Array,
    ranges: Array,
    frame: Array,
    bounds: Array,
    position: Array,
    rotation: Array,
    joints: Array,
    rates: Array,
    twists: Array,
    paths: Array,
) -> int:
    """The first of the twists that can be braked, or how many there are: kernel/braking.h."""

def segment_distance(first: Array, second: Array, distance: Array) -> int:
    """0; `distance` is written: kernel/capsules.h."""

def box_clearance(segment: Array, box: Array, clearance: Array) -> int:
    """0; `clearance` is written: kernel/capsules.h."""
