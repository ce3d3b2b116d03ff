"""The outcome of the paper's initial states over (law, initial, a): the motion of the runs, or on attractors reached.

Both have the same properties, so that one expression judges a statement from the runs of the study and, under other
conventions of contact and start, from the attractors that the states reach.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from burridge_knopoff.attractors.lookup import reached_slots
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.range import Range
from burridge_knopoff.motion.kind import MotionKind, merge_chaos

if TYPE_CHECKING:
    import xarray

#: Kinds of motion that repeat.
PERIODIC_KINDS = (MotionKind.SYNCHRONIZED, MotionKind.PERIODIC)


@dataclass(frozen=True)
class Runs:
    """The motion of the study's runs from some initial states in a range of a, completed runs only."""

    evidence: Evidence
    initial: Sequence[str]
    a: Range

    def of(self, summary: str, name: str) -> xarray.DataArray:
        """Return a variable of a summary."""
        return self.evidence.choose(self.evidence.state_summary(summary, self.initial), self.a)[name]

    @property
    def kind(self) -> xarray.DataArray:
        """Kind of motion of the attractor that a run has reached, or of the run; all chaos is one kind."""
        return one_chaos(self.of("agreement", "kind"))

    @property
    def synchronized(self) -> xarray.DataArray:
        """Whether the end blocks are synchronized: 1 or 0, NaN where the run did not complete."""
        return self.of("mean_distance", "synchronized")

    @property
    def section(self) -> xarray.Dataset:
        """Number of section points, and mean, smallest and largest W' of them; NaN where the run did not complete."""
        names = {f"section_velocity_{name}": name for name in ("mean", "min", "max")}
        runs = self.evidence.choose(self.evidence.state_summary("runs", self.initial), self.a)
        return runs[["section_count", *names]].rename({"section_count": "count", **names})


@dataclass(frozen=True)
class Reached:
    """The motion on the attractors that some initial states reach.

    attractors : under one convention, in a range of a
    """

    evidence: Evidence
    attractors: xarray.Dataset
    initial: Sequence[str]

    def of(self, name: str) -> xarray.DataArray:
        """Return a variable of the attractors; meaningless where `is_known` is false."""
        _, slot = self._slots
        return self.attractors[name].isel(attractor=slot)

    @property
    def is_known(self) -> xarray.DataArray:
        """Whether the attractor is known."""
        return self._slots[0]

    @property
    def branch(self) -> xarray.DataArray:
        """Branch of the attractor."""
        return self.attractors["initial_branch"].sel(initial=list(self.initial))

    @property
    def kind(self) -> xarray.DataArray:
        """Kind of motion on the attractor; all chaos is one kind."""
        return one_chaos(self.of("kind")).where(self.is_known, MotionKind.UNDETERMINED)

    @property
    def synchronized(self) -> xarray.DataArray:
        """Whether the attractor is the synchronized one: 1 or 0, NaN where it is not known."""
        return (self.branch == 0).where(self.branch >= 0)

    @property
    def section(self) -> xarray.Dataset:
        """Number of section points, and mean W' of them; NaN where they are not known."""
        count = self.of("section_count")
        is_known = self.is_known & (count >= 0)
        mean = self.of("section_velocity_mean")
        return count.where(is_known).to_dataset(name="count").assign(mean=mean.where(is_known))

    @property
    def _slots(self) -> tuple[xarray.DataArray, xarray.DataArray]:
        def slots() -> tuple[xarray.DataArray, xarray.DataArray]:
            return reached_slots(self.attractors.sel(initial=list(self.initial)))

        return self.evidence.cached(("slots", tuple(self.initial)), slots, self.attractors)


def one_chaos(kind: xarray.DataArray) -> xarray.DataArray:
    """Return kinds of motion in which all chaos is one kind."""
    return kind.copy(data=merge_chaos(kind.values))


def reached_attractor(
    attractors: xarray.Dataset, at: float, initial: str, law: str, *names: str
) -> tuple[Any, ...] | None:
    """Return variables of the attractor that an initial state reaches at one a; None if none is known.

    attractors : under one convention
    """
    slots = attractors.sel(a=at, initial=initial, law=law)
    is_known, slot = (part.item() for part in reached_slots(slots))
    return tuple(slots[name].isel(attractor=slot).values for name in names) if is_known else None
