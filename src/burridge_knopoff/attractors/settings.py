"""Settings of the search for attractors; fields and defaults are those of a study's config."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

from burridge_knopoff.model.fields import check_fields, settings
from burridge_knopoff.model.model import Model
from burridge_knopoff.model.random_numbers import SEED
from burridge_knopoff.model.ranges import Number, Whole
from burridge_knopoff.model.sampling import POSITION, POSITIONS, VELOCITIES, VELOCITY_AT_SPEED, velocity_range
from burridge_knopoff.running.settings import TIME


@settings
@dataclass(frozen=True)
class SearchSettings:
    """How attractors are searched for and distinguished: the config's section `attractors`.

    Raises ValueError, one line, for anything out of range.

    >>> from burridge_knopoff import SearchSettings
    >>> SearchSettings(samples=40).time_limit
    20000.0
    """

    samples: Annotated[
        int,
        Whole(0, 1_000_000),
        "number of random initial states at each a from which the search starts, in addition to the given ones",
    ] = 200
    fraction_width: Annotated[
        float,
        Number(5e-4, 0.5),
        "target half-width of the 95 % interval of each basin fraction: states are drawn at each a until every "
        "interval is this narrow (0.5: no sampling)",
    ] = 0.02
    seed: Annotated[int, SEED, "seed of all random numbers of the search"] = 1
    position: Annotated[Sequence[float], POSITION, "range of the random U_i(0) of all blocks"] = POSITIONS
    velocity: Annotated[
        Sequence[float | str],
        VELOCITY_AT_SPEED,
        "range of the random U_i'(0) of all blocks; below 0 only under contact symmetric",
    ] = VELOCITIES
    transient: Annotated[
        float, TIME, "time after which a motion may count as settled; extended automatically where it settles slowly"
    ] = 3000.0
    window: Annotated[
        float, TIME, "time for which a settled motion is observed; extended automatically where it settles slowly"
    ] = 3000.0
    time_limit: Annotated[
        float,
        TIME,
        "longest time a trajectory of the search may take to reach a known attractor; states drawn for basin fractions "
        "get ten times as long, then count as undetermined",
    ] = 20_000.0
    resolution: Annotated[
        float,
        Number(1e-6, 0.1),
        "attractors closer than this in positions and velocities count as one; given for v = 0.1, and scaled in "
        "proportion to v",
    ] = 1e-3
    perturbations: Annotated[
        int,
        Whole(4, 10_000),
        "number of random perturbations that must all return before a capture radius is accepted",
    ] = 16
    lifetime: Annotated[
        float,
        TIME,
        "chaos is an attractor if its mean lifetime is above this with 96 % certainty, and transient otherwise",
    ] = 100_000.0

    def __post_init__(self) -> None:
        check_fields(self)

    def box(self, model: Model) -> tuple[Sequence[float], Sequence[float]]:
        """Return the ranges of the random U_i(0) and U_i'(0) for a model.

        Raises ValueError, one line, for velocities below 0 under one-sided contact.
        """
        return self.position, velocity_range(self.velocity, model, "velocity")

    @property
    def label_limit(self) -> float:
        """Time by which a state that is counted has to reach a known attractor: ten times `time_limit`.

        With `time_limit` itself, transient chaos of about that lifetime would leave many states undetermined.
        """
        return 10.0 * self.time_limit


#: The defaults of a study.
SEARCH = SearchSettings()

#: Fields on which the asymptotic states of given initial states depend; the others concern the states that are drawn.
GIVEN_STATE_KEYS = ("seed", "transient", "window", "time_limit", "resolution", "perturbations", "lifetime")
