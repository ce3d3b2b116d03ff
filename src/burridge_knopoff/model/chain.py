"""The chain: blocks held by static friction and coupled by springs to their neighbours and to the driver."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated

import numpy as np

from burridge_knopoff.model.fields import check_fields, settings
from burridge_knopoff.model.ranges import Either, Number, OneOf, Several, Whole
from burridge_knopoff.values import read_only

MAXIMUM_BLOCKS = 1024
ENDS = ("open", "ring")
NEIGHBOURS = "neighbours"

#: Spring constants or thresholds: one number for all, or a list with one number each.
Numbers = float | Sequence[float]
_STRENGTH = Number(1e-6, 1e6)
_STRENGTHS = Either((_STRENGTH, Several(_STRENGTH)))
_PULLING = Number(1e-6, 1e6, or_zero=True)


@settings
@dataclass(frozen=True)
class Chain:
    """N blocks of equal mass in a row or in a ring.

    A row has N − 1 springs between neighbours. A ring has N: the last spring joins the last block to the first. A
    slipping block feels the friction threshold · Φ.

    The spring force on block i is s_i = D_i vτ − (K U)_i, where K is the graph Laplacian of the springs plus diag(D),
    so that K·1 = D. The defaults give the paper's chain (Eq. 2) for N = 3. The train model that the paper cites is
    pulled at its first block only: `Chain(2, pulling=(1.0, 0.0))`. A single block hangs on one spring to the driver.

    Raises ValueError for a number of blocks, a number of springs or a strength out of range, and if no block is pulled,
    since K is then singular.

    Positions are in units of F(0)/k, strengths in units of the paper's spring constant k (its Section II), thresholds
    in units of F(0).

    >>> from burridge_knopoff import Chain
    >>> chain = Chain(3, coupling=(1.0, 1.5))
    >>> chain.stiffness.tolist()
    [[2.0, -1.0, 0.0], [-1.0, 4.5, -1.5], [0.0, -1.5, 2.5]]
    >>> chain.is_mirror_symmetric, Chain(5, ends="ring").is_mirror_symmetric
    (False, True)
    """

    blocks: Annotated[int, Whole(1, MAXIMUM_BLOCKS), "number of blocks N"] = 3
    coupling: Annotated[Numbers, _STRENGTHS, "springs between neighbours: one number for all, or one a spring"] = 1.0
    pulling: Annotated[
        Numbers | str,
        Either((OneOf((NEIGHBOURS,)), _PULLING, Several(_PULLING))),
        "springs to the driver: one number for all, or one a block (0: no spring); neighbours: the number of the "
        "block's neighbours, as in the paper (1 for a single block)",
    ] = NEIGHBOURS
    threshold: Annotated[Numbers, _STRENGTHS, "static friction: one number for all, or one a block"] = 1.0
    ends: Annotated[str, OneOf(ENDS), "open, or ring: the last block is coupled to the first"] = "open"

    def __post_init__(self) -> None:
        check_fields(self, "chain.")
        springs = self.blocks - (self.ends == "open")
        for key, count, of in (
            ("coupling", springs, "springs"),
            ("pulling", self.blocks, "blocks"),
            ("threshold", self.blocks, "blocks"),
        ):
            value = getattr(self, key)
            if isinstance(value, tuple) and len(value) != count:
                raise ValueError(
                    f"chain.{key}: got {len(value)} numbers, expected 1, or {count}: one for each of the {of}"
                )
        if self.blocks == 1 and self.ends == "ring":
            raise ValueError("chain.ends: got ring, expected open for one block")
        if not isinstance(self.pulling, str) and not np.any(self.pulling):
            raise ValueError(f"chain.pulling: got {self.pulling!r}, expected a number above 0 for one block or more")

    def is_like(self, other: Chain) -> bool:
        """Tell whether another chain has the same springs and static friction, in whatever form they were given."""
        names = ("stiffness", "driving", "thresholds")
        return all(np.array_equal(getattr(self, name), getattr(other, name)) for name in names)

    @cached_property
    def thresholds(self) -> np.ndarray:
        """Static friction of each block, shape (blocks,)."""
        return read_only(np.broadcast_to(self.threshold, self.blocks))

    @cached_property
    def before(self) -> np.ndarray:
        """Strength of the spring to the previous block, shape (blocks,); 0 at an open end."""
        strengths = np.zeros(self.blocks)
        springs = self.blocks - (self.ends == "open")
        strengths[:springs] = self.coupling
        return read_only(np.roll(strengths, 1))

    @cached_property
    def after(self) -> np.ndarray:
        """Strength of the spring to the next block, shape (blocks,); 0 at an open end."""
        return read_only(np.roll(self.before, -1))

    @cached_property
    def driving(self) -> np.ndarray:
        """Strengths D of the springs to the driver, shape (blocks,)."""
        if isinstance(self.pulling, str):
            neighbours = (self.before > 0.0).astype(float) + (self.after > 0.0)
            return read_only(neighbours if self.blocks > 1 else np.ones(1))
        return read_only(np.broadcast_to(self.pulling, self.blocks))

    @property
    def diagonal(self) -> np.ndarray:
        """Diagonal of K: the total strength of the springs at each block, shape (blocks,)."""
        return self.before + self.after + self.driving

    @property
    def stiffness(self) -> np.ndarray:
        """The matrix K, shape (blocks, blocks)."""
        matrix = np.diag(self.diagonal)
        for i in range(self.blocks):
            matrix[i, i - 1] -= self.before[i]
            matrix[i, (i + 1) % self.blocks] -= self.after[i]
        return matrix

    @property
    def is_mirror_symmetric(self) -> bool:
        """Whether the chain is its own mirror image, so that mirror blocks can move synchronously.

        False for a single block, which has no mirror block.
        """
        pairs = (self.driving, self.driving), (self.thresholds, self.thresholds), (self.before, self.after)
        return self.blocks > 1 and all(bool((one == other[::-1]).all()) for one, other in pairs)

    @property
    def _period(self) -> int:
        """The smallest shift along a ring that leaves springs and thresholds unchanged, in blocks."""
        values = np.array([self.before, self.driving, self.thresholds])
        return next(
            shift for shift in range(1, self.blocks + 1) if np.array_equal(values, np.roll(values, shift, axis=1))
        )

    @property
    def is_uniform(self) -> bool:
        """Whether coupling, pulling and threshold are each a single number and the ends are open."""
        return (
            self.ends == "open"
            and isinstance(self.coupling, float)
            and (isinstance(self.pulling, float) or self.pulling == NEIGHBOURS)
            and isinstance(self.threshold, float)
        )

    @property
    def highest_frequency(self) -> float:
        """Upper bound on the angular frequencies of slipping blocks: Gershgorin's bound on the eigenvalues of K."""
        return math.sqrt(float((self.diagonal + self.before + self.after).max()))

    @property
    def damping_limit(self) -> float:
        """The a below which every mode of slipping blocks is underdamped for Φ = 1 − aU'; for a uniform chain."""
        return 2.0 * math.sqrt(self.driving.min()) / float(self.thresholds[0])

    def force(self, position: np.ndarray) -> np.ndarray:
        """Return the spring forces −(K U) at τ = 0 for positions U, shape (…, blocks)."""
        block = np.arange(self.blocks)
        pull = self.before * position[..., block - 1] + self.after * position[..., (block + 1) % self.blocks]
        return pull - self.diagonal * position

    def sliding_offset(self, friction: float) -> np.ndarray:
        """Return e with K e = −friction · threshold, shape (blocks,).

        Uniform sliding is U_i = vτ + e_i if `friction` is Φ(v).
        """
        load = self._solve(self.thresholds.copy())
        if self.ends == "ring":
            # The corners of K are a rank-one update: the Sherman-Morrison formula.
            corner = np.zeros(self.blocks)
            corner[0] += 1.0
            corner[-1] += 1.0
            other = self._solve(corner)
            strength = self.before[0]
            load += strength * other * (load[0] + load[-1]) / (1.0 - strength * (other[0] + other[-1]))
            # Make it periodic to the bit, like the ring, so that a periodic state stays periodic.
            load = np.tile(load[: self._period], self.blocks // self._period)
        if self.is_mirror_symmetric:
            # Make it mirror-symmetric to the bit, like the chain.
            load = 0.5 * (load + load[::-1])
        return -friction * load

    def _solve(self, load: np.ndarray) -> np.ndarray:
        """Solve for the tridiagonal part of K; for a ring, the strength of its corner is added to both ends.

        By elimination, not by LAPACK: the last bit of LAPACK's result depends on the memory addresses of its arguments,
        so that all numbers of a study would change with the folder it runs in.
        """
        pivot = self.diagonal
        strength = self.after
        if self.ends == "ring":
            pivot[0] += self.before[0]
            pivot[-1] += self.before[0]
        for i in range(1, self.blocks):
            pivot[i] -= strength[i - 1] * strength[i - 1] / pivot[i - 1]
            load[i] += strength[i - 1] * load[i - 1] / pivot[i - 1]
        for i in range(self.blocks - 1, -1, -1):
            load[i] = (load[i] + (strength[i] * load[i + 1] if i + 1 < self.blocks else 0.0)) / pivot[i]
        return load
