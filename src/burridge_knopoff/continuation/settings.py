"""How near in a the changes of attractors are located; fields and defaults are those of a study's config."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from burridge_knopoff.model.fields import check_fields, settings
from burridge_knopoff.model.ranges import Number
from burridge_knopoff.running.settings import TIME


@settings
@dataclass(frozen=True)
class Refine:
    """Where values of a are put in between those of the grid, for attractors: the config's section `refine`.

    Raises ValueError, one line, for anything out of range.
    """

    resolution: Annotated[
        float,
        Number(1e-6, 100.0),
        "neighbouring values of a at which kind, period, symmetry or set of the attractors differ are at most this far "
        "apart; a step of the grid, or more, puts none in",
    ] = 1e-4
    longest_period: Annotated[
        float,
        TIME,
        "period up to which closed orbits are followed along a; whether a torus is locked to a longer one is no change",
    ] = 500.0

    def __post_init__(self) -> None:
        check_fields(self)


#: The defaults of a study.
REFINE = Refine()
