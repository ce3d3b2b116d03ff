"""The attractors of one law along a: searched for at each a, from initial states and from the neighbouring values.

Between neighbouring values of a at which the attractors differ, values are inserted until each change is located. The
work at each a, and between two values, is shared among processes. Only a chain of values that each get a new attractor
from the one before is processed in sequence.

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
from burridge_knopoff.continuation.cached import CLASSES
from burridge_knopoff.continuation.matching import Matcher, outlines
from burridge_knopoff.continuation.refinement import refine_searches
from burridge_knopoff.continuation.settings import REFINEMENT, RefinementSettings
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.kind import CHAOS
from burridge_knopoff.motion.settings import MOTION, MotionSettings
from burridge_knopoff.running.processes import ParallelMap, parallel_map

# Fractions of the time in a study of the paper's size at which the longest steps begin and end.
SEARCHED, INSERTED, LIFETIMES = (0.0, 0.34), (0.49, 0.87), (0.87, 1.0)


@dataclass(frozen=True, eq=False)
class Continuation:
    """The attractors of one law along a.

    models : at each a, ascending: the given ones and those inserted between them
    grid : indices in `models` of the given ones
    attractors : for each given model those that coexist there; for each inserted one those that change near it
    lifetimes : for each model and attractor its lifetime if it is chaotic, None otherwise; also None at inserted values
        where the same branch is chaotic at both neighbouring values and chaos lasts there
    branch, side : for each model and attractor the number of its branch and its side; see `branches.branches`
    upward, downward : for each given model and attractor the index of the attractor reached at the next or the previous
        given model, −1 if it is undetermined or there is none
    samples : for each given model the index of the attractor that each state drawn for the basin fractions reaches
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
        """Return the attractors of one model as rows of the table, ordered by branch and side."""
        columns = self.attractors[place], self.lifetimes[place], self.branch[place].tolist(), self.side[place].tolist()
        rows = [Row(index, *values) for index, values in enumerate(zip(*columns, strict=True))]
        return sorted(rows, key=lambda row: (row.branch, -row.side))


def continue_attractors(
    models: Sequence[Model],
    settings: SearchSettings = SEARCH,
    motion: MotionSettings = MOTION,
    refine: RefinementSettings = REFINEMENT,
    *,
    starts: Sequence[InitialState] = (),
    start: str = "moving",
    processes: int = 1,
    folder: str | Path | None = None,
) -> Continuation:
    """Find the attractors of all models, of ascending a, from initial states and from each other, and match them.

    settings, motion, starts, start : see `find_attractors`
    refine : how closely changes are located in a
    processes, folder : number of processes, and the cache of their results; see `parallel_map`. The results do not
        depend on them

    Raises ValueError if an initial state does not fit the models.
    """
    matcher = Matcher(models[0].scale, refine.longest_period)
    with parallel_map(processes, folder, CLASSES) as pool:
        searches = [Search(model, settings, motion) for model in models]
        from_states = partial(_search, starts=starts, start=start)
        searches = pool("searched from initial states", from_states, searches, span=SEARCHED)
        searches = _seed_neighbours(searches, pool, matcher, [True] * len(searches))
        samples = [np.zeros(0, dtype=np.intc) for _ in searches]
        gained = [True] * len(searches)
        while any(gained):
            counts = [len(search.attractors) for search in searches]
            places = [k for k, gain in enumerate(gained) if gain]
            outcome = fraction_labels([searches[k] for k in places], start, pool)
            for k, search, labels in zip(places, *outcome, strict=True):
                searches[k], samples[k] = search, labels
            # Attractors to which only these states have led also seed the neighbours.
            seeded = _seed_neighbours(
                searches,
                pool,
                matcher,
                [len(search.attractors) > count for search, count in zip(searches, counts, strict=True)],
            )
            gained = [_has_more_attractors(search, before) for search, before in zip(seeded, searches, strict=True)]
            searches = [
                search if gain else before for search, gain, before in zip(seeded, gained, searches, strict=True)
            ]
        # The sets of attractors are complete now; from here on they are only read.
        upward = pool("swept upward", _attractors_at_neighbour, searches[:-1], searches[1:])
        downward = pool("swept downward", _attractors_at_neighbour, searches[1:], searches[:-1])
        whole = [searches[0]]
        inserted = refine_searches(searches, refine, matcher, pool, INSERTED)
        for inner, grown in zip(inserted, searches[1:], strict=True):
            whole += [*inner, grown]
        attractors = [search.attractors for search in whole]
        grid = [whole.index(search) for search in searches]
        values = [search.model.a for search in whole]
        width = max((other.a - one.a for one, other in pairwise(models)), default=0.0)
        branch, side = branches(values, attractors, grid, REMEMBERED * width, matcher)
        lives = _lifetimes_along_a(whole, branch, grid, pool)
    # Nothing follows at the ends of the grid.
    first, last = (np.full(len(search.attractors), UNDETERMINED) for search in (searches[0], searches[-1]))
    return Continuation(
        [search.model for search in whole],
        grid,
        attractors,
        lives,
        branch,
        side,
        [*upward, last],
        [first, *downward],
        samples,
    )


def _search(search: Search, starts: Sequence[InitialState], start: str) -> Search:
    """Find attractors from initial states."""
    search.labels(search.starts(starts, start))
    return search


def _has_more_attractors(search: Search, before: Search) -> bool:
    return len(search.attractors) > len(before.attractors)


def _seed_neighbours(
    searches: Sequence[Search], pool: ParallelMap, matcher: Matcher, new: Sequence[bool]
) -> list[Search]:
    """Start each attractor, downward and upward, at the neighbouring a where it has no unchanged counterpart.

    new : whether each search may have attractors with which its neighbours have not been seeded
    """
    searches, new = list(searches), list(new)
    for way in ("down", "up"):
        before, new = searches[::-1], new[::-1]
        sources = [k for k in range(len(before) - 1) if new[k]]
        handed = pool(
            f"seeded {way}ward",
            partial(_seeded_search, matcher=matcher),
            [before[k] for k in sources],
            [before[k + 1] for k in sources],
        )
        seeded = dict(zip(sources, handed, strict=True))
        searches = [before[0]]
        for k, (source, target) in enumerate(pairwise(before)):
            # An attractor that has just been found at the source is continued as well.
            gain = _has_more_attractors(searches[-1], source)
            searches.append((_seeded_search(searches[-1], target, matcher) if gain else seeded.get(k)) or target)
        new = [flag or _has_more_attractors(*pair) for flag, *pair in zip(new, searches, before, strict=True)]
    return searches


def _seeded_search(source: Search, target: Search, matcher: Matcher) -> Search | None:
    """Return the target after a search from the attractors of the source that it lacks; None if it lacks none."""
    source_outlines, target_outlines = (outlines(search.attractors) for search in (source, target))
    lacking, _ = matcher.unmatched(source_outlines, target_outlines)
    if not lacking:
        return None
    # Earlier unsuccessful states do not count against the seeds.
    target = replace(target, attractors=list(target.attractors), unsuccessful_states=())
    target.labels(target.seeds(item.attractor for item in lacking.values()), check=False)
    return target


def _attractors_at_neighbour(source: Search, target: Search) -> np.ndarray:
    """Return the index of the attractor at a neighbouring a that is reached from each attractor."""
    return target.known_labels(target.seeds(source.attractors))


def _lifetimes_along_a(
    searches: Sequence[Search], branch: Sequence[np.ndarray], grid: Sequence[int], pool: ParallelMap
) -> list[list[Lifetime | None]]:
    """Return the lifetimes at all values of a; see `Continuation`.

    Chaos loses its permanence at a crisis, where its branch ends or changes. Between two values at which the branch is
    chaotic its lifetime is measured only if chaos is transient at one of them.
    """
    chaotic = [
        {number for number, item in zip(numbers.tolist(), search.attractors, strict=True) if item.motion.kind in CHAOS}
        for numbers, search in zip(branch, searches, strict=True)
    ]
    inserted = set(range(len(searches))) - set(grid)
    inner = {k for k in inserted if chaotic[k] <= chaotic[k - 1] & chaotic[k + 1]}
    measured: dict[int, list[Lifetime | None]] = {}
    places = sorted(set(range(len(searches))) - inner)
    while places:
        lives = pool("lifetimes", _lifetimes, [searches[k] for k in places], span=LIFETIMES)
        measured |= zip(places, lives, strict=True)
        least = searches[0].settings.lifetime
        short = {k for k, lives in measured.items() if any(life and not life.is_longer_than(least) for life in lives)}
        places = sorted(k for k in inner - measured.keys() if not short.isdisjoint((k - 1, k + 1)))
    return [measured.get(k, [None] * len(search.attractors)) for k, search in enumerate(searches)]


def _lifetimes(search: Search) -> list[Lifetime | None]:
    return lifetimes(search.model, search.attractors, search.settings)
