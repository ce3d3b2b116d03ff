"""The initial states from which synchronization of mirror blocks is watched, and the time limit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

from burridge_knopoff.model.fields import check_fields, settings
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import START, STARTS
from burridge_knopoff.model.random_numbers import SEED
from burridge_knopoff.model.ranges import TOLERANCE, Number, OneOf, Whole
from burridge_knopoff.model.sampling import (
    POSITION,
    POSITIONS,
    SAMPLES,
    VELOCITIES,
    VELOCITY,
    sample_initial_states,
    seed_at,
)
from burridge_knopoff.running.settings import LONGEST


@settings
@dataclass(frozen=True)
class Sample:
    """The initial states that are watched: random states in a box, and how they start.

    Raises ValueError, one line, for anything out of range.
    """

    samples: Annotated[
        int, SAMPLES, "number of random initial states for each number of blocks at each a, uniform in a box"
    ] = 40
    seed: Annotated[
        int,
        SEED,
        "seed; each a has its own sample, the same for all laws; a larger sample contains the smaller. In "
        "chains.two_blocks all a have the same sample",
    ] = 1
    position: Annotated[Sequence[float], POSITION, "range of the random U_i(0) of all blocks"] = POSITIONS
    velocity: Annotated[Sequence[float], VELOCITY, "range of the random U_i'(0) of all blocks"] = VELOCITIES
    symmetric_samples: Annotated[
        int,
        Whole(0, 100_000),
        "number of these states that are made mirror-symmetric and used to compute the transverse exponent",
    ] = 4
    start: Annotated[str, OneOf(STARTS), START] = "moving"

    def __post_init__(self) -> None:
        check_fields(self)
        if self.symmetric_samples > self.samples:
            raise ValueError(
                f"symmetric_samples: got {self.symmetric_samples}, expected at most samples ({self.samples})"
            )

    def initial_states(self, blocks: int, a: float | None = None) -> list[InitialState]:
        """Return the initial states for this number of blocks: the sample of one a, or the common sample."""
        seed = self.seed if a is None else seed_at(self.seed, a)
        return sample_initial_states(blocks, self.samples, self.position, self.velocity, seed)


#: The defaults of a study.
SAMPLE = Sample()


@settings
@dataclass(frozen=True)
class Watch:
    """The time for which a state is watched, and the conditions for synchronization.

    Raises ValueError, one line, for anything out of range.
    """

    time_limit: Annotated[
        float, Number(200.0, LONGEST), "time within which a state must synchronize; checked at intervals of 20"
    ] = 10_000.0
    synchronization_distance: Annotated[
        float,
        Number(1e-14, 1e-3),
        "mirror distance below which a motion has synchronized, if its transverse exponent is negative",
    ] = 1e-12
    synchronization_threshold: Annotated[
        float,
        TOLERANCE,
        "in a motion that has not synchronized, distance below which a pair of blocks counts as synchronized; for "
        "v < 0.1 it is multiplied by v/0.1",
    ] = 1e-6

    def __post_init__(self) -> None:
        check_fields(self)

    @property
    def quarter(self) -> float:
        """A quarter of the time limit."""
        return 0.25 * self.time_limit


#: The defaults of a study.
WATCH = Watch()
