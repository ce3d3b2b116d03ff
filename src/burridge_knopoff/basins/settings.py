"""Settings of maps of basins, initial phases and edge states; fields and defaults are those of a study's config."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

from burridge_knopoff.messages import refusal
from burridge_knopoff.model.fields import check_fields, fields_of, settings
from burridge_knopoff.model.initial import PAPER_STATES, InitialState
from burridge_knopoff.model.model import Model
from burridge_knopoff.model.random_numbers import SEED
from burridge_knopoff.model.ranges import Number, Several, Whole
from burridge_knopoff.model.sampling import (
    POSITION,
    POSITIONS,
    SAMPLES,
    VELOCITIES,
    VELOCITY_AT_SPEED,
    velocity_range,
)
from burridge_knopoff.running.cores import CORES
from burridge_knopoff.running.settings import TIME
from burridge_knopoff.values import instance_of


@settings
@dataclass(frozen=True)
class BasinSettings:
    """A map of basins over U_1(0) and U_N(0), or U(0) and U'(0) of one block: the config's section `basins`, without a.

    initial : the state with all other positions and velocities

    Raises ValueError, one line, for anything out of range.
    """

    pixels: Annotated[int, Whole(1, 16_384), "number of pixels of a map along each axis"] = 256
    initial: InitialState = PAPER_STATES["minus"]
    first_position: Annotated[Sequence[float], POSITION, "range of U_1(0)"] = POSITIONS
    last_position: Annotated[Sequence[float], POSITION, "range of U_N(0)"] = POSITIONS
    first_velocity: Annotated[
        Sequence[float | str],
        VELOCITY_AT_SPEED,
        "range of U_1'(0), in place of U_N(0), in the map of one block; below 0 only under contact symmetric",
    ] = VELOCITIES
    pairs: Annotated[
        int,
        Whole(0, 10_000_000),
        "number of pairs of nearby states of the plane, at each of 13 separations, for the uncertainty exponent",
    ] = 1600
    tiles: Annotated[
        int,
        Whole(1, 16_384),
        "number of tiles (bands) into which a map is divided, one job each; at most `pixels`",
    ] = 2
    cores: Annotated[int, CORES, "number of cores for each map or tile; the result does not depend on it"] = 1

    def __post_init__(self) -> None:
        check_fields(self)
        instance_of(self.initial, InitialState, "initial")
        if self.tiles > self.pixels:
            raise ValueError(f"tiles: got {self.tiles}, expected at most the {self.pixels} rows of a map")

    def rows(self, model: Model) -> tuple[str, Sequence[float]]:
        """Return the name and the range of the second axis of a map; the first one is that of U_1(0).

        Raises ValueError, one line, for a range that is not that of an axis, and for velocities below 0 under one-sided
        contact.
        """
        row, other, end, of = "last_position", "first_velocity", "U_N(0)", f"{model.blocks} blocks"
        if model.blocks == 1:
            row, other, end, of = other, row, "U_1'(0)", "one block"
        if getattr(self, other) != fields_of(BasinSettings)[other].default:
            place = f"{row} in its place: the map of {of} is over U_1(0) and {end}"
            raise refusal(other, getattr(self, other), place)
        return row, self.last_position if model.blocks > 1 else velocity_range(self.first_velocity, model, row)


@settings
@dataclass(frozen=True)
class PhaseSettings:
    """Blocks that oscillate about uniform sliding: the config's section `phases`, without the values of a.

    Raises ValueError, one line, for anything out of range.
    """

    amplitude: Annotated[
        Sequence[float],
        Several(Number(0.0, 1e6, above=True), 1, 100, distinct=True),
        "amplitudes A of both end blocks, each combined with each phase difference",
    ] = (0.01, 0.03, 0.07, 0.1, 0.15, 0.2, 0.3, 1.0)
    phase_difference: Annotated[
        Sequence[float],
        Several(Number(0.0, 180.0), 1, 100, distinct=True),
        "phase of the last block minus that of the first, in degrees; exactly 0 is synchrony from the start",
    ] = (15.0, 30.0, 60.0, 90.0, 120.0, 150.0, 180.0)
    inner_share: Annotated[
        Sequence[float],
        Several(Number(0.0, 1e3), 1, 100, distinct=True),
        "amplitudes of all blocks except the end blocks, divided by A; with 0 they slide uniformly",
    ] = (0.0, 0.3, 1.0)
    samples: Annotated[
        int, SAMPLES, "number of states with random phases for each amplitude and phase difference at each a"
    ] = 40
    seed: Annotated[
        int,
        SEED,
        "seed of these phases: independent at each a, the same for all laws and values of inner_share",
    ] = 1

    def __post_init__(self) -> None:
        check_fields(self)


@settings
@dataclass(frozen=True)
class EdgeSettings:
    """Tracking of basin boundaries to edge states: the config's section `edges`, without the values of a.

    Raises ValueError, one line, for anything out of range.

    >>> from burridge_knopoff import EdgeSettings
    >>> EdgeSettings(samples=100).duration
    24000.0
    """

    duration: Annotated[
        float, TIME, "longest time for which a boundary is followed; tracking ends earlier at a periodic orbit"
    ] = 24_000.0
    samples: Annotated[
        int,
        Whole(20, 1_000_000),
        "number of states displaced from an edge state to each side, for its lifetime and the attractors reached",
    ] = 500
    seed: Annotated[int, SEED, "seed of these displacements"] = 1

    def __post_init__(self) -> None:
        check_fields(self)


#: The defaults of a study.
EDGES = EdgeSettings()
