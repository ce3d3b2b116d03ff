"""Outcomes of initial states by the phases of their blocks, for one amplitude of the inner blocks."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.range import Range
from burridge_knopoff.claims.verdict import (
    Measured,
    NotTestableError,
    Share,
    UndecidedError,
    count_share,
    judge_worst_share,
)
from burridge_knopoff.model.sampling import fraction_interval
from burridge_knopoff.study.formatting import span

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True)
class Criteria:
    """The criteria by which phases decide: the parameters of the judge `phases_decide`, which explains them."""

    a: Range
    close: float
    opposite: float
    correlation: float
    share: float
    loose_share: float


@dataclass(frozen=True)
class FractionIntervals:
    """The fraction of states with the claimed outcome, and its Wilson interval, over (law, a, amplitude)."""

    fraction: np.ndarray
    low: np.ndarray
    high: np.ndarray


class PhaseOutcomes:
    """The outcomes of states whose inner blocks oscillate with one fraction of the amplitude A of the end blocks.

    synchronized : fractions of the states with close phases that synchronize
    antiphase : fractions of the states with opposite phases that end in antiphase
    holds : whether enough states of both have these outcomes, by the lower ends of the intervals, shape
        (law, a, amplitude)
    without_backward_slip : mask of the amplitudes at which every velocity is positive at the start, whatever the phases
    inside : mask of the values of a that are judged

    Raises NotTestableError if phases.nc has no states, or too few, for this fraction, if some velocity is negative at
    every amplitude, and if the values of a are too few.
    """

    def __init__(self, phases: xarray.Dataset, inner_share: float, criteria: Criteria) -> None:
        if inner_share not in phases["inner_share"].values:
            raise NotTestableError(f"phases.nc has no states with an inner_share of {inner_share:g}")
        phases = phases.sel(inner_share=inner_share)
        self.laws, self.amplitude = phases["law"].values.tolist(), phases["amplitude"].values
        self.without_backward_slip = self.amplitude <= phases["slipping_amplitude"].item()
        if not self.without_backward_slip.any():
            raise NotTestableError("at every amplitude of phases.nc some block would slip backward")
        self.inside = criteria.a.choose(phases["a"].values)
        difference = phases["phase_difference"].values
        opposed = phases["velocity_correlation"] <= criteria.correlation
        self.synchronized = _count_states(phases["branch"] == 0, difference <= criteria.close, criteria.share)
        self.antiphase = _count_states(opposed, difference >= criteria.opposite, criteria.share)
        self.holds = (self.synchronized.low >= criteria.share) & (self.antiphase.low >= criteria.share)
        # Judge all laws, the values of a inside the range, and the amplitudes without backward slip.
        self.cells = np.ix_(np.arange(len(self.laws)), self.inside, self.without_backward_slip)
        self.shares = self.shares_at(self.without_backward_slip)
        self.verdict = judge_worst_share(self.shares, criteria.loose_share)

    def shares_at(self, amplitudes: np.ndarray) -> dict[str, Share]:
        """Return the share of the judged values of a at which the states of some amplitudes, a mask, all agree."""
        cells = self.holds[:, self.inside][..., amplitudes]
        return {law: count_share(cell.all(axis=1)) for law, cell in zip(self.laws, cells, strict=True)}

    @property
    def amplitudes(self) -> str:
        """The judged amplitudes, as text."""
        numbers = self.amplitude[self.without_backward_slip]
        return span(f"{numbers.min():g}", f"{numbers.max():g}")

    def format_fractions(self) -> str:
        """Return the fractions of the judged states as text, with Wilson intervals."""
        synchronized, antiphase = (
            f"{percent(outcome.fraction[self.cells])} {words} "
            f"(Wilson intervals {percent(outcome.low[self.cells], outcome.high[self.cells])})"
            for outcome, words in (
                (self.synchronized, "of the close phases synchronize"),
                (self.antiphase, "of the opposite phases end in antiphase"),
            )
        )
        return f"{synchronized}, {antiphase}"

    def measured(self, words: str, at: np.ndarray) -> Iterator[Measured]:
        """Yield the smallest fractions of states with the claimed outcome, under each law.

        words : description of the states; at : mask of amplitudes
        """
        cells = np.ix_(np.arange(len(self.laws)), self.inside, at)
        for outcome, ending in (
            (self.synchronized, "close phases that synchronize"),
            (self.antiphase, "opposite phases in antiphase"),
        ):
            for law, part in zip(self.laws, outcome.fraction[cells], strict=True):
                yield Measured(f"smallest share of {ending}, {words}, {law}", float(part.min()))


def percent(*shares: np.ndarray) -> str:
    """Return the range of fractions in percent: «97.5 to 100 %»."""
    least, most = min(part.min() for part in shares), max(part.max() for part in shares)
    return f"{span(f'{round(100 * least, 1):g}', f'{round(100 * most, 1):g}')} %"


def _count_states(claimed: xarray.DataArray, chosen: np.ndarray, share: float) -> FractionIntervals:
    """Count the states with the claimed outcome.

    claimed : over (law, a, amplitude, phase_difference, state); chosen : mask of phase differences
    share : fraction that the interval has to reach if all states have it

    Raises UndecidedError if there are too few states.
    """
    states = claimed.isel(phase_difference=chosen)
    count = states.sizes["phase_difference"] * states.sizes["state"]
    if not fraction_interval(count, count)[1] >= share:
        raise UndecidedError(f"{count} states of the same phases are too few for a share of {share:g}")
    hits = states.sum(("phase_difference", "state")).transpose("law", "a", "amplitude").values
    interval = np.transpose([fraction_interval(int(number), count) for number in hits.ravel()])
    return FractionIntervals(*interval.reshape(3, *hits.shape))
