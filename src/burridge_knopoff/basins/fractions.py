"""Labels of the states drawn for the basin fractions: an independent sample at each a, as large as needed.

States are drawn until the interval of each fraction is as narrow as required. The labels, in the order of the states,
decide how many that takes; small fractions take few.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from burridge_knopoff.attractors.capture_radius import embedded_orbits
from burridge_knopoff.attractors.labels import UNDETERMINED, label_arrays
from burridge_knopoff.attractors.search import Search
from burridge_knopoff.laws.law import recorded_a
from burridge_knopoff.model.model import ChainState
from burridge_knopoff.model.sampling import half_width, required_samples, sample_states, seed_at
from burridge_knopoff.running.processes import ParallelMap

#: Largest number of states that one process labels at a time; the labels do not depend on it.
LABELLED_AT_ONCE = 250

# Patience of an attractor in which periodic orbits are embedded, in units of the longest time that a state of a sample
# takes to reach one of them.
PATIENCE_MARGIN = 3.0

#: The widths of the intervals are tested each time that this many states have been added.
STEP = 50

#: A search, the number of the first drawn state to label next, and how many are labelled.
NextStates = tuple[Search, int, int]


def fraction_labels(searches: Sequence[Search], start: str, pool: ParallelMap) -> tuple[list[Search], list[np.ndarray]]:
    """Return the searches, and for each the index of the attractor that each drawn state reaches.

    start : see `Model.begin`; pool : from `running.processes.parallel_map`

    The states are independent of those from which the search started. If one reaches no known attractor, the search
    continues from it. All states are labelled again if that finds a new attractor.
    """
    spared = pool("patience reduced", partial(_reduce_patience, start=start), searches)
    searches = [reduced or search for reduced, search in zip(spared, searches, strict=True)]
    labels = [np.zeros(0, dtype=np.intc) for _ in searches]
    waiting = list(range(len(searches)))
    while waiting:
        for k in waiting:
            labels[k] = labels[k][:0]

        def further(k: int, _: NextStates, part: np.ndarray) -> list[tuple[int, NextStates]]:
            labels[k] = np.concatenate([labels[k], part])
            enough = required_states(labels[k], searches[k].settings.fraction_width)
            labels[k] = labels[k][:enough]
            return [] if enough is not None else [(k, _next_states(searches[k], labels[k]))]

        wide = [k for k in waiting if required_samples(searches[k].settings.fraction_width)]
        states = [(k, _next_states(searches[k], labels[k])) for k in wide]
        pool.work_through("labelled for basin fractions", partial(_label_next, start=start), states, further)
        lost = [k for k in waiting if (labels[k] == UNDETERMINED).any()]
        batch = [searches[k] for k in lost]
        looked = pool(
            "searched from undetermined states",
            partial(_search_from_undetermined, start=start),
            batch,
            [labels[k] for k in lost],
        )
        for k, (search, _) in zip(lost, looked, strict=True):
            searches[k] = search
        waiting = [k for k, (_, gain) in zip(lost, looked, strict=True) if gain]
    return searches, labels


def required_states(labels: np.ndarray, width: float) -> int | None:
    """Return the number of states after which every interval has half-width `width` or less; None if more are needed.

    labels : of the states in their order, shape (n,); −1 (undetermined) is a fraction as well
    """
    most = required_samples(width)
    for count in (*range(STEP, most, STEP), most):
        if count > len(labels):
            return None
        hits = np.unique(labels[:count], return_counts=True)[1].tolist()
        # An attractor that no state has reached has an interval too: 0 hits, as wide as that of `count` hits.
        if max(half_width(hit, count) for hit in (0, *hits)) <= width:
            return count
    return most


def further_states(labels: np.ndarray, width: float) -> int:
    """Return how many more states to label at a time: as many as the fractions of the labels so far require.

    labels, width : see `required_states`
    """
    most = required_samples(width)
    shares = np.unique(labels, return_counts=True)[1] / max(1, len(labels))
    needed = 4.0 * float((shares * (1.0 - shares)).max()) * most if len(labels) else most
    count = STEP * math.ceil((needed - len(labels)) / STEP)
    return min(max(count, STEP), LABELLED_AT_ONCE, most - len(labels))


def _draw_states(search: Search, start: str, first: int, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return `count` drawn states from number `first` on: x_i, U_i' and stuck blocks, each of shape (count, blocks)."""
    settings, model = search.settings, search.model
    seed = seed_at(settings.seed, recorded_a(model.law))
    drawn = sample_states(model.blocks, first + count, *settings.box(model), seed)
    position, velocity = (part[first:] for part in drawn)
    stuck = model.stuck_blocks(position, velocity, start)
    return position - model.sliding_offset, np.where(stuck, 0.0, velocity), stuck


def _reduce_patience(search: Search, start: str) -> Search | None:
    """Reduce the patience of attractors whose embedded orbits a sample of states reaches much earlier.

    None if no periodic orbit is embedded in an attractor. If chaos is a transient that leads to the orbits, the last
    states of the sample arrive late and the patience is not reduced.
    """
    attractors = search.attractors
    inner = [embedded_orbits(attractors, index, search.tolerance) for index in range(len(attractors))]
    sample = _draw_states(
        search, start, 0, min(search.settings.samples, required_samples(search.settings.fraction_width))
    )
    if not any(inner) or not len(sample[0]):
        return None
    labels, times, _ = label_arrays(search.model, attractors, *sample, search.settings.time_limit)
    for index, orbits in enumerate(inner):
        came = times[np.isin(labels, orbits)]
        if len(came):
            patience = min(PATIENCE_MARGIN * came.max(), attractors[index].patience)
            attractors[index] = replace(attractors[index], patience=patience)
    return search


def _next_states(search: Search, labels: np.ndarray) -> NextStates:
    """Return the states to label next, after those that have labels."""
    return search, len(labels), further_states(labels, search.settings.fraction_width)


def _label_next(states: NextStates, start: str) -> np.ndarray:
    """Return the labels of the next drawn states."""
    search, first, count = states
    part = _draw_states(search, start, first, count)
    if not search.attractors:
        return np.full(len(part[0]), UNDETERMINED, dtype=np.intc)
    labels, _, _ = label_arrays(search.model, search.attractors, *part, search.settings.label_limit)
    return labels


def _search_from_undetermined(search: Search, labels: np.ndarray, start: str) -> tuple[Search, bool]:
    """Search from the states that reach no attractor; return the search, and whether it found a new attractor."""
    drawn = _draw_states(search, start, 0, len(labels))
    lost, count = np.flatnonzero(labels == UNDETERMINED), len(search.attractors)
    search.discover([ChainState(*(values[k] for values in drawn)) for k in lost.tolist()])
    return search, len(search.attractors) > count
