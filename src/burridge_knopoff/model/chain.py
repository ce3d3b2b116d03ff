"""The chain: blocks held by static friction, coupled by springs and dashpots to their neighbours and to the driver."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from burridge_knopoff.messages import refusal
from burridge_knopoff.model.distances import is_by_distance, springs_by_distance
from burridge_knopoff.model.fields import check_fields, settings
from burridge_knopoff.model.laplacian import Laplacian
from burridge_knopoff.model.own_units import OwnUnits, own_units_of
from burridge_knopoff.model.random_numbers import Numbers, RandomNumbers, block_values
from burridge_knopoff.model.ranges import Either, Number, OneOf, Several, Whole
from burridge_knopoff.model.solving import ELIMINATION_LIMIT, nearest_solution, solve_ring, solve_tridiagonal
from burridge_knopoff.model.springs import (
    DAMPING,
    MAXIMUM_BLOCKS,
    STRENGTH,
    Neighbours,
    NetworkSprings,
    grid_neighbours,
    has_digest,
    network_neighbours,
    read_edges,
    row_neighbours,
)
from burridge_knopoff.values import Unchanging, read_only_copy, real_array

if TYPE_CHECKING:
    from numpy.typing import ArrayLike
    from scipy.sparse import csr_array

ENDS = ("open", "ring")
NEIGHBOURS = "neighbours"
#: Default number of blocks: the paper's.
BLOCKS = 3

_STRENGTHS = Either((STRENGTH, Several(STRENGTH)))
_BLOCK_VALUES = Either((STRENGTH, Several(STRENGTH), RandomNumbers(STRENGTH)))
# Other blocks hold a chain in which some blocks are pulled weakly, or not at all.
_PULLING = Number(DAMPING.least, STRENGTH.most, or_zero=True)
_DAMPING = Either((DAMPING, Several(DAMPING)))
_WEAKENING = Number(-STRENGTH.most, STRENGTH.most)
#: Parameters of each spring between neighbours, and of each block, with their ranges.
SPRING_PARAMETERS = {"coupling": STRENGTH, "damping": DAMPING}
BLOCK_PARAMETERS = {
    "pulling": _PULLING,
    "threshold": STRENGTH,
    "mass": STRENGTH,
    "pulling_damping": DAMPING,
    "weakening": _WEAKENING,
}
_SIDE = Whole(1, MAXIMUM_BLOCKS)


@settings
@dataclass(frozen=True, repr=False)
class Chain(Unchanging):
    """N blocks in a row, a ring, a grid, or any network of springs.

    A row has N − 1 springs between neighbours; spring i joins blocks i and i + 1. A ring has N springs; the last one
    joins the last block to the first. A grid of nx × ny blocks has open edges; block 1 + ix + nx·iy is in column ix and
    row iy, both counted from 0; `coupling` may differ along rows and columns (anisotropic sheets). A file of springs
    has one line for each spring, `block block strength` or `block block strength damping`, with blocks numbered from 1.
    Springs by distance, `{"distance": "9/r**3", "cut_off": 5}`, join all blocks of a row, a ring (r is the arc) or a
    grid. A block of mass m and weakening w obeys m U'' = F − threshold · Φ(w U') while it slips, and sticks while F is
    at most its threshold. The factor w of the speed is a factor of a in every law whose formula has a only in the
    product a*u. Friction of a block grows with speed if w is negative and Φ falls, and is Coulomb friction if w is 0.

    The force on block i is F_i = s_i + d_i. The spring force is s_i = D_i vτ − (K U)_i, where K is the graph Laplacian
    of the springs plus diag(D), so that K·1 = D. Dashpots (Kelvin-Voigt damping) add
    d_i = Σ_j c_ij (U_j' − U_i') + c_i (v − U_i') = c_i v − (C U')_i, by default 0.

    The defaults give the paper's chain (Eq. 2) for N = 3. The train model that the paper cites is pulled at its first
    block only: `Chain(2, pulling=(1.0, 0.0))`. A single block is pulled by one spring to the driver.

    Raises ValueError for a number of blocks, a number of springs or a strength out of range, for a file that is not a
    list of springs, and if the driver pulls no block of a connected part of the chain, since K is then singular.

    Positions are in units of F(0)/k, strengths in units of the paper's spring constant k (its Section II), thresholds
    in units of F(0), masses in units of the mass m of the paper's blocks, damping in units of √(km).

    >>> from burridge_knopoff import Chain
    >>> chain = Chain(3, coupling=(1.0, 1.5))
    >>> chain.stiffness.tolist()
    [[2.0, -1.0, 0.0], [-1.0, 4.5, -1.5], [0.0, -1.5, 2.5]]
    >>> chain.is_mirror_symmetric, Chain(5, ends="ring").is_mirror_symmetric
    (False, True)
    >>> Chain(grid=(2, 2)).neighbours.index.tolist()
    [1, 2, 0, 3, 3, 0, 2, 1]
    >>> Chain(3, springs={"distance": "8/r**3"}, pulling=1.0).stiffness.tolist()
    [[10.0, -8.0, -1.0], [-8.0, 17.0, -8.0], [-1.0, -8.0, 10.0]]
    """

    blocks: Annotated[
        int,
        Whole(1, MAXIMUM_BLOCKS),
        "number of blocks N; by default the number in the grid, in the file of springs, or in the initial state",
    ] = None  # type: ignore[assignment]
    coupling: Annotated[
        float | Sequence[float],
        _STRENGTHS,
        "springs between neighbours: one number for all, one for each spring of a row or a ring, or two in a grid: "
        "along rows (x) and columns (y)",
    ] = 1.0
    pulling: Annotated[
        float | Sequence[float] | str,
        Either((OneOf((NEIGHBOURS,)), _PULLING, Several(_PULLING))),
        "springs to the driver: one number for all blocks, or one per block (0: no spring), 1e-06 or more for at least "
        "one block; neighbours: the number of the block's neighbours, as in the paper (1 for a single block)",
    ] = NEIGHBOURS
    threshold: Annotated[
        Numbers, _BLOCK_VALUES, "static friction: one number for all blocks, one per block, or random"
    ] = 1.0
    ends: Annotated[str, OneOf(ENDS), "open, or ring: the last block is coupled to the first"] = "open"
    mass: Annotated[Numbers, _BLOCK_VALUES, "mass: one number for all blocks, one per block, or random"] = 1.0
    grid: Annotated[
        Sequence[int] | None, Several(_SIDE, 2, 2), "[nx, ny]: nx columns and ny rows of blocks, instead of a row"
    ] = None
    springs: Annotated[
        str | Mapping[str, Any] | None,
        NetworkSprings(),
        "file with the springs between blocks, instead of a row: lines `block block strength`, blocks numbered from 1; "
        "an optional fourth column gives the dashpot in parallel with each spring. Or springs between all blocks of a "
        "row, ring or grid, with their strength as a formula of the distance r, up to `cut_off`",
    ] = None
    damping: Annotated[
        float | Sequence[float],
        _DAMPING,
        "dashpots in parallel with the springs between neighbours: in the form of coupling",
    ] = 0.0
    pulling_damping: Annotated[
        float | Sequence[float], _DAMPING, "dashpots to the driver: one number for all blocks, or one per block"
    ] = 0.0
    weakening: Annotated[
        Numbers,
        Either((_WEAKENING, Several(_WEAKENING), RandomNumbers(_WEAKENING))),
        "factor of the slip speed in the friction law: one number for all blocks, one per block, or random. It is a "
        "factor of a where the formula has a only as a*u; negative: friction that falls with speed grows instead, 0: "
        "Coulomb friction",
    ] = 1.0

    def __post_init__(self) -> None:
        is_new = self.springs is not None and not (isinstance(self.springs, str) and has_digest(self.springs))
        check_fields(self, "chain.")
        if self.grid and self.springs and not self._is_by_distance:
            raise refusal("chain.grid", list(self.grid), "none together with chain.springs")
        if self.grid and math.prod(self.grid) > MAXIMUM_BLOCKS:
            raise refusal("chain.grid", list(self.grid), f"at most {MAXIMUM_BLOCKS} blocks")
        if self.is_network:
            self._check_network()
        elif self.blocks is None:
            object.__setattr__(self, "blocks", BLOCKS)
        for key in (*SPRING_PARAMETERS, *BLOCK_PARAMETERS):
            value, count = getattr(self, key), self.parameter_count(key)
            if isinstance(value, tuple) and len(value) != count:
                got, several = f"{len(value)} numbers, expected 1", f"{count}"
                if len(value) == 1:
                    got, several = "a list of 1 number, expected a number", f"a list of {count}"
                per = "one per block"
                if key in SPRING_PARAMETERS:
                    per = "along rows and columns" if self.grid else "one per spring"
                raise ValueError(f"chain.{key}: got {got}{f', or {several}: {per}' * (count > 1)}")
        if self.blocks == 1 and self.ends == "ring":
            raise ValueError("chain.ends: got ring, expected open for one block")
        if not isinstance(self.pulling, str) and np.max(self.pulling) < STRENGTH.least:
            allowed = f"a number above 0 for at least one block, {STRENGTH.least:g} or more"
            raise refusal("chain.pulling", self.pulling, allowed)
        if self._is_by_distance and self.pulling == NEIGHBOURS:
            raise refusal("chain.pulling", NEIGHBOURS, "a number, or one per block, together with springs by distance")
        if is_new:
            self.check_springs()

    def __repr__(self) -> str:
        """Return the call that makes this chain: the number of blocks, and what differs from the defaults."""
        values = ((field, getattr(self, field.name)) for field in fields(self) if field.name != "blocks")
        others = [f"{field.name}={value!r}" for field, value in values if value != field.default]
        return f"Chain({', '.join([str(self.blocks), *others])})"

    def _check_network(self) -> None:
        option = "chain.springs" if self.springs else "chain.grid"
        if self.ends != "open" and (self.grid or not self._is_by_distance):
            with_key = "chain.grid" if self.grid else option
            raise ValueError(f"chain.ends: got {self.ends}, expected open together with {with_key}")
        for key in ("coupling", "damping"):
            value, usual = getattr(self, key), 1.0 if key == "coupling" else 0.0
            if self.springs and value != usual:
                raise refusal(f"chain.{key}", value, f"none together with {option}")
        if self.grid:
            count = math.prod(self.grid)
            if self.blocks not in (None, count):
                raise ValueError(f"chain.blocks: got {self.blocks}, expected {count} for chain.grid {list(self.grid)}")
            object.__setattr__(self, "blocks", count)
        elif self.blocks is None and self._is_by_distance:
            object.__setattr__(self, "blocks", BLOCKS)
        elif self.blocks is None:
            first, second, *_ = read_edges(str(self.springs))
            object.__setattr__(self, "blocks", int(max(first.max(), second.max())) + 1)

    @property
    def _is_by_distance(self) -> bool:
        return is_by_distance(self.springs)  # type: ignore[arg-type]

    def check_springs(self) -> None:
        """Read the file of springs, or make the springs by distance, if there are any.

        Raises ValueError, one line, if it is not a list of springs between these blocks, and if the driver pulls no
        block of a connected part, since K is then singular.
        """
        if self.springs is None:
            return
        from scipy.sparse.csgraph import connected_components

        part = connected_components(self._springs.adjacency, directed=False)[1]
        slack = np.flatnonzero(np.bincount(part, self.driving >= STRENGTH.least)[part] == 0.0)
        if len(slack):
            driving = self.driving[part == part[slack[0]]]
            raise ValueError(
                f"chain.pulling: got {driving.max():g} for all of the {len(driving)} blocks connected to block "
                f"{slack[0] + 1}, expected a number above 0 for at least one of them, {STRENGTH.least:g} or more"
            )

    def is_equivalent_to(self, other: Chain) -> bool:
        """Return whether another chain has the same springs, dashpots, masses and friction, in whatever form.

        A network is never equivalent to a row, because a row has a mirror image.
        """
        return self.different_key(other) is None

    def different_key(self, other: Chain) -> str | None:
        """Return a key in which another chain differs; None if it is equivalent, see `is_equivalent_to`."""
        if self.blocks != other.blocks:
            return "blocks"
        start, index, strength, damping = (
            np.array_equal(*pair) for pair in zip(self.neighbours, other.neighbours, strict=True)
        )
        if not (self.is_network == other.is_network and start and index):
            return next(key for key in ("grid", "springs", "ends") if getattr(self, key) != getattr(other, key))
        for key in BLOCK_PARAMETERS:
            if not np.array_equal(self.parameter_values(key), other.parameter_values(key)):
                return key
        if strength and damping:
            return None
        return "springs" if self.springs != other.springs else "damping" if strength else "coupling"

    def parameter_count(self, key: str) -> int:
        """Return how many values a parameter has: one for each block, or for each spring of a row or a ring.

        The springs of a grid have two, along rows and columns; those of other networks have none.
        """
        if key in BLOCK_PARAMETERS:
            return self.blocks
        if self.is_network:
            return 0 if self.springs else 2
        return self.blocks - (self.ends == "open")

    def parameter_values(self, key: str) -> np.ndarray:
        """Return the values of a parameter for all springs or all blocks, shape (parameter_count(key),).

        Springs of a row or a ring are in the order of the blocks on their left; those of a grid along rows come first.
        """
        return self.driving if key == "pulling" else block_values(getattr(self, key), self.parameter_count(key), key)

    @property
    def is_network(self) -> bool:
        """Whether the blocks form a grid or any other network, which has no ends, mirror image or shift."""
        return self.grid is not None or self.springs is not None

    @cached_property
    def thresholds(self) -> np.ndarray:
        """Static friction of each block, shape (blocks,)."""
        return read_only_copy(block_values(self.threshold, self.blocks, "threshold"))

    @cached_property
    def masses(self) -> np.ndarray:
        """Mass of each block, shape (blocks,)."""
        return read_only_copy(block_values(self.mass, self.blocks, "mass"))

    @cached_property
    def weakenings(self) -> np.ndarray:
        """Factor of the slip speed in the friction law of each block, shape (blocks,)."""
        return read_only_copy(block_values(self.weakening, self.blocks, "weakening"))

    @cached_property
    def weakening_range(self) -> tuple[float, float]:
        """The least and the largest of 0 and all weakenings."""
        return min(0.0, float(self.weakenings.min())), max(0.0, float(self.weakenings.max()))

    @cached_property
    def coupling_to_previous(self) -> np.ndarray:
        """Strength of the spring to the previous block of a row or ring, shape (blocks,); 0 at an open end."""
        return self._shift_to_next(self.coupling)

    def _shift_to_next(self, values: float | Sequence[float]) -> np.ndarray:
        """Return the values of the springs to the previous blocks, shape (blocks,); 0 at an open end."""
        if self.is_network:
            raise ValueError("chain: got a network of springs, expected a row or a ring")
        springs = np.zeros(self.blocks)
        springs[: self.blocks - (self.ends == "open")] = values
        return read_only_copy(np.roll(springs, 1))

    @cached_property
    def coupling_to_next(self) -> np.ndarray:
        """Strength of the spring to the next block of a row or ring, shape (blocks,); 0 at an open end."""
        return read_only_copy(np.roll(self.coupling_to_previous, -1))

    @cached_property
    def neighbours(self) -> Neighbours:
        """The neighbours of each block and the springs to them; raises ValueError as `check_springs` does.

        The order is previous, next in a row or ring; left, right, down, up in a grid; ascending in a network from a
        file. The two blocks of a ring of two are joined by two springs.
        """
        columns, rows = self.grid or (self.blocks, 1)
        if self._is_by_distance:
            joined = springs_by_distance(str(self.springs), columns, rows, self.ends == "ring", STRENGTH)
            return network_neighbours(*joined, np.zeros(len(joined[0])), self.blocks)
        if self.grid:
            return grid_neighbours(columns, rows, *map(self.parameter_values, SPRING_PARAMETERS))
        if self.springs is None:
            return row_neighbours(self.coupling_to_previous, self._shift_to_next(self.damping))
        first, second, strength, damping = read_edges(str(self.springs))
        largest = int(max(first.max(), second.max())) + 1
        if largest > self.blocks:
            raise ValueError(f"chain.springs: got block {largest}, expected at most chain.blocks ({self.blocks})")
        return network_neighbours(first, second, strength, damping, self.blocks)

    @cached_property
    def driving(self) -> np.ndarray:
        """Strengths D of the springs to the driver, shape (blocks,)."""
        if isinstance(self.pulling, str):
            return read_only_copy(np.diff(self.neighbours.start).astype(float) if self.blocks > 1 else np.ones(1))
        return read_only_copy(np.broadcast_to(self.pulling, self.blocks))

    @cached_property
    def driver_damping(self) -> np.ndarray:
        """Coefficients c_i of the dashpots to the driver, shape (blocks,)."""
        return read_only_copy(np.broadcast_to(self.pulling_damping, self.blocks).astype(float))

    @cached_property
    def _springs(self) -> Laplacian:
        return Laplacian(self.neighbours, self.neighbours.strength, self.driving)

    @cached_property
    def _dashpots(self) -> Laplacian:
        return Laplacian(self.neighbours, self.neighbours.damping, self.driver_damping)

    @property
    def diagonal(self) -> np.ndarray:
        """Diagonal of K: the total strength of the springs at each block, shape (blocks,)."""
        return self._springs.diagonal

    @property
    def damping_diagonal(self) -> np.ndarray:
        """Diagonal of C: the total coefficient of the dashpots at each block, shape (blocks,)."""
        return self._dashpots.diagonal

    @property
    def stiffness(self) -> np.ndarray:
        """The matrix K, dense, shape (blocks, blocks)."""
        return self._springs.dense

    @property
    def sparse_stiffness(self) -> csr_array:
        """The matrix K as a sparse matrix of SciPy, shape (blocks, blocks)."""
        return self._springs.sparse

    @property
    def damping_matrix(self) -> np.ndarray:
        """The matrix C, dense, shape (blocks, blocks)."""
        return self._dashpots.dense

    @cached_property
    def is_damped(self) -> bool:
        """Whether the chain has a dashpot."""
        return bool(self.damping_diagonal.any())

    @cached_property
    def is_mirror_symmetric(self) -> bool:
        """Whether the chain is its own mirror image, so that mirror blocks can move synchronously.

        False for a network, and for a single block, which has no mirror block.
        """
        if self.blocks == 1 or self.is_network:
            return False
        of_blocks = (self.driving, self.thresholds, self.masses, self.driver_damping, self.weakenings)
        of_springs = (self.coupling_to_previous, self._shift_to_next(self.damping))
        pairs = [(values, values) for values in of_blocks] + [(values, np.roll(values, -1)) for values in of_springs]
        return all(bool((one == other[::-1]).all()) for one, other in pairs)

    @property
    def is_uniform(self) -> bool:
        """Whether this is an undamped row with open ends, masses and weakening of 1, and equal springs and thresholds.

        The solver `map` requires such a chain.
        """
        return (
            self.ends == "open"
            and not self.is_network
            and isinstance(self.coupling, float)
            and (isinstance(self.pulling, float) or self.pulling == NEIGHBOURS)
            and isinstance(self.threshold, float)
            and self.mass == 1.0
            and self.weakening == 1.0
            and not self.is_damped
        )

    @property
    def highest_frequency(self) -> float:
        """Upper bound on the angular frequencies of slipping blocks, by Gershgorin's theorem for M⁻¹K."""
        return math.sqrt(self._springs.eigenvalue_bound(self.masses))

    @property
    def highest_rate(self) -> float:
        """Upper bound on the rates |λ| of oscillation and damping of slipping blocks, without friction."""
        return self.highest_frequency + self._dashpots.eigenvalue_bound(self.masses)

    @cached_property
    def own_units(self) -> OwnUnits:
        """The units in which this chain is about as fast, as long and as strong as the paper's."""
        return own_units_of(self.thresholds, self.masses, self._displacement)

    @property
    def a_unit(self) -> float:
        """The a at which friction changes a slip as much as a = 1 does in the paper's chain, for which it is 1.

        Springs that are stiffer by a factor make all motion faster by its square root; a mode grows at a rate
        proportional to a times the threshold and the weakening.
        """
        pulled = self.driving > 0.0
        # Without weakening a has no effect, and any unit will do.
        effect = float((self.thresholds * np.abs(self.weakenings)).max()) or float(self.thresholds.max())
        return math.sqrt(float((self.driving * self.masses)[pulled].min())) / effect

    @property
    def damping_limit(self) -> float:
        """The a below which all modes of slipping blocks of a uniform chain oscillate under the law Φ = 1 − aU'."""
        return 2.0 * math.sqrt(self.driving.min()) / float(self.thresholds[0])

    def force(self, position: ArrayLike) -> np.ndarray:
        """Return the spring forces −(K U)_i at τ = 0 for positions U, shape (…, blocks)."""
        position = self._of_blocks(position, "position")
        if self.is_network:
            return self._springs.negative_product(position)
        block = np.arange(self.blocks)
        previous, following = position[..., block - 1], position[..., (block + 1) % self.blocks]
        # Both neighbours are added first, so that mirrored positions give mirrored forces to the bit.
        return self.coupling_to_previous * previous + self.coupling_to_next * following - self.diagonal * position

    def _of_blocks(self, values: ArrayLike, key: str) -> np.ndarray:
        """Return numbers with one entry per block on their last axis; raises ValueError, one line, for others."""
        array = real_array(values, key)
        if array.shape[-1:] != (self.blocks,):
            raise refusal(key, array.shape, f"shape (…, {self.blocks}): one number per block on the last axis")
        return array

    def damping_force(self, velocity: ArrayLike, v: float) -> np.ndarray:
        """Return the forces c_i v − (C U')_i of the dashpots for velocities U', shape (…, blocks)."""
        velocity = self._of_blocks(velocity, "velocity")
        if not self.is_damped:
            return np.zeros(velocity.shape)
        return self.driver_damping * v + self._dashpots.negative_product(velocity)

    def sliding_offset(self, friction: float | np.ndarray) -> np.ndarray:
        """Return e with K e = −friction · threshold, shape (blocks,).

        friction : Φ(w_i v) of each block, or one number for all; then uniform sliding is U_i = vτ + e_i
        """
        friction = np.broadcast_to(friction, self.blocks)
        if (friction == friction[0]).all():
            return -friction * self._displacement
        return -self._displacement_by(friction * self.thresholds)

    @cached_property
    def _displacement(self) -> np.ndarray:
        """x with K x = threshold, shape (blocks,)."""
        return self._displacement_by(self.thresholds)

    def _displacement_by(self, force: np.ndarray) -> np.ndarray:
        """Return x with K x = force, shape (blocks,); the force is mirror-symmetric if the chain is."""
        if self.is_network or self.blocks > ELIMINATION_LIMIT:
            return read_only_copy(nearest_solution(self.sparse_stiffness, force))
        solve = solve_ring if self.ends == "ring" else solve_tridiagonal
        x = solve(self.diagonal, self.coupling_to_next, force.copy())
        # The solution is made mirror-symmetric to the bit if the chain is.
        return read_only_copy(0.5 * (x + x[::-1]) if self.is_mirror_symmetric else x)
