"""Outcomes of states by the phases of their blocks, for each amplitude of the inner blocks; see `phases_decide`."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.verdict import (
    HOLDS,
    LOOSELY,
    Measured,
    NotTestableError,
    Range,
    share_of,
    shares_text,
    verdict_of,
)
from burridge_knopoff.model.sampling import fraction_interval
from burridge_knopoff.study.formatting import span

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True)
class Criteria:
    """The criteria by which phases decide: parameters of the judge, which explains them."""

    a: Range
    close: float
    opposite: float
    correlation: float
    share: float
    loose_share: float


@dataclass(frozen=True)
class Counted:
    """The fraction of states that end as claimed, and its Wilson interval, over (law, a, amplitude)."""

    fraction: np.ndarray
    low: np.ndarray
    high: np.ndarray


class Endings:
    """The outcomes of states whose inner blocks oscillate with one fraction of the amplitude A of the end blocks.

    together : states with close phases that synchronize; against : states with opposite phases that end in antiphase
    right : whether enough states of both end so, by the lower ends of the intervals, shape (law, a, amplitude)
    slips : amplitudes at which every velocity is positive at the start, whatever the phases
    inside : values of a that are judged

    Raises NotTestableError if phases.nc has no states, or too few, for this fraction, if at every amplitude some
    velocity is negative, and if the values of a are too few.
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
        # Judge all laws, the values of a inside the range, and the amplitudes without backward slip.
        self.cells = np.ix_(np.arange(len(self.laws)), self.inside, self.slips)
        cells = zip(self.laws, self.right[self.cells], strict=True)
        shares = {law: share_of(cell.all(axis=1)) for law, cell in cells}
        self.shares, own = shares_text(shares), verdict_of(shares, criteria.loose_share)
        self.verdict = LOOSELY if own == HOLDS and not self.right[:, self.inside].all() else own

    @property
    def amplitudes(self) -> str:
        """The judged amplitudes, as text."""
        numbers = self.amplitude[self.slips]
        return span(f"{numbers.min():g}", f"{numbers.max():g}")

    def told(self) -> str:
        """Describe the outcome of the judged states, with Wilson intervals."""
        together, against = (
            f"{percent(found.fraction[self.cells])} {words} "
            f"(Wilson intervals {percent(found.low[self.cells], found.high[self.cells])})"
            for found, words in (
                (self.together, "of the close phases synchronize"),
                (self.against, "of the opposite phases end in antiphase"),
            )
        )
        return f"{together}, {against}"

    def measured(self, words: str, at: np.ndarray) -> Iterator[Measured]:
        """Yield the smallest fractions of states that end as claimed, under each law.

        words : description of the states; at : mask of amplitudes
        """
        cells = np.ix_(np.arange(len(self.laws)), self.inside, at)
        for found, ending in (
            (self.together, "close phases that synchronize"),
            (self.against, "opposite phases in antiphase"),
        ):
            for law, part in zip(self.laws, found.fraction[cells], strict=True):
                yield Measured(f"smallest share of {ending}, {words}, {law}", float(part.min()))


def percent(*shares: np.ndarray) -> str:
    """Return the range of fractions in percent: «97.5 to 100.0 %»."""
    least, most = min(part.min() for part in shares), max(part.max() for part in shares)
    return f"{span(f'{100 * least:.1f}', f'{100 * most:.1f}')} %"


def _counted(claimed: xarray.DataArray, chosen: np.ndarray, share: float) -> Counted:
    """Count the states that end as claimed.

    claimed : over (law, a, amplitude, phase_difference, state); chosen : mask of phase differences
    share : fraction that the interval has to reach if all states end as claimed

    Raises NotTestableError if there are too few states.
    """
    states = claimed.isel(phase_difference=chosen)
    count = states.sizes["phase_difference"] * states.sizes["state"]
    if not fraction_interval(count, count)[1] >= share:
        raise NotTestableError(f"{count} states of the same phases are too few for a share of {share:g}")
    hits = states.sum(("phase_difference", "state")).transpose("law", "a", "amplitude").values
    found = np.transpose([fraction_interval(int(number), count) for number in hits.ravel()])
    return Counted(*found.reshape(3, *hits.shape))
