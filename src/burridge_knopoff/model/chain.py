"""The chain: blocks coupled by springs to their neighbours and to the driver, held by static friction."""

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

#: A strength or a threshold: one number for all, or one each.
Numbers = float | Sequence[float]
_STRENGTH = Number(1e-6, 1e6)
_STRENGTHS = Either((_STRENGTH, Several(_STRENGTH)))
_PULLING = Number(1e-6, 1e6, or_zero=True)


@settings
@dataclass(frozen=True)
class Chain:
    """N blocks of equal mass in a row, or in a ring.

    There are N − 1 springs with open ends, and N in a ring, whose last spring joins the last block to the first. A
    block slips against threshold · Φ.

    The spring force on block i is s_i = D_i vτ − (K U)_i with K the graph Laplacian of the springs plus diag(D), so
    that K·1 = D. With the defaults N = 3 is the paper's chain (Eq. 2). The train model that the paper cites is pulled
    at its first block only: `Chain(2, pulling=(1.0, 0.0))`. One block hangs on one spring to the driver.

    Raises ValueError for a number of blocks, of springs, or a strength that is not allowed, and if no block is pulled:
    K has no inverse then.

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
    coupling: Annotated[Numbers, _STRENGTHS, "springs between neighbours, one number or one each"] = 1.0
    pulling: Annotated[
        Numbers | str,
        Either((OneOf((NEIGHBOURS,)), _PULLING, Several(_PULLING))),
        "springs to the driver, one number or one a block, 0 where there is none; neighbours: as many as a block has, "
        "as in the paper, and 1 for one block",
    ] = NEIGHBOURS
    threshold: Annotated[Numbers, _STRENGTHS, "static friction, one number or one a block"] = 1.0
    ends: Annotated[str, OneOf(ENDS), "open, or ring: the last block is the neighbour of the first"] = "open"

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
                raise ValueError(f"chain.{key}: {len(value)} numbers for {count} {of}: one number, or one each")
        if self.blocks == 1 and self.ends == "ring":
            raise ValueError("chain.ends: got ring, expected open for one block")
        if not isinstance(self.pulling, str) and not np.any(self.pulling):
            raise ValueError(f"chain.pulling: got {self.pulling!r}, expected a number above 0 for one block or more")

    def is_like(self, other: Chain) -> bool:
        """Tell whether springs and static friction are those of another chain, however they were given."""
        names = ("stiffness", "driving", "thresholds")
        return all(np.array_equal(getattr(self, name), getattr(other, name)) for name in names)

    @cached_property
    def thresholds(self) -> np.ndarray:
        """Static friction of each block, shape (blocks,)."""
        return read_only(np.broadcast_to(self.threshold, self.blocks))

    @cached_property
    def before(self) -> np.ndarray:
        """Strength of the spring to the block before each one, shape (blocks,); 0 at an open end."""
        strengths = np.zeros(self.blocks)
        springs = self.blocks - (self.ends == "open")
        strengths[:springs] = self.coupling
        return read_only(np.roll(strengths, 1))

    @cached_property
    def after(self) -> np.ndarray:
        """Strength of the spring to the block after each one, shape (blocks,); 0 at an open end."""
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
        """Diagonal of K: the strengths of all springs at each block, shape (blocks,)."""
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
        """Whether the chain is its own mirror image: only then can end blocks, and mirror blocks, move as one.

        One block has no mirror block.
        """
        pairs = (self.driving, self.driving), (self.thresholds, self.thresholds), (self.before, self.after)
        return self.blocks > 1 and all(bool((one == other[::-1]).all()) for one, other in pairs)

    @property
    def _period(self) -> int:
        """The least number of blocks after which springs and thresholds of a ring repeat."""
        values = np.array([self.before, self.driving, self.thresholds])
        return next(
            shift for shift in range(1, self.blocks + 1) if np.array_equal(values, np.roll(values, shift, axis=1))
        )

    @property
    def is_uniform(self) -> bool:
        """Whether one number gives each of coupling, pulling and threshold, and the ends are open."""
        return (
            self.ends == "open"
            and isinstance(self.coupling, float)
            and (isinstance(self.pulling, float) or self.pulling == NEIGHBOURS)
            and isinstance(self.threshold, float)
        )

    @property
    def highest_frequency(self) -> float:
        """An angular frequency that no mode of slipping blocks exceeds, by Gershgorin's bound on eigenvalues of K."""
        return math.sqrt(float((self.diagonal + self.before + self.after).max()))

    @property
    def damping_limit(self) -> float:
        """The a below which every mode of slipping blocks oscillates under Φ = 1 − aU', if the chain is uniform."""
        return 2.0 * math.sqrt(self.driving.min()) / float(self.thresholds[0])

    def force(self, position: np.ndarray) -> np.ndarray:
        """Return the spring forces −(K U) at τ = 0 for positions U, shape (…, blocks)."""
        block = np.arange(self.blocks)
        pull = self.before * position[..., block - 1] + self.after * position[..., (block + 1) % self.blocks]
        return pull - self.diagonal * position

    def sliding_offset(self, friction: float) -> np.ndarray:
        """Return e with K e = −friction · threshold, shape (blocks,).

        Uniform sliding is U_i = vτ + e_i where Φ(v) is that friction.
        """
        load = self._solve(self.thresholds.copy())
        if self.ends == "ring":
            # The corners of K are a matrix of rank one more: Sherman and Morrison's formula.
            corner = np.zeros(self.blocks)
            corner[0] += 1.0
            corner[-1] += 1.0
            other = self._solve(corner)
            strength = self.before[0]
            load += strength * other * (load[0] + load[-1]) / (1.0 - strength * (other[0] + other[-1]))
            # Periodic to the bit, as the ring is: then a state that repeats along it stays so.
            load = np.tile(load[: self._period], self.blocks // self._period)
        if self.is_mirror_symmetric:
            # Mirror-symmetric to the bit, as the chain is.
            load = 0.5 * (load + load[::-1])
        return -friction * load

    def _solve(self, load: np.ndarray) -> np.ndarray:
        """Return the solution for the tridiagonal part of K; in a ring with its corner strength added at both ends.

        By elimination: LAPACK's last bit depends on where in memory its arguments lie, and all numbers of a study would
        change with the folder that it is run from.
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
