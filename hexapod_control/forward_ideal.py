"""The polynomial equations of the forward problem, for any six leg lengths.

Unknowns: the rotation as a quaternion e of any length (N = e·e), and one coordinate s of the
platform's place; a second one, t, is eliminated here. docs/forward-modes.md derives every
equation; the numbers in brackets are its numbers.

Monomials in a quaternion e = (e0, e1, e2, e3) and one more unknown s that weighs as much as e².

A polynomial of degree n is a row of coefficients: first those of the monomials of degree n in e,
then those of s times degree n − 2, then those of s² times degree n − 4. The basis monomials are
scaled by √(n!/α!), which makes the scalar product of two rows independent of the axes chosen for
e, so that no direction of rotation is favoured. See docs/forward-modes.md, section 4.
"""

import functools
import itertools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from manipulator.arrays import Array, frozen
from manipulator.errors import NoSolution

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


@functools.cache
def multiples(degree: int, generators: tuple[tuple[int, int, int], ...]) -> 'Multiples':
    """Where every coefficient stands in the rows of all multiples of generators.

    generators are (degree, powers of s, count) of each group; the coefficients in a row, equation
    by equation, the powers of s one after the other.
    """
    start, scale = offsets(degree), row_scales(degree)
    rows, columns, sources, weights = [], [], [], []
    row = first = 0
    for own, powers, count in generators:
        sizes = [len(exponents(own - 2 * k)) for k in range(powers)]
        for power in range(min(S_POWERS + 1 - powers, (degree - own) // 2 + 1)):
            rest = degree - own - 2 * power
            factors = scales(rest)
            for equation in range(count):
                source = first + equation * sum(sizes)
                for k, size in enumerate(sizes):
                    column = start[power + k] + product_index(rest, own - 2 * k)
                    rows.append(np.repeat(row + np.arange(len(factors)), size))
                    columns.append(column.ravel())
                    sources.append(np.tile(source + np.arange(size), len(factors)))
                    weights.append((factors[:, None] / scale[column]).ravel())
                    source += size
                row += len(factors)
        first += count * sum(sizes)
    row_of, column_of, source_of = (np.concatenate(x) for x in (rows, columns, sources))
    weight = frozen(np.concatenate(weights))
    return Multiples(row, start[-1], row_of, column_of, source_of, weight)


@dataclass(frozen=True, eq=False)
class Multiples:
    """A sparse matrix (rows, columns): at (row[i], column[i]) stands weight[i] times the
    coefficient source[i] of the generators.
    """

    rows: int
    columns: int
    row: Indices
    column: Indices
    source: Indices
    weight: Array

    def mixed(self, coefficients: Array, count: int) -> Array:
        """(columns, count): the rows added up in `count` fixed groups, with fixed signs, as
        columns; in each of them hardly more than the space of all rows is missed.
        """
        place, source, weight = _groups(self, count)
        values = coefficients[source]
        values *= weight
        return np.asarray(np.bincount(place, values, self.columns * count).reshape(count, -1).T)


@functools.lru_cache(maxsize=1)
def _groups(multiples: Multiples, count: int) -> tuple[Indices, Indices, Array]:
    """Of every coefficient its place, its source and its weight in `Multiples.mixed`."""
    random = np.random.default_rng(4)
    group = random.permutation(np.resize(np.arange(count), multiples.rows))
    sign = random.choice([-1.0, 1.0], multiples.rows)
    place = group[multiples.row] * multiples.columns + multiples.column
    weight = multiples.weight * sign[multiples.row]
    order = np.argsort(place)
    return place[order], multiples.source[order], frozen(weight[order])


HIGHEST = 6
LEAST_RANK_VALUE = 1e-9


GENERATORS = ((3, 2, 4), (4, 2, 6), (6, 3, 20))
"""Degree, powers of s and number of the cubics (8), quartics (7) and sextics (9)."""


@dataclass(frozen=True, eq=False)
class LegEquations:
    """Base and platform joints seen from leg 1's, and the linear part of the leg equations.

    a, b (5, 3) and the first length are in units of `scale` metres. The leg equations (3) are
    K·(p, w) + q(e) = 0 with K = u·diag(sigma)·v, and (p, w) = s·kappa1 + t·kappa2 + Q(e) (5).
    """

    a: Array
    b: Array
    d: Array
    length: float
    scale: float
    u: Array
    sigma: Array
    v: Array
    kappa1: Array
    kappa2: Array

    @classmethod
    def of(cls, base_points: Array, platform_points: Array, lengths: Array) -> 'LegEquations':
        """From joints (6, 3) and lengths (6,) in metres.

        Raises NoSolution where the platform's joints are an affine image of the base's.
        """
        a, b = base_points[1:] - base_points[0], platform_points[1:] - platform_points[0]
        scale = float(np.sqrt((np.sum(a * a) + np.sum(b * b)) / 6))
        a, b, legs = a / scale, b / scale, lengths / scale
        d = (legs[0] ** 2 + np.sum(a * a, axis=1) + np.sum(b * b, axis=1) - legs[1:] ** 2) / 2
        u, sigma, v = np.linalg.svd(np.hstack([-a, b]))
        if sigma[3] < LEAST_RANK_VALUE * sigma[0]:
            raise NoSolution(
                'the joints of base and platform are affine images of each other: '
                'their modes are infinitely many, or not to be found by this method'
            )
        # In the plane of the two weakest directions, t takes the one on which p and w differ
        # most in length: there u2(e) below never vanishes for a real e.
        weakest = v[4:]
        unlike = (weakest * [-1.0, -1.0, -1.0, 1.0, 1.0, 1.0]) @ weakest.T
        values, turns = np.linalg.eigh(unlike)
        kappa = turns[:, np.argsort(np.abs(values))].T @ weakest
        return cls(a, b, d, float(legs[0]), scale, u, sigma, v, kappa[0], kappa[1])

    def coefficients(self) -> Array:
        """Of the cubics (8), quartics (7) and sextics (9), in the order of `multiples`.

        Every equation is scaled to a length of 1, unless it is empty.
        """
        parts = []
        _, fits = _samples()
        for (degree, _, _), values in zip(GENERATORS, self._values(), strict=True):
            fitted = [(fits[degree - 2 * k] @ x).T for k, x in enumerate(values)]
            rows = np.concatenate(fitted, axis=1)
            lengths = np.sqrt((rows * rows).sum(axis=1, keepdims=True))
            parts.append((rows / np.where(lengths > np.finfo(float).tiny, lengths, 1.0)).ravel())
        return np.concatenate(parts)

    def _values(self) -> list[tuple[Array, ...]]:
        """The generators at the sample points (m, count), one array for each power of s."""
        e, _ = _samples()
        n, q5, Q, u1, u2, c = self._parts(e)
        alpha, beta = self.sigma[4] * self.v[4] @ np.stack([self.kappa1, self.kappa2]).T
        i, j = np.triu_indices(4, 1)
        cubics = (q5[:, None] * u2 - beta * c, alpha * u2 - beta * u1)
        quartics = tuple(x[:, i] * u2[:, j] - x[:, j] * u2[:, i] for x in (c, u1))
        products = _products(u1, u2, c)
        both = [self._sextics(n, Q[:, part], products, part) for part in (_P, _W)]
        sextics = tuple(np.hstack(pair) for pair in zip(*both, strict=True))
        return [cubics, quartics, sextics]

    def _parts(self, e: Array) -> tuple[Array, Array, Array, Array, Array, Array]:
        """N, the fifth row q5 of (4), Q of (5), and u1, u2, c of (6), at the points e (m, 4)."""
        n = np.sum(e * e, axis=1)
        pairs = (self.a[:, :, None] * self.b[:, None, :]).reshape(-1, 9)
        q = n[:, None] * self.d - turned(e).reshape(-1, 9) @ pairs.T
        y = q @ self.u
        Q = -(y[:, :4] / self.sigma[:4]) @ self.v[:4]
        u1, u2, c = (_closure(e, x) for x in (self.kappa1, self.kappa2, Q))
        return n, y[:, 4], Q, u1, u2, c

    def _sextics(
        self, n: Array, Q: Array, products: tuple[Array, ...], part: slice
    ) -> tuple[Array, Array, Array]:
        """|p|² = N²·L1² (or |w|²) times u2_i·u2_j, with t·u2 replaced by −(s·u1 + c): (9)."""
        u1u1, u1u2, u2u2, cu1, cu2, cc = products
        x1, x2 = self.kappa1[part], self.kappa2[part]
        q1, q2 = (Q @ x1)[:, None], (Q @ x2)[:, None]
        rest = (np.sum(Q * Q, axis=1) - (self.length * n) ** 2)[:, None]
        x12, x22 = x1 @ x2, x2 @ x2
        return (
            rest * u2u2 - 2 * q2 * cu2 + x22 * cc,
            2 * (q1 * u2u2 - q2 * u1u2 - x12 * cu2 + x22 * cu1),
            x1 @ x1 * u2u2 - 2 * x12 * u1u2 + x22 * u1u1,
        )


_P, _W = slice(0, 3), slice(3, 6)


def _products(u1: Array, u2: Array, c: Array) -> tuple[Array, ...]:
    """(x_i·y_j + x_j·y_i)/2 for i ≤ j (m, 10), of u1 u1, u1 u2, u2 u2, c u1, c u2 and c c."""
    i, j = np.triu_indices(4)
    x = np.stack([u1, u1, u2, c, c, c])
    y = np.stack([u1, u2, u2, u1, u2, c])
    return tuple((x[..., i] * y[..., j] + x[..., j] * y[..., i]) / 2)


def turned(e: Array) -> Array:
    """N times the rotation matrix of quaternions e = (scalar, vector), (m, 4) to (m, 3, 3)."""
    w, x, y, z = e.T
    rows = [
        [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
    ]
    return np.moveaxis(np.array(rows), -1, 0)


def _closure(e: Array, pw: Array) -> Array:
    """The quaternion e·w − p·e, (m, 4), for (p, w) = pw (6,) or (m, 6): zero where w = Rᵀp."""
    pw = np.broadcast_to(pw, (len(e), 6))
    p, w, x = pw[:, :3], pw[:, 3:], e[:, 1:]
    scalar = np.sum((p - w) * x, axis=1)
    vector = e[:, :1] * (w - p) + np.cross(x, w + p)
    return np.column_stack([scalar, vector])


@functools.cache
def _samples() -> tuple[Array, tuple[Array, ...]]:
    """Fixed points e, and for each degree the matrix from values there to coefficients."""
    count = 2 * len(exponents(HIGHEST))
    e = np.random.default_rng(1).normal(size=(count, 4))
    e /= np.linalg.norm(e, axis=1)[:, None]
    fits = (np.linalg.pinv(evaluate(k, e)) for k in range(HIGHEST + 1))
    return frozen(e), tuple(frozen(f) for f in fits)
