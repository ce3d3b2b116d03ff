"""Settings of the location of changes along a parameter; fields and defaults are those of a study's config."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from burridge_knopoff.model.fields import check_fields, settings
from burridge_knopoff.model.ranges import Number
from burridge_knopoff.running.settings import TIME


@settings
@dataclass(frozen=True)
class RefinementSettings:
    """How closely changes of attractors are located in a: the config's section `refine`.

    Raises ValueError, one line, for anything out of range.
    """

    resolution: Annotated[
        float,
        Number(1e-6, 100.0),
        "where the attractors differ between neighbouring values of a, values are inserted until the change is located "
        "to within this distance (the grid step or more: none are inserted)",
    ] = 1e-4
    longest_period: Annotated[
        float,
        TIME,
        "longest period of orbits that are continued in a; locking to a longer orbit does not count as a change",
    ] = 500.0

    def __post_init__(self) -> None:
        check_fields(self)


#: The defaults of a study.
REFINEMENT = RefinementSettings()
