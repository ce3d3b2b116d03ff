"""How states by their phases end, counted for each share of the inner blocks: what `history.phases_decide` judges."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.conventions import judge_shares
from burridge_knopoff.claims.verdict import HOLDS, LOOSELY, Measured, NotTestableError, Range
from burridge_knopoff.model.sampling import fraction_interval
from burridge_knopoff.study.formatting import span

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True)
class Criteria:
    """When phases decide: parameters of the judge, which says what they are."""

    a: Range
    close: float
    opposite: float
    correlation: float
    share: float
    loose_share: float


@dataclass(frozen=True)
class Counted:
    """Which fraction of the states ends as claimed, and the ends of its Wilson interval, over (law, a, amplitude)."""

    fraction: np.ndarray
    low: np.ndarray
    high: np.ndarray


class Endings:
    """How the states end whose inner blocks oscillate with one share of the amplitude A of the end blocks.

    together : the states of close phases that synchronize; against : those of opposite phases that end in antiphase
    right : whether enough states of both end so, by the lower ends of the intervals, shape (law, a, amplitude)
    slips : at which amplitudes every velocity is positive at the start, whatever the phases
    inside : which values of a are judged

    Raises NotTestableError for a share that phases.nc has no states of, or too few, and where no amplitude slips.
    """

    def __init__(self, phases: xarray.Dataset, inner_share: float, criteria: Criteria) -> None:
        if inner_share not in phases["inner_share"].values:
            raise NotTestableError(f"phases.nc has no states with an inner_share of {inner_share:g}")
        phases = phases.sel(inner_share=inner_share)
        self.laws, self.amplitude = phases["law"].values.tolist(), phases["amplitude"].values
        self.slips = self.amplitude <= phases["slipping_amplitude"].item()
        if not self.slips.any():
            raise NotTestableError("at every amplitude of phases.nc some block would slip backward")
        self.inside = criteria.a.choose(phases["a"].values)
        difference, antiphase = (
            phases["phase_difference"].values,
            phases["velocity_correlation"] <= criteria.correlation,
        )
        self.together = _counted(phases["branch"] == 0, difference <= criteria.close, criteria.share)
        self.against = _counted(antiphase, difference >= criteria.opposite, criteria.share)
        self.right = (self.together.low >= criteria.share) & (self.against.low >= criteria.share)
        # What is judged: all laws, the values of a inside, and the amplitudes that slip.
        self.cells = np.ix_(np.arange(len(self.laws)), self.inside, self.slips)
        cells = zip(self.laws, self.right[self.cells], strict=True)
        own, self.shares = judge_shares(
            {law: float(cell.all(axis=1).mean()) for law, cell in cells}, criteria.loose_share
        )
        self.verdict = LOOSELY if own == HOLDS and not self.right[:, self.inside].all() else own

    @property
    def amplitudes(self) -> str:
        """The amplitudes that are judged, as text."""
        numbers = self.amplitude[self.slips]
        return span(f"{numbers.min():g}", f"{numbers.max():g}")

    def told(self) -> str:
        """Return what becomes of the states that are judged, with their Wilson intervals."""
        together, against = (
            f"{percent(found.fraction[self.cells])} {words} "
            f"(Wilson intervals {percent(found.low[self.cells], found.high[self.cells])})"
            for found, words in (
                (self.together, "of the close phases synchronize"),
                (self.against, "of the opposite ones end in antiphase"),
            )
        )
        return f"{together}, {against}"

    def measured(self, words: str, at: np.ndarray) -> Iterator[Measured]:
        """Yield the least shares of the states that end as claimed, under each law.

        words : which states; at : amplitudes, a mask
        """
        cells = np.ix_(np.arange(len(self.laws)), self.inside, at)
        for found, ending in (
            (self.together, "close phases that synchronize"),
            (self.against, "opposite phases in antiphase"),
        ):
            for law, part in zip(self.laws, found.fraction[cells], strict=True):
                yield Measured(f"least share of {ending}, {words}, {law}", float(part.min()))


def percent(*shares: np.ndarray) -> str:
    """Return from where to where shares reach: «97.5 to 100.0 %»."""
    least, most = min(part.min() for part in shares), max(part.max() for part in shares)
    return f"{span(f'{100 * least:.1f}', f'{100 * most:.1f}')} %"


def _counted(claimed: xarray.DataArray, chosen: np.ndarray, share: float) -> Counted:
    """Count the states that end as claimed.

    claimed : over (law, a, amplitude, phase_difference, state); chosen : which differences of phase
    share : what the interval of all states has to reach

    Raises NotTestableError if there are too few states.
    """
    states = claimed.isel(phase_difference=chosen)
    count = states.sizes["phase_difference"] * states.sizes["state"]
    if not fraction_interval(count, count)[1] >= share:
        raise NotTestableError(f"{count} states of the same phases are too few for a share of {share:g}")
    hits = states.sum(("phase_difference", "state")).transpose("law", "a", "amplitude").values
    found = np.transpose([fraction_interval(int(number), count) for number in hits.ravel()])
    return Counted(*found.reshape(3, *hits.shape))
