"""Values of a put in between two neighbours at which attractors differ, until each change lies between near values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

from burridge_knopoff.attractors.attractor import Attractor
from burridge_knopoff.attractors.capture_radius import PUSH_GROUP
from burridge_knopoff.attractors.search import Search
from burridge_knopoff.continuation.matching import Matcher, Outline, outlines
from burridge_knopoff.continuation.settings import Refine
from burridge_knopoff.model.model import Model
from burridge_knopoff.running.processes import ParallelMap

#: Numbers of the attractors on both sides of a gap that differ.
Differing = tuple[list[int], list[int]]


@dataclass(frozen=True, eq=False)
class Gap:
    """Two values of a with nothing known in between.

    search : without attractors, how they are looked for there
    first, last : models at both ends; before, after : attractors there, of a mirror pair one, that may differ
    still : others, which are the same at both ends
    """

    search: Search
    first: Model
    last: Model
    before: Sequence[Attractor]
    after: Sequence[Attractor]
    still: Sequence[Attractor]

    def is_open(self, refine: Refine) -> bool:
        """Tell whether something differs between values that are not near enough."""
        near = self.last.a - self.first.a <= refine.resolution * (1.0 + 1e-9)
        return bool(self.before or self.after) and not near


def refined(searches: Sequence[Search], refine: Refine, matcher: Matcher, each: ParallelMap) -> list[list[Search]]:
    """Return searches at values of a between each two neighbours of the grid, ascending; none where nothing changes.

    refine : how near to each other the values have to be at which something differs
    each : as `running.processes.parallel_map` gives it

    At a value that is put in only those attractors are followed that change between its neighbours: in kind, symmetry
    or period, or in that they have no counterpart. Where nothing attracts, as at a = 0, nothing is put in:
    perturbations of sliding grow at a rate ∝ a, so that nothing would settle there.
    """
    found: list[list[Search]] = [[] for _ in searches[1:]]
    differ = each("compared with the next", partial(_between, matcher=matcher), searches[:-1], searches[1:])
    gaps = [(k, _gap(*pair, *differ[k])) for k, pair in enumerate(pairwise(searches))]

    def halves(k: int, gap: Gap, halved: tuple[Search, Differing, Differing]) -> list[tuple[int, Gap]]:
        middle, low, high = halved
        found[k].append(middle)
        here = middle.attractors
        lower = _chosen(gap.before, low[0]), _chosen(here, low[1])
        upper = _chosen(here, high[0]), _chosen(gap.after, high[1])
        both = (
            replace(gap, last=middle.model, before=lower[0], after=lower[1]),
            replace(gap, first=middle.model, before=upper[0], after=upper[1]),
        )
        return [(k, half) for half in both if half.is_open(refine)]

    each.work_through(
        "refined", partial(_halved, matcher=matcher), [one for one in gaps if one[1].is_open(refine)], halves
    )
    return [sorted(inner, key=lambda search: search.model.a) for inner in found]


def _between(left: Search, right: Search, matcher: Matcher) -> Differing:
    """Return which attractors of two neighbours of the grid differ."""
    if not left.attractors or not right.attractors:
        return [], []
    before, after = (outlines(side.attractors) for side in (left, right))
    return _differing(before, after, matcher)


def _gap(left: Search, right: Search, before: Sequence[int], after: Sequence[int]) -> Gap:
    """Return the gap between two neighbours of the grid, from what differs."""
    # What is known of the neighbours has settled nearby: less work tells what it has become. No states are labelled, so
    # that few perturbations, but small ones, show whether it attracts; and an ensemble shows whether chaos lasts.
    settings = replace(left.settings, perturbations=min(left.settings.perturbations, PUSH_GROUP))
    capture = replace(left.capture, shrinking=16.0, largest=left.capture.largest / 16.0)
    search = replace(
        left,
        settings=settings,
        capture=capture,
        patience=left.patience // 4,
        trials=1,
        attractors=[],
        vain=(),
    )
    still = [k for k in outlines(left.attractors) if k not in before]
    ends = _chosen(left.attractors, before), _chosen(right.attractors, after)
    return Gap(search, left.model, right.model, *ends, _chosen(left.attractors, still))


def _halved(gap: Gap, matcher: Matcher) -> tuple[Search, Differing, Differing]:
    """Follow what may differ at a value in the middle; return what is there, and what differs below and above it."""
    middle = replace(gap.search, model=gap.first.at(0.5 * (gap.first.a + gap.last.a)), attractors=[])
    middle.labels(middle.seeds([*gap.before, *gap.after]), check=False)
    known, before, after = (
        {k: Outline(item) for k, item in enumerate(attractors)}
        for attractors in ([*gap.still, *gap.before], gap.before, gap.after)
    )
    # What a seed has left for may be an attractor that does not change.
    here = outlines(middle.attractors)
    origin = matcher.matched(known, here)
    here = {k: item for k, item in here.items() if origin.get(k, len(gap.still)) >= len(gap.still)}
    return middle, _differing(before, here, matcher), _differing(here, after, matcher)


def _differing(before: Mapping[int, Outline], after: Mapping[int, Outline], matcher: Matcher) -> Differing:
    one, other = matcher.differing(before, after)
    return list(one), list(other)


def _chosen(attractors: Sequence[Attractor], numbers: Sequence[int]) -> list[Attractor]:
    return [attractors[k] for k in numbers]
