"""Values of a parameter inserted between neighbours whose attractors differ, until each change is located."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

from burridge_knopoff.attractors.attractor import Attractor
from burridge_knopoff.attractors.capture_radius import PERTURBATION_GROUP
from burridge_knopoff.attractors.search import Search
from burridge_knopoff.continuation.matching import Matcher, Outline, outlines
from burridge_knopoff.continuation.settings import RefinementSettings
from burridge_knopoff.model.model import Model, recorded_value
from burridge_knopoff.running.processes import ParallelMap, Span

#: Indices of the attractors at both ends of a gap that differ.
Differing = tuple[list[int], list[int]]


@dataclass(frozen=True, eq=False)
class Gap:
    """Two values of a parameter without a known value in between.

    parameter : its name
    search : a search without attractors, with the settings for values in between
    first, last : models at both ends; before, after : attractors there that may differ, one of each mirror pair
    unchanged : other attractors, which are the same at both ends
    """

    parameter: str
    search: Search
    first: Model
    last: Model
    before: Sequence[Attractor]
    after: Sequence[Attractor]
    unchanged: Sequence[Attractor]

    @property
    def ends(self) -> tuple[float, float]:
        """The values of the parameter."""
        return self.first.parameter(self.parameter), self.last.parameter(self.parameter)

    def is_open(self, refine: RefinementSettings) -> bool:
        """Return whether attractors differ and the values are farther apart than the resolution."""
        low, high = self.ends
        near = high - low <= refine.resolution * (1.0 + 1e-9)
        return bool(self.before or self.after) and not near


def refine_searches(
    searches: Sequence[Search],
    refine: RefinementSettings,
    matcher: Matcher,
    pool: ParallelMap,
    span: Span | None = None,
    parameter: str = "a",
) -> list[list[Search]]:
    """Return the searches at values of a parameter inserted between each two neighbours of the grid, ascending.

    refine : how closely changes are located
    pool, span : from `running.processes.parallel_map`, and see `ParallelMap`

    No value is inserted if nothing changes. At an inserted value only those attractors are followed that change between
    its neighbours, in kind, symmetry or period, or that have no counterpart. No value is inserted next to one without
    attractors, as a = 0: perturbations of sliding grow at a rate ∝ a, so that no motion would settle in time.
    """
    middles: list[list[Search]] = [[] for _ in searches[1:]]
    differ = pool("neighbours compared", partial(_compare, matcher=matcher), searches[:-1], searches[1:])
    gaps = [(k, _gap(parameter, *pair, *differ[k])) for k, pair in enumerate(pairwise(searches))]

    def halves(k: int, gap: Gap, halved: tuple[Search, Differing, Differing]) -> list[tuple[int, Gap]]:
        middle, low, high = halved
        middles[k].append(middle)
        attractors = middle.attractors
        lower = _select(gap.before, low[0]), _select(attractors, low[1])
        upper = _select(attractors, high[0]), _select(gap.after, high[1])
        both = (
            replace(gap, last=middle.model, before=lower[0], after=lower[1]),
            replace(gap, first=middle.model, before=upper[0], after=upper[1]),
        )
        return [(k, half) for half in both if half.is_open(refine)]

    pool.work_through(
        "values inserted",
        partial(_bisect, matcher=matcher),
        [pair for pair in gaps if pair[1].is_open(refine)],
        halves,
        span,
    )
    return [sorted(inner, key=lambda search: recorded_value(search.model, parameter)) for inner in middles]


def _compare(left: Search, right: Search, matcher: Matcher) -> Differing:
    """Return the indices of the attractors of two neighbours of the grid that differ."""
    if not left.attractors or not right.attractors:
        return [], []
    before, after = (outlines(side.attractors) for side in (left, right))
    return _differing(before, after, matcher)


def _gap(parameter: str, left: Search, right: Search, before: Sequence[int], after: Sequence[int]) -> Gap:
    """Return the gap between two neighbours of the grid, from the indices of the attractors that differ."""
    # The attractors of the neighbours have settled nearby, so less work suffices. No states are labelled, so a few
    # small perturbations decide whether a motion attracts, and an ensemble decides whether chaos persists.
    settings = replace(left.settings, perturbations=min(left.settings.perturbations, PERTURBATION_GROUP))
    capture = replace(left.capture, shrinking=16.0, largest=left.capture.largest / 16.0)
    search = replace(
        left,
        settings=settings,
        capture=capture,
        longest_extension=left.longest_extension // 4,
        trials=1,
        attractors=[],
        unsuccessful_states=(),
    )
    unchanged = [k for k in outlines(left.attractors) if k not in before]
    ends = _select(left.attractors, before), _select(right.attractors, after)
    return Gap(parameter, search, left.model, right.model, *ends, _select(left.attractors, unchanged))


def _bisect(gap: Gap, matcher: Matcher) -> tuple[Search, Differing, Differing]:
    """Follow attractors at the middle of a gap; return the search there, and what differs below and above it."""
    low, high = gap.ends
    middle = replace(gap.search, model=gap.first.at(**{gap.parameter: 0.5 * (low + high)}), attractors=[])
    middle.find(middle.seeds([*gap.before, *gap.after]), check=False)
    sources, before, after = (
        {k: Outline(item) for k, item in enumerate(attractors)}
        for attractors in ([*gap.unchanged, *gap.before], gap.before, gap.after)
    )
    # A seed may have left for an attractor that does not change.
    middle_outlines = outlines(middle.attractors)
    origin = matcher.match(sources, middle_outlines)
    middle_outlines = {
        k: item for k, item in middle_outlines.items() if origin.get(k, len(gap.unchanged)) >= len(gap.unchanged)
    }
    return middle, _differing(before, middle_outlines, matcher), _differing(middle_outlines, after, matcher)


def _differing(before: Mapping[int, Outline], after: Mapping[int, Outline], matcher: Matcher) -> Differing:
    one, other = matcher.unmatched(before, after)
    return list(one), list(other)


def _select(attractors: Sequence[Attractor], numbers: Sequence[int]) -> list[Attractor]:
    return [attractors[k] for k in numbers]
