"""The kernel's functions (kernel/python.h): float64 arrays, C-contiguous, for one or N items."""

from manipulator.arrays import Array

def crank_inverse(
    legs: Array, position: Array, rotation: Array, near: Array | None, angles: Array
) -> int:
    """How many legs do not close; `angles` is written: see kernel/crank.h."""

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
) -> int:
    """Writes the part of a scaled twist; adds to `off_line` what is missed in dt, unscaled."""

def room_of(limits: Array, joints: Array, room: Array) -> int:
    """Writes what is left of the joint ranges: see kernel/rate_scaling.h."""

def scale_rates(
    limits: Array, room: Array, rates: Array, bend: Array, dt_and_slowing: Array, scale: Array
) -> int:
    """Writes the part of rates that can be driven, and what sets it."""

def follow_rates(
    limits: Array, room: Array, rates: Array, part_and_dt: Array, before: Array, joints: Array
) -> int:
    """Changes rates and joints to what they are dt later."""
