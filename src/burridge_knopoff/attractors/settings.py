"""How attractors are searched for; fields and defaults are those of a study's config."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

from burridge_knopoff.model.fields import check_fields, settings
from burridge_knopoff.model.random_numbers import SEED
from burridge_knopoff.model.ranges import Number, Whole
from burridge_knopoff.model.sampling import POSITION, POSITIONS, VELOCITIES, VELOCITY
from burridge_knopoff.running.settings import TIME


@settings
@dataclass(frozen=True)
class SearchSettings:
    """How attractors are looked for, told apart and matched along a: the config's section `attractors`.

    Raises ValueError, one line, for anything out of range.

    >>> from burridge_knopoff import SearchSettings
    >>> SearchSettings(samples=40).time_limit
    20000.0
    """

    samples: Annotated[
        int,
        Whole(0, 1_000_000),
        "initial states drawn at each a, from which attractors are looked for, besides those that are given",
    ] = 200
    fraction_width: Annotated[
        float,
        Number(5e-4, 0.5),
        "half the width of the 95 % interval of each basin fraction; states are drawn anew at each a until all have "
        "it, 0.5 draws none",
    ] = 0.02
    seed: Annotated[int, SEED, "seed of all random numbers of the search"] = 1
    position: Annotated[Sequence[float], POSITION, "box of the sampled U_i(0), of all blocks"] = POSITIONS
    velocity: Annotated[Sequence[float], VELOCITY, "box of the sampled U_i'(0), of all blocks"] = VELOCITIES
    transient: Annotated[
        float, TIME, "time after which a motion may count as settled; it grows where a motion settles slowly"
    ] = 3000.0
    window: Annotated[
        float, TIME, "time for which a settled motion is observed; it grows where a motion settles slowly"
    ] = 3000.0
    time_limit: Annotated[
        float,
        TIME,
        "time by which a trajectory of the search has to reach a known attractor; states counted in "
        "basin fractions get ten times this limit, after which they are undetermined",
    ] = 20_000.0
    resolution: Annotated[
        float,
        Number(1e-6, 0.1),
        "distance in positions and velocities below which attractors are not told apart, for v = 0.1; it scales with v",
    ] = 1e-3
    perturbations: Annotated[
        int, Whole(4, 10_000), "random perturbations from which motion must come back for a capture radius to count"
    ] = 16
    lifetime: Annotated[
        float,
        TIME,
        "chaos is an attractor if its mean lifetime is above this with 96 % certainty, and transient if not",
    ] = 100_000.0

    def __post_init__(self) -> None:
        check_fields(self)

    @property
    def label_limit(self) -> float:
        """Time by which a state that is counted has to reach a known attractor, or is undetermined: ten `time_limit`.

        Chaos that lives about as long as a trajectory of the search would leave many states undetermined.
        """
        return 10.0 * self.time_limit


#: The defaults of a study.
SEARCH = SearchSettings()

#: Its fields that bear upon what given states end on; the others say which states are drawn.
OF_GIVEN_STATES = ("seed", "transient", "window", "time_limit", "resolution", "perturbations", "lifetime")
