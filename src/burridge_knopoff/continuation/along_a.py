"""The attractors of one law along a: found at each a from states, handed on to the values beside it, and refined.

Between neighbouring values of a at which the attractors differ, values are put in until the change lies between two
that are near enough to each other. What is done at one a, or between two, is shared out among processes; only what
has just been handed on goes on from value to value.

Reference: G. Datseris, K. Luiz Rossi and A. Wagemakers, "Framework for global stability analysis of dynamical systems",
Chaos 33 (2023) 073151: the search at each parameter begins from the attractors at the one before.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from pathlib import Path

import numpy as np

from burridge_knopoff.attractors.attractor import Attractor
from burridge_knopoff.attractors.labels import UNDETERMINED
from burridge_knopoff.attractors.lifetime import Lifetime, lifetimes
from burridge_knopoff.attractors.search import Search
from burridge_knopoff.attractors.settings import SEARCH, SearchSettings
from burridge_knopoff.attractors.table import Row
from burridge_knopoff.basins.fractions import fraction_labels
from burridge_knopoff.continuation.branches import REMEMBERED, branches
from burridge_knopoff.continuation.matching import Matcher, outlines
from burridge_knopoff.continuation.refinement import refined
from burridge_knopoff.continuation.settings import REFINE, Refine
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.settings import MOTION, MotionSettings
from burridge_knopoff.running.processes import ParallelMap, parallel_map


@dataclass(frozen=True, eq=False)
class Continuation:
    """The attractors of one law along a.

    models : at each a, ascending: those that were given, and those that were put in between them
    grid : positions in `models` of those that were given
    attractors : for each given model those that coexist there; for the others those that change there
    lifetimes : for each model and attractor its lifetime if it is chaotic, None if it is not
    branch, side : for each model and attractor the number of its branch and its side of it; see `branches.branches`
    upward, downward : for each given model and attractor the index of the attractor reached at the next or the previous
        given one, −1 where it is undetermined or there is none
    samples : for each given model the index reached by each state that was drawn for the basin fractions
    """

    models: list[Model]
    grid: list[int]
    attractors: list[list[Attractor]]
    lifetimes: list[list[Lifetime | None]]
    branch: list[np.ndarray]
    side: list[np.ndarray]
    upward: list[np.ndarray]
    downward: list[np.ndarray]
    samples: list[np.ndarray]

    def rows(self, place: int) -> list[Row]:
        """Return the attractors of one model as rows of the table, in the order of branch and side."""
        known = self.attractors[place], self.lifetimes[place], self.branch[place].tolist(), self.side[place].tolist()
        rows = [Row(index, *one) for index, one in enumerate(zip(*known, strict=True))]
        return sorted(rows, key=lambda row: (row.branch, -row.side))


def continue_attractors(
    models: Sequence[Model],
    settings: SearchSettings = SEARCH,
    motion: MotionSettings = MOTION,
    refine: Refine = REFINE,
    *,
    starts: Sequence[InitialState] = (),
    start: str = "moving",
    processes: int = 1,
    folder: str | Path | None = None,
) -> Continuation:
    """Find the attractors of all models, of ascending a, from initial states and from each other, and match them.

    settings, motion, starts, start : see `find_attractors`
    refine : how near in a a change is looked for
    processes, folder : that work at once, and where they keep what they find; see `parallel_map`. No result depends on
        them

    Raises ValueError if an initial state does not fit the models.
    """
    matcher = Matcher(models[0].scale, refine.longest_period)
    with parallel_map(processes, folder) as each:
        searches = [Search(model, settings, motion) for model in models]
        searches = each("searched from states", partial(_searched, starts=starts, start=start), searches)
        searches = _hand_on(searches, each, matcher, [True] * len(searches))
        samples = [np.zeros(0, dtype=np.intc) for _ in searches]
        gained = [True] * len(searches)
        while any(gained):
            known = [len(search.attractors) for search in searches]
            those = [k for k, more in enumerate(gained) if more]
            found = fraction_labels([searches[k] for k in those], start, each)
            for k, search, labels in zip(those, *found, strict=True):
                searches[k], samples[k] = search, labels
            # What only these states have led to is looked for at the neighbours as well.
            handed = _hand_on(
                searches,
                each,
                matcher,
                [len(one.attractors) > count for one, count in zip(searches, known, strict=True)],
            )
            gained = [_knows_more(one, before) for one, before in zip(handed, searches, strict=True)]
            searches = [one if more else before for one, more, before in zip(handed, gained, searches, strict=True)]
        # The sets of attractors are complete now: what follows only reads them.
        upward = each("carried upward", _carried, searches[:-1], searches[1:])
        downward = each("carried downward", _carried, searches[1:], searches[:-1])
        whole = [searches[0]]
        for inner, search in zip(refined(searches, refine, matcher, each), searches[1:], strict=True):
            whole += [*inner, search]
        lived = each("lifetimes", _lifetimes, whole)
    attractors = [search.attractors for search in whole]
    # At the ends of the grid nothing follows.
    first, last = (np.full(len(search.attractors), UNDETERMINED) for search in (searches[0], searches[-1]))
    width = max((other.a - one.a for one, other in pairwise(models)), default=0.0)
    grid = [whole.index(search) for search in searches]
    values, reach = [search.model.a for search in whole], REMEMBERED * width
    return Continuation(
        [search.model for search in whole],
        grid,
        attractors,
        lived,
        *branches(values, attractors, grid, reach, matcher),
        [*upward, last],
        [first, *downward],
        samples,
    )


def _searched(search: Search, starts: Sequence[InitialState], start: str) -> Search:
    """Find attractors from initial states."""
    search.labels(search.starts(starts, start))
    return search


def _knows_more(search: Search, before: Search) -> bool:
    return len(search.attractors) > len(before.attractors)


def _hand_on(searches: Sequence[Search], each: ParallelMap, matcher: Matcher, new: Sequence[bool]) -> list[Search]:
    """Follow attractors, down and up, to the neighbouring a at which they are not known, or not as they are.

    new : which of the searches may know what its neighbours have not been asked for
    """
    searches, new = list(searches), list(new)
    for way in ("down", "up"):
        before, new = searches[::-1], new[::-1]
        givers = [k for k in range(len(before) - 1) if new[k]]
        handed = each(
            f"handed {way}",
            partial(_handed_on, matcher=matcher),
            [before[k] for k in givers],
            [before[k + 1] for k in givers],
        )
        given = dict(zip(givers, handed, strict=True))
        searches = [before[0]]
        for k, (giver, taker) in enumerate(pairwise(before)):
            # What has just come to the giver goes on as well.
            more = _knows_more(searches[-1], giver)
            searches.append((_handed_on(searches[-1], taker, matcher) if more else given.get(k)) or taker)
        new = [known or _knows_more(*pair) for known, *pair in zip(new, searches, before, strict=True)]
    return searches


def _handed_on(giver: Search, taker: Search, matcher: Matcher) -> Search | None:
    """Return a search that has followed what a neighbour knows; None if that is nothing new."""
    known, shown = (outlines(search.attractors) for search in (giver, taker))
    lacking, _ = matcher.differing(known, shown)
    if not lacking:
        return None
    # Whatever states have led to nothing: what attracts next to it is worth looking for.
    taker = replace(taker, attractors=list(taker.attractors), vain=())
    taker.labels(taker.seeds(item.attractor for item in lacking.values()), check=False)
    return taker


def _carried(giver: Search, taker: Search) -> np.ndarray:
    """Return the index of the attractor at a neighbouring a that each attractor leads to."""
    return taker.known_labels(taker.seeds(giver.attractors))


def _lifetimes(search: Search) -> list[Lifetime | None]:
    return lifetimes(search.model, search.attractors, search.settings)
