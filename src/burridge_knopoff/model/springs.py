"""Springs and dashpots between blocks as lists of neighbours, for rows, rings, grids and networks from a file."""

from __future__ import annotations

import hashlib
import re
import warnings
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from burridge_knopoff.model.distances import distance_form
from burridge_knopoff.model.ranges import Number, Range
from burridge_knopoff.values import read_only_copy

#: Limit on the number of blocks.
MAXIMUM_BLOCKS = 10**6
STRENGTH = Number(1e-6, 1e6)
#: Values that may be 0. They may also be much smaller than strengths, since continuation varies them from 0.
DAMPING = Number(1e-30, STRENGTH.most, or_zero=True)
_LINES = (
    f"lines `block block strength` or `block block strength damping`, with blocks from 1 to {MAXIMUM_BLOCKS}, "
    f"strength {STRENGTH} and damping {DAMPING}"
)
_NAME_WITH_DIGEST = re.compile(r"(?s:(.+))@([0-9a-f]{16})")


class Neighbours(NamedTuple):
    """The neighbours of each block in compressed rows; the arrays are read-only.

    Those of block i (0 …) are index[start[i]:start[i + 1]]; springs of strength[start[i]:start[i + 1]] join them to it,
    and dashpots of damping[start[i]:start[i + 1]].

    start : shape (blocks + 1,), int64; index : shape (n,), int64
    strength : shape (n,), above 0; damping : shape (n,), 0 without a dashpot
    """

    start: np.ndarray
    index: np.ndarray  # type: ignore[assignment]
    strength: np.ndarray
    damping: np.ndarray

    @property
    def block(self) -> np.ndarray:
        """The block to which each entry belongs, shape (n,)."""
        return np.repeat(np.arange(len(self.start) - 1), np.diff(self.start))


def _compress(index: np.ndarray, strength: np.ndarray, damping: np.ndarray) -> Neighbours:
    """Return neighbours from tables with a row for each block; entries of strength 0 are left out."""
    joined = strength > 0.0
    start = np.concatenate([[0], np.cumsum(joined.sum(axis=1))])
    numbers = (strength[joined].astype(float), damping[joined].astype(float))
    return Neighbours(*map(read_only_copy, (start.astype(np.int64), index[joined].astype(np.int64), *numbers)))


def row_neighbours(strength: np.ndarray, damping: np.ndarray) -> Neighbours:
    """Return the neighbours in a row or a ring: the previous block, then the next.

    strength, damping : of the springs and dashpots to the previous block, shape (blocks,), 0 at an open end
    """
    block = np.arange(len(strength))
    numbers = (np.stack([values, np.roll(values, -1)], axis=1) for values in (strength, damping))
    return _compress(np.stack([np.roll(block, 1), np.roll(block, -1)], axis=1), *numbers)


def grid_neighbours(columns: int, rows: int, strength: np.ndarray, damping: np.ndarray) -> Neighbours:
    """Return the neighbours in a grid with open edges: left, right, down, up; block number is ix + columns * iy.

    strength, damping : of the springs and dashpots along rows and along columns, shape (2,)
    """
    block = np.arange(columns * rows)
    ix, iy = block % columns, block // columns
    joined = np.stack([ix > 0, ix < columns - 1, iy > 0, iy < rows - 1], axis=1)
    numbers = (np.repeat(values, 2) * joined for values in (strength, damping))
    return _compress(block[:, None] + np.array([-1, 1, -columns, columns]), *numbers)


def network_neighbours(
    first: np.ndarray, second: np.ndarray, strength: np.ndarray, damping: np.ndarray, blocks: int
) -> Neighbours:
    """Return the neighbours in a network, in ascending order.

    first, second : the blocks (0 …) that each spring joins
    """
    block, index = np.concatenate([first, second]), np.concatenate([second, first])
    order = np.lexsort((index, block))
    start = np.concatenate([[0], np.cumsum(np.bincount(block, minlength=blocks))])
    numbers = (np.concatenate([values, values])[order] for values in (strength, damping))
    return Neighbours(*map(read_only_copy, (start.astype(np.int64), index[order].astype(np.int64), *numbers)))


class NetworkSprings(Range):
    """Springs by distance, see `distance_form`, or the name of a file of springs.

    The form of a file ends with a digest of the content: `faults.txt@0123456789abcdef`.

    With the digest a changed file is a different value, so that results of the old file are out of date. A file whose
    name already has a digest is not read until its springs are needed.
    """

    def _fit(self, value: Any, key: str) -> str | None:
        if form := distance_form(value, key):
            return form
        if not isinstance(value, str) or not value or not value.isprintable():
            return None
        return value if has_digest(value) else f"{value}@{_digest(_content(value))}"

    def __str__(self) -> str:
        return "name of a text file or {distance, cut_off}"


def has_digest(springs: str) -> bool:
    """Return whether the name of a file of springs ends with the digest of its content."""
    return _NAME_WITH_DIGEST.fullmatch(springs) is not None


@lru_cache(maxsize=4)
def read_edges(springs: str) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return the springs of a file: the two blocks (0 …) that each spring joins, its strength and its dashpot.

    springs : name of the file and digest, as `NetworkSprings` returns it

    Raises ValueError, one line, if the file cannot be read, has other content, or is not a list of springs.
    """
    path, digest = _NAME_WITH_DIGEST.fullmatch(springs).groups()  # type: ignore[union-attr]
    content = _content(path)
    if _digest(content) != digest:
        raise ValueError(f"chain.springs: got {path} with the digest {_digest(content)}, expected {digest}")
    try:
        with warnings.catch_warnings():
            # An empty file is refused below.
            warnings.simplefilter("ignore", UserWarning)
            table = np.loadtxt(content.decode().splitlines(), ndmin=2)
    except ValueError as error:
        raise _file_error(path, str(error).split(";")[0].rstrip(".")) from None
    if not table.size or table.shape[1] not in (3, 4):
        raise _file_error(path, f"{table.shape[1] if table.size else 0} columns")
    blocks, strength = table[:, :2], table[:, 2]
    damping = table[:, 3] if table.shape[1] == 4 else np.zeros(len(table))
    pair = np.sort(blocks, axis=1)
    order = np.lexsort(pair.T)
    twice = np.zeros(len(pair), dtype=bool)
    twice[order[1:]] = (pair[order[1:]] == pair[order[:-1]]).all(axis=1)
    inside = (blocks >= 1) & (blocks <= MAXIMUM_BLOCKS) & (blocks == np.floor(blocks))
    for wrong, reason in (
        (~inside.all(axis=1), ""),
        (~((strength >= STRENGTH.least) & (strength <= STRENGTH.most)), ""),
        (~((damping == 0.0) | ((damping >= DAMPING.least) & (damping <= DAMPING.most))), ""),
        (pair[:, 0] == pair[:, 1], ", a block joined to itself"),
        (twice, ", a pair of blocks that is listed twice"),
    ):
        if wrong.any():
            row = table[np.flatnonzero(wrong)[0]]
            raise _file_error(path, f"{' '.join(f'{value:g}' for value in row)}{reason}")
    first, second = blocks.T.astype(np.int64) - 1
    return read_only_copy(first), read_only_copy(second), read_only_copy(strength), read_only_copy(damping)


def _content(path: str) -> bytes:
    try:
        if Path(path).exists() and not Path(path).is_file():
            raise OSError(0, "it is not a regular file")
        return Path(path).read_bytes()
    except OSError as error:
        raise ValueError(f"chain.springs: {path}: cannot be read: {error.strerror}") from None


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:16]


def _file_error(path: str, content: str) -> ValueError:
    return ValueError(f"chain.springs: {path}: got {content}, expected {_LINES}")
