"""Monomials in a quaternion e = (e0, e1, e2, e3) and one more unknown s that weighs as much as e².

A polynomial of degree n is a row of coefficients: first those of the monomials of degree n in e,
then those of s times degree n − 2, then those of s² times degree n − 4. The basis monomials are
scaled by √(n!/α!), which makes the scalar product of two rows independent of the axes chosen for
e, so that no direction of rotation is favoured. See docs/forward-modes.md, section 4.
"""

import functools
import itertools
import math

import numpy as np
from numpy.typing import NDArray

from manipulator.arrays import Array, frozen

S_POWERS = 3
Indices = NDArray[np.int64]


@functools.cache
def exponents(degree: int) -> Indices:
    """The exponents (count, 4) of all monomials of one degree in e."""
    powers = itertools.product(range(degree + 1), repeat=4)
    return np.array([p for p in powers if sum(p) == degree], dtype=np.int64)


@functools.cache
def scales(degree: int) -> Array:
    """√(n!/α!) of each monomial e^α of degree n."""
    factorials = np.array([math.factorial(k) for k in range(degree + 1)], dtype=np.float64)
    return frozen(np.sqrt(factorials[degree] / np.prod(factorials[exponents(degree)], axis=1)))


@functools.cache
def product_index(left: int, right: int) -> Indices:
    """Where e^α·e^β, α of degree `left` and β of `right`, stands among degree left + right."""
    place = {tuple(p): k for k, p in enumerate(exponents(left + right).tolist())}
    sums = exponents(left)[:, None, :] + exponents(right)[None, :, :]
    flat = [place[tuple(p)] for p in sums.reshape(-1, 4).tolist()]
    return np.array(flat, dtype=np.int64).reshape(sums.shape[:2])


def evaluate(degree: int, e: Array) -> Array:
    """All monomials of one degree, unscaled, at the points e (m, 4): (m, count)."""
    values: Array = np.prod(e[:, None, :] ** exponents(degree), axis=2)
    return values


@functools.cache
def offsets(degree: int) -> tuple[int, ...]:
    """Where the blocks of s⁰, s¹ and s² begin in a row of that degree; last, the row's length."""
    sizes = [len(exponents(degree - 2 * power)) for power in range(S_POWERS)]
    return (0, *itertools.accumulate(sizes))


@functools.cache
def row_scales(degree: int) -> Array:
    """The scale of every basis monomial of a row."""
    return frozen(np.concatenate([scales(degree - 2 * power) for power in range(S_POWERS)]))


@functools.cache
def shift_table(degree: int) -> tuple[Indices, Array]:
    """How functionals on `degree` act on e_j times a polynomial of the degree below.

    Index and factor, (4, length of a row of degree − 1) each: the value on e_j·m is
    factor[j, m]·functional[index[j, m]].
    """
    units = np.argmax(exponents(1), axis=1)
    index = np.concatenate(
        [
            offsets(degree)[power] + product_index(1, degree - 1 - 2 * power)
            for power in range(S_POWERS)
        ],
        axis=1,
    )[np.argsort(units)]
    factor = row_scales(degree - 1) / row_scales(degree)[index]
    return index, frozen(factor)
