"""Maps of basins, initial phases and edge states; fields and defaults are those of a study's config."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

from burridge_knopoff.model.fields import check_fields, settings
from burridge_knopoff.model.initial import PAPER_STATES, InitialState
from burridge_knopoff.model.random_numbers import SEED
from burridge_knopoff.model.ranges import Number, Several, Whole
from burridge_knopoff.model.sampling import POSITION, POSITIONS, SAMPLES
from burridge_knopoff.running.settings import TIME


@settings
@dataclass(frozen=True)
class BasinSettings:
    """A map of basins over U_1(0) and U_N(0): the config's section `basins`, without the values of a.

    initial : the state that gives all other positions and velocities

    Raises ValueError, one line, for anything out of range.
    """

    pixels: Annotated[int, Whole(1, 16_384), "pixels of a map along each axis"] = 256
    initial: InitialState = PAPER_STATES["minus"]
    first_position: Annotated[Sequence[float], POSITION, "range of U_1(0)"] = POSITIONS
    last_position: Annotated[Sequence[float], POSITION, "range of U_N(0)"] = POSITIONS
    pairs: Annotated[
        int,
        Whole(0, 10_000_000),
        "pairs of near states of the plane, at each of thirteen separations, for the uncertainty exponent",
    ] = 1600
    tiles: Annotated[int, Whole(1, 16_384), "bands of rows of a map, each a job, at most as many as pixels"] = 2
    threads: Annotated[int, Whole(1, 1024), "threads that compute a map or each of its tiles; they change no label"] = 1

    def __post_init__(self) -> None:
        check_fields(self)
        if self.tiles > self.pixels:
            raise ValueError(f"tiles: got {self.tiles}, expected at most the {self.pixels} rows of a map")


@settings
@dataclass(frozen=True)
class PhaseSettings:
    """Blocks that oscillate about uniform sliding: the config's section `phases`, without the values of a.

    Raises ValueError, one line, for anything out of range.
    """

    amplitude: Annotated[
        Sequence[float],
        Several(Number(0.0, 1e6, above=True), 1, 100, distinct=True),
        "amplitudes A of both end blocks, each with each phase difference",
    ] = (0.01, 0.03, 0.07, 0.1, 0.15, 0.2, 0.3, 1.0)
    phase_difference: Annotated[
        Sequence[float],
        Several(Number(0.0, 180.0), 1, 100, distinct=True),
        "by how many degrees the last block is ahead of the first; exactly 0 is synchrony from the start",
    ] = (15.0, 30.0, 60.0, 90.0, 120.0, 150.0, 180.0)
    inner_share: Annotated[
        Sequence[float],
        Several(Number(0.0, 1e3), 1, 100, distinct=True),
        "amplitudes of all blocks but the end blocks, over A; with 0 they slide uniformly",
    ] = (0.0, 0.3, 1.0)
    samples: Annotated[
        int, SAMPLES, "states, of phases drawn at random, for each amplitude and phase difference at each a"
    ] = 40
    seed: Annotated[
        int,
        SEED,
        "seed of these phases, which differ from one a to the next and are the same for each law and inner_share",
    ] = 1

    def __post_init__(self) -> None:
        check_fields(self)


@settings
@dataclass(frozen=True)
class EdgeSettings:
    """How boundaries between basins are followed to edge states: the config's section `edges`, without the values of a.

    Raises ValueError, one line, for anything out of range.

    >>> from burridge_knopoff import EdgeSettings
    >>> EdgeSettings(samples=100).duration
    24000.0
    """

    duration: Annotated[
        float, TIME, "longest time for which a boundary is followed; shorter if it leads to a periodic orbit"
    ] = 24_000.0
    samples: Annotated[
        int,
        Whole(20, 1_000_000),
        "states displaced from an edge state to each side, from which its lifetime and the attractors reached follow",
    ] = 500
    seed: Annotated[int, SEED, "seed of these displacements"] = 1

    def __post_init__(self) -> None:
        check_fields(self)


#: The defaults of a study.
EDGES = EdgeSettings()
