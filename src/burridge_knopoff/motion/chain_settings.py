"""Which states of a chain are watched for synchrony of mirror blocks, and for how long."""

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
    """Which initial states are watched: `samples` of them in a box, drawn with a seed, under a convention of start.

    Raises ValueError, one line, for anything out of range.
    """

    samples: Annotated[int, SAMPLES, "initial states sampled for each number of blocks at each a, uniform in a box"] = (
        40
    )
    seed: Annotated[
        int,
        SEED,
        "seed of the sample, at each a another one, under each law the same; the first states of a larger sample are "
        "those of a smaller one. The two blocks of chains.two_blocks have one sample for every a",
    ] = 1
    position: Annotated[Sequence[float], POSITION, "box of the sampled U_i(0), of all blocks"] = POSITIONS
    velocity: Annotated[Sequence[float], VELOCITY, "box of the sampled U_i'(0), of all blocks"] = VELOCITIES
    symmetric_samples: Annotated[
        int,
        Whole(0, 100_000),
        "how many of them, made mirror-symmetric, begin the motion whose transverse exponent is computed",
    ] = 4
    start: Annotated[str, OneOf(STARTS), START] = "moving"

    def __post_init__(self) -> None:
        check_fields(self)
        if self.symmetric_samples > self.samples:
            raise ValueError(
                f"symmetric_samples: got {self.symmetric_samples}, expected at most samples ({self.samples})"
            )

    def initial_states(self, blocks: int, a: float | None = None) -> list[InitialState]:
        """Return the initial states of a chain of that many blocks, those drawn for one a or those for every a."""
        seed = self.seed if a is None else seed_at(self.seed, a)
        return sample_initial_states(blocks, self.samples, self.position, self.velocity, seed)


#: The defaults of a study.
SAMPLE = Sample()


@settings
@dataclass(frozen=True)
class Watch:
    """How long a state is watched and when it counts as synchronized.

    Raises ValueError, one line, for anything out of range.
    """

    time_limit: Annotated[
        float, Number(200.0, LONGEST), "time by which a state must have synchronized; checked every 20"
    ] = 10_000.0
    synchronization_distance: Annotated[
        float,
        Number(1e-14, 1e-3),
        "mirror distance at which a motion has synchronized, if its transverse exponent is negative",
    ] = 1e-12
    synchronization_threshold: Annotated[
        float,
        TOLERANCE,
        "a pair of a motion that is not synchronized counts as synchronized below this; below v = 0.1 it scales with v",
    ] = 1e-6

    def __post_init__(self) -> None:
        check_fields(self)

    @property
    def quarter(self) -> float:
        """A quarter of the time limit."""
        return 0.25 * self.time_limit


#: The defaults of a study.
WATCH = Watch()
