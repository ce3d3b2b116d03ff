"""Choices of ours in the judgement of a claim, with the other values that a reader may choose.

A parameter of a claim whose type is one of these is our choice: the claim is judged again with other values of it, and
the ledger says which of them change the verdict (`margins`). Other parameters are what the paper says.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

if TYPE_CHECKING:
    import xarray

#: Others may choose a number that differs by up to this factor.
FACTOR = 2.0

# Number of bisections of the exponent of FACTOR at which a verdict changes, which determine the number to 0.3 %.
BISECTIONS = 8

#: Correlation of the velocities of the end blocks up to which they are in antiphase; that of branch 2 is about −0.99.
#: Loosely it may be up to that of two sines 60° away from antiphase.
ANTIPHASE, LOOSE_ANTIPHASE = -0.9, -0.5

#: {name: summary} of a study.
Summaries = Mapping[str, "xarray.Dataset"]
#: Returns the verdict for another value if it is another verdict, "" if not.
ChangedVerdict = Callable[[Any], str]


@dataclass(frozen=True)
class Scaled:
    """A number of which values within FACTOR are tried, down to the nearest that changes the verdict.

    words : what it is, for «undecided if … were at least 2»
    percent : whether it is given in per cent; of_one : whether its distance from 1 is scaled
    whole : whether it is a whole number
    """

    words: str
    percent: bool = False
    of_one: bool = False
    whole: bool = False

    def conditions(self, value: float, changed_verdict: ChangedVerdict, _summaries: Summaries) -> Iterator[str]:
        """Yield each changed verdict with the values that give it: «fails if the tolerance were at least 0.02 …»."""

        def verdict_at(exponent: float) -> str:
            return changed_verdict(self.scaled(value, exponent))

        ends = [_nearest_change(verdict_at, side) for side in (-1.0, 1.0)]
        if len({other for _, other in ends if other}) == 1 and all(abs(end) <= 2.0**-BISECTIONS for end, _ in ends):
            yield f"{ends[0][1]} if {self.words} were not exactly {value:g}"
            return
        for end, other in ends:
            if other:
                last = self.scaled(value, end)
                limit = f"at {'least' if last > value else 'most'} {self._text(_rounded(last, up=last > value))}"
                yield f"{other} if {self.words} were {limit} (it is {self._text(value)})"

    def _text(self, value: float) -> str:
        return f"{100.0 * value:g} %" if self.percent else f"{value:g}"

    def scaled(self, value: float, exponent: float) -> float:
        """Return the number, or its distance from 1, multiplied by a power of FACTOR."""
        factor = FACTOR**exponent
        if self.whole:
            return round(value * factor)
        if not self.of_one:
            return value * factor
        return math.copysign(min(max(1.0 - factor * (1.0 - abs(value)), 0.0), 1.0), value)


def _nearest_change(verdict_at: Callable[[float], str], side: float) -> tuple[float, str]:
    """Return the exponent nearest to 0, towards a side, at which the verdict is found to change, and the verdict there.

    "" if the verdict is unchanged at the side itself.
    """
    same, end, other = 0.0, side, verdict_at(side)
    if not other:
        return side, ""
    for _ in range(BISECTIONS):
        middle = 0.5 * (same + end)
        if verdict := verdict_at(middle):
            end, other = middle, verdict
        else:
            same = middle
    return end, other


def _rounded(value: float, *, up: bool) -> float:
    """Return a value to three digits, rounded up or down."""
    unit = 10.0 ** (math.floor(math.log10(abs(value))) - 2) if value else 1.0
    return float(f"{(math.ceil if up else math.floor)(value / unit) * unit:.3g}")


@dataclass(frozen=True)
class Along:
    """A value of a coordinate of a summary, which has data for a few values only.

    is_bound : whether the nearest value on each side, within FACTOR, that changes the verdict stands for all beyond;
        otherwise each other value is a choice of its own
    """

    words: str
    summary: str
    coordinate: str
    is_bound: bool = False

    def conditions(self, value: float, changed_verdict: ChangedVerdict, summaries: Summaries) -> Iterator[str]:
        """Yield each changed verdict with the value that gives it."""
        if self.summary not in summaries:
            return
        values = np.unique(summaries[self.summary][self.coordinate].values)
        if not self.is_bound:
            for other in summaries[self.summary][self.coordinate].values.tolist():
                if verdict := changed_verdict(other):
                    yield f"{verdict} if {self.words} were {other:g} (it is {value:g})"
            return
        smaller = values[(values >= value / FACTOR) & (values < value)][::-1]
        larger = values[(values > value) & (values <= value * FACTOR)]
        for side, candidates in (("most", smaller), ("least", larger)):
            verdicts = ((other, changed_verdict(other)) for other in candidates.tolist())
            if first := next(((other, verdict) for other, verdict in verdicts if verdict), None):
                yield f"{first[1]} if {self.words} were at {side} {first[0]:g} (it is {value:g})"


@dataclass(frozen=True)
class Part:
    """The part of the runs that is judged; others : {part: its words}."""

    others: tuple[tuple[str, str], ...] = (("window", "the window"), ("run", "the whole run"))

    def conditions(self, value: str, changed_verdict: ChangedVerdict, _summaries: Summaries) -> Iterator[str]:
        """Yield each changed verdict with the part that gives it."""
        words = dict(self.others)
        for part, name in self.others:
            if verdict := changed_verdict(part):
                yield f"{verdict} if {name} were used instead of {words[value]}"


Tolerance = Annotated[float, Scaled("the tolerance")]
LooseTolerance = Annotated[float, Scaled("the tolerance for “holds loosely”")]
Near = Annotated[float, Scaled("the distance that counts as near")]
Relative = Annotated[float, Scaled("the relative tolerance")]
Much = Annotated[float, Scaled("the ratio that counts as large")]
Points = Annotated[int, Scaled("the largest number of section points that is no cloud", whole=True)]
Samples = Annotated[
    int, Scaled("the number of sampled states that show whether an attractor is the only one", whole=True)
]
StateShare = Annotated[float, Scaled("the required share of states", percent=True, of_one=True)]
LooseShare = Annotated[float, Scaled("the share for “holds loosely”", percent=True, of_one=True)]
Correlation = Annotated[float, Scaled("the correlation that counts as antiphase", of_one=True)]
LooseCorrelation = Annotated[float, Scaled("the correlation that counts loosely as antiphase", of_one=True)]
ModeDeviation = Annotated[
    float, Scaled("the deviation from a mode, in amplitude ratio and phase, up to which the motion is one of it")
]
Close = Annotated[
    float, Along("the phase difference up to which phases are close", "phases", "phase_difference", is_bound=True)
]
Opposite = Annotated[
    float, Along("the phase difference from which phases are opposite", "phases", "phase_difference", is_bound=True)
]
InnerShare = Annotated[float, Along("the amplitude of the middle block over A", "phases", "inner_share")]
Level = Annotated[float, Along("the level below which J counts as 0", "mean_distance", "level")]
Detuning = Annotated[float, Along("the detuning", "rotation", "detuning")]
RunPart = Annotated[str, Part()]
