"""Values of a put in between two neighbours at which attractors differ, until each change lies between near values."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import count, pairwise
from typing import Any

from burridge_knopoff.model.model import Model
from burridge_knopoff.stability.attractor import Attractor
from burridge_knopoff.stability.attractors import Search
from burridge_knopoff.stability.matching import Outline, differing, matched, outlines
from burridge_knopoff.stability.settings import Refine
from burridge_knopoff.stability.tuning import Tuning


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


# A model, and attractors there by a number.
_End = tuple[Model, Mapping[int, Outline]]


def refined(searches: Sequence[Search], refine: Refine, each: Callable[..., list[Any]]) -> list[list[Search]]:
    """Return searches at values of a between each two neighbours of the grid, ascending; none where nothing changes.

    refine : how near to each other the values have to be at which something differs
    each : as `running.processes.shared_out` gives it

    At a value that is put in only those attractors are followed that change between its neighbours: in kind, symmetry
    or period, or in that they have no counterpart. Where nothing attracts, as at a = 0, nothing is put in:
    perturbations of sliding grow at a rate ∝ a, so that nothing would settle there.
    """
    found: list[list[Search]] = [[] for _ in searches[1:]]
    gaps = list(enumerate(each("compared with the next", _between, searches[:-1], searches[1:])))
    for step in count(1):
        gaps = [(k, gap) for k, gap in gaps if gap is not None and gap.is_open(refine)]
        if not gaps:
            break
        halved = each(f"refined, step {step}", _halved, [gap for _, gap in gaps])
        for (k, _), (middle, *_) in zip(gaps, halved, strict=True):
            found[k].append(middle)
        gaps = [(k, half) for (k, _), (_, *halves) in zip(gaps, halved, strict=True) for half in halves]
    return [sorted(inner, key=lambda search: search.model.a) for inner in found]


def _between(left: Search, right: Search) -> Gap | None:
    """Return the gap between two neighbours of the grid, None if there is nothing to look for."""
    if not left.attractors or not right.attractors:
        return None
    # What is known of the neighbours has settled nearby: less work tells what it has become. No states are labelled, so
    # that few pushes show whether it attracts; and an ensemble shows whether chaos lasts.
    tuning = replace(left.tuning, patience=left.tuning.patience // 4, trials=1, shrinking=16.0)
    settings = replace(left.settings, pushes=min(left.settings.pushes, tuning.push_group))
    search = Search(left.model, settings, left.motion_settings, tuning)
    before, after = (outlines(side.attractors, tuning) for side in (left, right))
    changed, _ = differing(before, after, left.model.scale, tuning)
    still = [item.attractor for k, item in before.items() if k not in changed]
    return _gap(search, (left.model, before), (right.model, after), still)


def _halved(gap: Gap) -> tuple[Search, Gap, Gap]:
    """Follow what may differ at a value in the middle; return what is there, and the gaps on both sides of it."""
    search, tuning = gap.search, gap.search.tuning
    middle = replace(search, model=gap.first.at(0.5 * (gap.first.a + gap.last.a)), attractors=[])
    middle.labels(middle.seeds([*gap.before, *gap.after]), check=False)
    # What a seed has left for may be an attractor that does not change.
    here = outlines(middle.attractors, tuning)
    origin = matched(_numbered([*gap.still, *gap.before], tuning), here, middle.model.scale, tuning)
    here = {k: item for k, item in here.items() if origin.get(k, len(gap.still)) >= len(gap.still)}
    ends = ((gap.first, _numbered(gap.before, tuning)), (middle.model, here), (gap.last, _numbered(gap.after, tuning)))
    low, high = (_gap(search, *pair, gap.still) for pair in pairwise(ends))
    return middle, low, high


def _gap(search: Search, first: _End, last: _End, still: Sequence[Attractor]) -> Gap:
    """Return the gap between two models, each with attractors of which those are kept that differ."""
    sides = differing(first[1], last[1], first[0].scale, search.tuning)
    before, after = ([item.attractor for item in side.values()] for side in sides)
    return Gap(search, first[0], last[0], before, after, still)


def _numbered(attractors: Sequence[Attractor], tuning: Tuning) -> dict[int, Outline]:
    return {k: Outline(item, tuning.compared_returns) for k, item in enumerate(attractors)}
