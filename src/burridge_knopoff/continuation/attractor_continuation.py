"""The attractors of one law along a parameter: searched for at each value, from initial states and the neighbours.

The parameter is mostly a. Between neighbouring values at which the attractors differ, values are inserted until each
change is located. The work at each value, and between two values, is shared among processes. Only a chain of values
that each get a new attractor from the one before is processed in sequence.

Reference: G. Datseris, K. Luiz Rossi and A. Wagemakers, "Framework for global stability analysis of dynamical systems",
Chaos 33 (2023) 073151: the search at each parameter begins from the attractors at the one before.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from pathlib import Path

import numpy as np

from burridge_knopoff.attractors.attractor import Attractor, Lifetime
from burridge_knopoff.attractors.labels import UNDETERMINED
from burridge_knopoff.attractors.lifetime import lifetimes
from burridge_knopoff.attractors.search import Search
from burridge_knopoff.attractors.settings import SEARCH, SearchSettings
from burridge_knopoff.attractors.table import Row
from burridge_knopoff.basins.fractions import fraction_labels
from burridge_knopoff.continuation.branches import REMEMBERED, branches
from burridge_knopoff.continuation.cached import CLASSES
from burridge_knopoff.continuation.matching import DistanceMatcher, Matcher, outlines
from burridge_knopoff.continuation.refinement import refine_searches
from burridge_knopoff.continuation.settings import REFINEMENT, RefinementSettings
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import ChainState, Model, recorded_value
from burridge_knopoff.motion.kind import CHAOS
from burridge_knopoff.motion.settings import MOTION, MotionSettings
from burridge_knopoff.running.processes import ParallelMap, parallel_map

# Fractions of the time in a study of the paper's size at which the longest steps begin and end.
SEARCHED, INSERTED, LIFETIMES = (0.0, 0.34), (0.49, 0.87), (0.87, 1.0)


@dataclass(frozen=True, eq=False)
class Continuation:
    """The attractors of one law along a parameter.

    models : at each of its values, ascending: the given ones and those inserted between them
    grid : indices in `models` of the given ones
    attractors : for each given model those that coexist there; for each inserted one those that change near it
    lifetimes : for each model and attractor its lifetime if it is chaotic, None otherwise; also None at inserted values
        where the same branch is chaotic at both neighbouring values and chaos lasts there
    branch, side : for each model and attractor the number of its branch and its side; see `branches.branches`
    upward, downward : for each given model and attractor the index of the attractor reached at the next or the previous
        given model, −1 if it is undetermined or there is none
    samples : for each given model the index of the attractor that each state drawn for the basin fractions reaches
    parameter : name of the parameter
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
    parameter: str = "a"

    @property
    def values(self) -> list[float]:
        """The value of the parameter in each model."""
        return [model.parameter(self.parameter) for model in self.models]

    @property
    def most_attractors(self) -> int:
        """Largest number of attractors at a value of the grid, and at least 1."""
        return max(1, *(len(self.attractors[place]) for place in self.grid))

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
    parameter: str = "a",
    starts: Sequence[InitialState | ChainState] = (),
    start: str = "moving",
    matcher: Matcher | None = None,
    processes: int = 1,
    folder: str | Path | None = None,
    report: Callable[[float], None] | None = None,
) -> Continuation:
    """Find the attractors of all models, of ascending a, from initial states and from each other, and match them.

    The models may differ in another parameter than a, which takes its place.

    1. Search each a from initial states.
    2. Seed: start each attractor at the neighbouring a where it has no unchanged match, downward, then upward.
    3. Draw states for the basin fractions and label them. An attractor that only these states reach seeds the
       neighbours as well. Repeat where a value of a gains an attractor.
    4. Sweep: label a state on each attractor at the next and at the previous a.
    5. Insert values of a between neighbours whose attractors differ; follow there only what changes.
    6. Number the branches: match the attractors of all values of a, in ascending order.
    7. Measure the lifetimes of chaos.

    settings, motion, starts, start : see `find_attractors`
    parameter : the parameter in which the models differ
    refine : how closely changes are located in it
    matcher : decides which attractors at two values of a are the same; by default a `DistanceMatcher`
    processes, folder : number of processes, and the cache of their results; see `parallel_map`. The results do not
        depend on them
    report : see `parallel_map`

    Raises ValueError if an initial state does not fit the models.
    """
    matcher = matcher or DistanceMatcher(refine.longest_period)
    with parallel_map(processes, folder, CLASSES, report) as pool:
        searches = [Search(model, settings, motion) for model in models]
        searches = pool(
            "searched from initial states", partial(_search, starts=starts, start=start), searches, span=SEARCHED
        )
        searches = _seed_neighbours(searches, pool, matcher, [True] * len(searches))
        searches, samples = _label_samples(searches, start, pool, matcher)
        # The sets of attractors are complete now; from here on they are only read.
        upward, downward = _sweep(searches, pool)
        inserted = refine_searches(searches, refine, matcher, pool, INSERTED, parameter)
        all_searches = [searches[0]]
        for inner, right in zip(inserted, searches[1:], strict=True):
            all_searches += [*inner, right]
        grid = [all_searches.index(search) for search in searches]
        attractors = [search.attractors for search in all_searches]
        values = [recorded_value(search.model, parameter) for search in all_searches]
        widest = max((values[high] - values[low] for low, high in pairwise(grid)), default=0.0)
        branch, side = branches(values, attractors, grid, REMEMBERED * widest, matcher)
        lives = _lifetimes_along_a(all_searches, branch, grid, pool)
    all_models = [search.model for search in all_searches]
    return Continuation(all_models, grid, attractors, lives, branch, side, upward, downward, samples, parameter)


def _search(search: Search, starts: Sequence[InitialState | ChainState], start: str) -> Search:
    """Find attractors from initial states."""
    search.find(search.starts(starts, start))
    return search


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
            has_more = _has_more_attractors(searches[-1], source)
            searches.append((_seeded_search(searches[-1], target, matcher) if has_more else seeded.get(k)) or target)
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
    target.find(target.seeds(item.attractor for item in lacking.values()), check=False)
    return target


def _has_more_attractors(search: Search, before: Search) -> bool:
    return len(search.attractors) > len(before.attractors)


def _label_samples(
    searches: Sequence[Search], start: str, pool: ParallelMap, matcher: Matcher
) -> tuple[list[Search], list[np.ndarray]]:
    """Label the states drawn for the basin fractions until no a gains an attractor.

    Returns the searches, and for each the index of the attractor that each state reaches.
    """
    searches, samples = list(searches), [np.zeros(0, dtype=np.intc) for _ in searches]
    places = list(range(len(searches)))
    while places:
        counts = [len(search.attractors) for search in searches]
        outcome = fraction_labels([searches[k] for k in places], start, pool)
        for k, search, labels in zip(places, *outcome, strict=True):
            searches[k], samples[k] = search, labels
        new = [len(search.attractors) > count for search, count in zip(searches, counts, strict=True)]
        seeded = _seed_neighbours(searches, pool, matcher, new)
        places = [k for k, search in enumerate(seeded) if _has_more_attractors(search, searches[k])]
        for k in places:
            searches[k] = seeded[k]
    return searches, samples


def _sweep(searches: Sequence[Search], pool: ParallelMap) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Return the index of the attractor that each attractor reaches at the next, and at the previous, a of the grid.

    Undetermined beyond the ends of the grid.
    """
    upward = pool("swept upward", _attractors_at_neighbour, searches[:-1], searches[1:])
    downward = pool("swept downward", _attractors_at_neighbour, searches[1:], searches[:-1])
    first, last = (np.full(len(search.attractors), UNDETERMINED) for search in (searches[0], searches[-1]))
    return [*upward, last], [first, *downward]


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
