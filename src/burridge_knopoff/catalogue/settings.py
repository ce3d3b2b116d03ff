"""What a catalogue of slip events covers; fields and defaults are those of a study's config."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from burridge_knopoff.model.fields import check_fields, settings
from burridge_knopoff.model.ranges import HUGE, Number, OneOf, TrueOrFalse
from burridge_knopoff.running.loading import LOADINGS
from burridge_knopoff.running.settings import DURATION, TIME
from burridge_knopoff.values import refusal

MAGNITUDE = Number(-HUGE, HUGE)


@settings
@dataclass(frozen=True)
class CatalogueSettings:
    """Which events a catalogue has and where its slope is fitted: the config's section `catalogue`, without a.

    Raises ValueError, one line, for anything out of range.
    """

    loading: Annotated[
        str,
        OneOf(LOADINGS),
        "steady: the driver always moves | quasistatic: it stands while any block slips, and loads to the next slip "
        "when all rest",
    ] = "steady"
    transient: Annotated[float, DURATION, "time of the loading clock before the catalogue"] = 3000.0
    window: Annotated[float, TIME, "length of the catalogue on the loading clock"] = 7000.0
    low: Annotated[
        float | None,
        MAGNITUDE,
        "smallest magnitude in the fit of the slope; by default a bin above the most frequent one of several blocks",
    ] = None
    high: Annotated[
        float | None,
        MAGNITUDE,
        "largest magnitude in the fit; by default the rarest one between low and the magnitude that releases most "
        "moment",
    ] = None
    profiles: Annotated[bool, TrueOrFalse(), "whether the slip of every block of an event is kept"] = False

    def __post_init__(self) -> None:
        check_fields(self)
        if self.low is not None and self.high is not None and self.low >= self.high:
            raise refusal("high", self.high, f"more than low ({self.low:g})")

    @property
    def end(self) -> float:
        """Length of the run on the loading clock."""
        return self.transient + self.window
