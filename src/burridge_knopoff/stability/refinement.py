"""Values of a put in between two neighbours at which attractors differ, until each change lies between near values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from burridge_knopoff.model.model import Model
from burridge_knopoff.stability.attractors import Search
from burridge_knopoff.stability.matching import Outline, differing, matched, outlines
from burridge_knopoff.stability.settings import Refine

#: Attractors of one model by a number.
Outlines = Mapping[int, Outline]


def refined(left: Search, right: Search, refine: Refine) -> list[Search]:
    """Return searches at values of a between two neighbours of the grid, ascending; none if nothing changes.

    refine : how near to each other the values have to be at which something differs

    At a value that is put in only those attractors are followed that change between its neighbours: in kind, symmetry
    or period, or in that they have no counterpart. Where nothing attracts, as at a = 0, nothing is put in:
    perturbations of sliding grow at a rate ∝ a, so that nothing would settle there.
    """
    if not left.attractors or not right.attractors:
        return []
    # What is known of the neighbours has settled nearby: less work tells what it has become. No states are labelled, so
    # that few pushes show whether it attracts; and an ensemble shows whether chaos lasts.
    tuning = replace(left.tuning, patience=left.tuning.patience // 4, trials=1, shrinking=16.0)
    settings = replace(left.settings, pushes=min(left.settings.pushes, tuning.push_group))
    before, after = outlines(left.attractors, tuning), outlines(right.attractors, tuning)
    scale = left.model.scale
    changed, _ = differing(before, after, scale, tuning)
    still = {k: item for k, item in before.items() if k not in changed}

    def between(first: Model, before: Outlines, last: Model, after: Outlines) -> list[Search]:
        before, after = differing(before, after, scale, tuning)
        near = last.a - first.a <= refine.resolution * (1.0 + 1e-9)
        if near or not (before or after):
            return []
        middle = Search(first.at(0.5 * (first.a + last.a)), settings, left.motion_settings, tuning)
        seeds = middle.seeds(item.attractor for item in (*before.values(), *after.values()))
        middle.labels(seeds, check=False)
        here = outlines(middle.attractors, tuning)
        # What a seed has left for may be an attractor that does not change.
        numbered = {**still, **{-1 - k: item for k, item in before.items()}}
        other = {k for k, old in matched(numbered, here, scale, tuning).items() if old in still}
        here = {k: item for k, item in here.items() if k not in other}
        return [
            *between(first, before, middle.model, here),
            middle,
            *between(middle.model, here, last, after),
        ]

    return between(left.model, before, right.model, after)
