"""Solution of K x = load for the stiffness matrix K of a chain, with the same bits on every machine."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from scipy.sparse import csr_array

#: Rows and rings of up to this many blocks are solved by elimination.
ELIMINATION_LIMIT = 1024
#: Maximum number of corrections of a solution; each one adds several digits.
_CORRECTIONS = 20
#: Relative error at which a solution is correct to twice the precision of a double.
_TOLERANCE = 1e-31
_SPLITTER = 2.0**27 + 1.0
#: Share of elements other than 0 from which on a matrix is factorized as a full one.
_FULL = 0.25
#: Elements of a matrix that are multiplied at a time.
_ELEMENTS = 100_000


def solve_tridiagonal(diagonal: np.ndarray, strength: np.ndarray, load: np.ndarray) -> np.ndarray:
    """Solve a tridiagonal system by elimination; changes `load`.

    strength : of the spring from each block to the next one, shape (blocks,)

    LAPACK is not used because the last bit of its result depends on the memory addresses of its arguments: all results
    of a study would change with the folder in which it runs.
    """
    pivot = diagonal.copy()
    for i in range(1, len(load)):
        pivot[i] -= strength[i - 1] * strength[i - 1] / pivot[i - 1]
        load[i] += strength[i - 1] * load[i - 1] / pivot[i - 1]
    for i in range(len(load) - 1, -1, -1):
        load[i] = (load[i] + (strength[i] * load[i + 1] if i + 1 < len(load) else 0.0)) / pivot[i]
    return load


def solve_ring(diagonal: np.ndarray, strength: np.ndarray, load: np.ndarray) -> np.ndarray:
    """Solve the system of a ring, which is tridiagonal except for its corners, of strength strength[-1].

    The solution is periodic to the bit if the ring is, so that a periodic state stays periodic.
    """
    period = _period(np.array([diagonal, strength, load]))
    # The corners are a rank-one update: the Sherman-Morrison formula.
    pivot, corner = diagonal.copy(), np.zeros(len(load))
    for end in (0, -1):
        pivot[end] += strength[-1]
        corner[end] += 1.0
    load = solve_tridiagonal(pivot, strength, load)
    other = solve_tridiagonal(pivot, strength, corner)
    x = load + strength[-1] * other * (load[0] + load[-1]) / (1.0 - strength[-1] * (other[0] + other[-1]))
    return np.tile(x[:period], len(x) // period)


def _period(values: np.ndarray) -> int:
    """Return the smallest shift along a ring that leaves the values of its blocks, shape (n, blocks), unchanged."""
    blocks = values.shape[1]
    return next(shift for shift in range(1, blocks + 1) if np.array_equal(values, np.roll(values, shift, axis=1)))


def nearest_solution(matrix: csr_array, load: np.ndarray) -> np.ndarray:
    """Return the doubles nearest to the exact solution of a positive definite system.

    The rounding errors of SuperLU and LAPACK differ from run to run. Iterative refinement in twice the precision makes
    the result independent of them, and as symmetric as the system.

    Reference: N. J. Higham, Accuracy and Stability of Numerical Algorithms (2002), chapter 12.
    """
    solve = _approximate_solver(matrix)
    high, low, last = solve(load), np.zeros(len(load)), np.inf
    for _ in range(_CORRECTIONS):
        change = solve(_residual(matrix, load, high, low))
        size = float(np.abs(change).max())
        if not size < 0.5 * last:
            break
        last, low = size, low + change
        high, low = _sum(high, low)
        if size <= _TOLERANCE * float(np.abs(high).max()):
            break
    return high


def _approximate_solver(matrix: csr_array) -> Callable[[np.ndarray], np.ndarray]:
    if matrix.nnz > _FULL * matrix.shape[0] ** 2:
        from scipy.linalg import lu_factor, lu_solve

        return partial(lu_solve, lu_factor(matrix.toarray(), overwrite_a=True))
    from scipy.sparse.linalg import splu

    options = {"SymmetricMode": True, "Equil": False}
    factors = splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
    return factors.solve


def _sum(high: np.ndarray, low: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the rounded sum of large and small numbers, and its rounding error."""
    total = high + low
    return total, low - (total - high)


def _product(one: np.ndarray, other: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the rounded product and its rounding error (Dekker)."""
    product = one * other
    parts = []
    for factor in (one, other):
        upper = _SPLITTER * factor
        upper = upper - (upper - factor)
        parts.append((upper, factor - upper))
    (a, b), (c, d) = parts
    return product, ((a * c - product) + a * d + b * c) + b * d


def _residual(matrix: csr_array, load: np.ndarray, high: np.ndarray, low: np.ndarray) -> np.ndarray:
    """Return load − K (high + low), to twice the precision of a double.

    The terms of each row are split into parts whose sums are exact, so that their order does not matter (S. M. Rump,
    T. Ogita and S. Oishi, SIAM J. Sci. Comput. 31 (2008) 189). Few rows at a time need little memory.
    """
    rows = max(1, _ELEMENTS * len(load) // matrix.nnz)
    parts = (slice(begin, begin + rows) for begin in range(0, len(load), rows))
    # Bits by which a sum of the five terms of each element may be longer than a term.
    extra = int(np.ceil(np.log2(5 * np.diff(matrix.indptr).max()))) + 1
    return np.concatenate([_residual_of_rows(matrix[part], load[part], high, low, extra) for part in parts])


def _residual_of_rows(matrix: csr_array, load: np.ndarray, high: np.ndarray, low: np.ndarray, extra: int) -> np.ndarray:
    start, count = matrix.indptr[:-1], np.diff(matrix.indptr)
    first = np.zeros(matrix.nnz)
    first[start] = load
    products = (*_product(-matrix.data, high[matrix.indices]), *_product(-matrix.data, low[matrix.indices]))
    terms = np.stack([first, *products])
    total = np.zeros(len(load))
    for _ in range(3):
        largest = np.maximum.reduceat(np.abs(terms), start, axis=1).max(axis=0)
        unit = np.repeat(np.ldexp(1.0, np.frexp(largest)[1] + extra), count)
        part = (unit + terms) - unit
        total += np.add.reduceat(part, start, axis=1).sum(axis=0)
        terms = terms - part
    return total
