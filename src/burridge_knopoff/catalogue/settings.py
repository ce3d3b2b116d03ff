"""Settings of a catalogue of slip events; fields and defaults are those of the config of a study."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from burridge_knopoff.messages import refusal
from burridge_knopoff.model.fields import check_fields, settings
from burridge_knopoff.model.model import LOADINGS
from burridge_knopoff.model.ranges import HUGE, Number, OneOf, TrueOrFalse
from burridge_knopoff.running.settings import DURATION, TIME

MAGNITUDE = Number(-HUGE, HUGE)


@settings
@dataclass(frozen=True)
class CatalogueSettings:
    """Loading, time and fit of a catalogue: the keys of `catalogue` in the config, except a.

    Raises ValueError, one line, for anything out of range.
    """

    loading: Annotated[
        str,
        OneOf(LOADINGS),
        "steady: the driver always moves | quasistatic: the driver stops while any block slips; when all stick or "
        "creep it advances to the next slip",
    ] = "steady"
    transient: Annotated[float, DURATION, "time of the loading clock before the catalogue"] = 3000.0
    window: Annotated[float, TIME, "length of the catalogue on the loading clock"] = 7000.0
    low: Annotated[
        float | None,
        MAGNITUDE,
        "smallest magnitude in the fit of b; default: one bin above the most frequent magnitude of events with more "
        "than one block",
    ] = None
    high: Annotated[
        float | None,
        MAGNITUDE,
        "largest magnitude in the fit; default: the least frequent magnitude between `low` and the one that releases "
        "most moment",
    ] = None
    profiles: Annotated[bool, TrueOrFalse(), "store the slip of every block of each event, and its onset"] = False

    def __post_init__(self) -> None:
        check_fields(self)
        if self.low is not None and self.high is not None and self.low >= self.high:
            raise refusal("high", self.high, f"more than low ({self.low:g})")

    @property
    def end(self) -> float:
        """Duration of the run on the loading clock."""
        return self.transient + self.window
