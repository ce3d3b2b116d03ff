"""Which attractors the states reach that are drawn for the basin fractions: at each a others, and as many as needed.

States are drawn until the interval of each fraction is as narrow as asked; how many that takes is decided by the labels
in the order of the states. Where a fraction is small few are enough.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from burridge_knopoff.attractors.capture_radius import midst
from burridge_knopoff.attractors.labels import UNDETERMINED, label_together
from burridge_knopoff.attractors.search import Search
from burridge_knopoff.model.model import ChainState
from burridge_knopoff.model.sampling import half_width, required_samples, sample_states, seed_at
from burridge_knopoff.running.processes import ParallelMap

#: States that one process labels at a time; no label depends on it.
PART = 250

# The patience with an attractor in whose midst orbits lie: this many times that of the last of a sample that reaches
# one.
PATIENCE_MARGIN = 3.0

#: Numbers of states after which it is asked whether the intervals are narrow enough.
STEP = 50


def fraction_labels(searches: Sequence[Search], start: str, each: ParallelMap) -> tuple[list[Search], list[np.ndarray]]:
    """Return, for each model, the index of the attractor that each drawn state reaches, and the searches as they are.

    start : see `Model.begin`; each : as `running.processes.parallel_map` gives it

    The states are not those from which attractors are looked for; but where one reaches none that is known, it is
    looked for from there as well, and all are labelled once more.
    """
    spared = each("patience spared", partial(_spared, start=start), searches)
    searches = [one or search for one, search in zip(spared, searches, strict=True)]
    labels = [np.zeros(0, dtype=np.intc) for _ in searches]
    waiting = list(range(len(searches)))
    while waiting:
        for k in waiting:
            labels[k] = labels[k][:0]
        wide = [k for k in waiting if required_samples(searches[k].settings.fraction_width)]
        while wide:
            those, firsts = [searches[k] for k in wide], [len(labels[k]) for k in wide]
            found = each("labelled for basin fractions", partial(_labels, start=start), those, firsts)
            for k, part in zip(wide, found, strict=True):
                labels[k] = np.concatenate([labels[k], part])
            enough = {k: enough_states(labels[k], searches[k].settings.fraction_width) for k in wide}
            labels = [one[: enough.get(k, len(one))] for k, one in enumerate(labels)]
            wide = [k for k in wide if enough[k] is None]
        lost = [k for k in waiting if (labels[k] == UNDETERMINED).any()]
        those = [searches[k] for k in lost]
        looked = each("looked for from the others", partial(_more, start=start), those, [labels[k] for k in lost])
        for k, (search, _) in zip(lost, looked, strict=True):
            searches[k] = search
        waiting = [k for k, (_, more) in zip(lost, looked, strict=True) if more]
    return searches, labels


def enough_states(labels: np.ndarray, width: float) -> int | None:
    """Return after how many states the interval of each fraction is as narrow as asked; None if more are needed.

    labels : of the states in their order, shape (n,), −1 where it is undetermined, which is a fraction as well
    """
    most = required_samples(width)
    for count in (*range(STEP, most, STEP), most):
        if count > len(labels):
            return None
        hits = np.unique(labels[:count], return_counts=True)[1].tolist()
        # That of what has not been met is as wide as that of what is always met.
        if max(half_width(hit, count) for hit in (0, *hits)) <= width:
            return count
    return most


def _drawn(search: Search, start: str, first: int, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return some of the drawn states: x_i, U_i' and which blocks stick, each of shape (states, blocks)."""
    settings, model = search.settings, search.model
    seed = seed_at(settings.seed, model.a)
    box = settings.position, settings.velocity
    position, velocity = (part[first:] for part in sample_states(model.blocks, first + count, *box, seed))
    stuck = model.stuck_blocks(position, velocity, start)
    return position - model.sliding_offset, np.where(stuck, 0.0, velocity), stuck


def _spared(search: Search, start: str) -> Search | None:
    """Lessen the patience with attractors whose inner orbits a sample of states reaches much earlier.

    None where no attractor has inner orbits.

    Where chaos is a transient before the orbits, the last of the sample come late and nothing is spared.
    """
    attractors = search.attractors
    inner = [midst(attractors, index, search.tolerance) for index in range(len(attractors))]
    sample = _drawn(search, start, 0, min(search.settings.samples, required_samples(search.settings.fraction_width)))
    if not any(inner) or not len(sample[0]):
        return None
    labels, times, _ = label_together(search.model, attractors, *sample, search.settings.time_limit)
    for index, orbits in enumerate(inner):
        came = times[np.isin(labels, orbits)]
        if len(came):
            patience = min(PATIENCE_MARGIN * came.max(), attractors[index].patience)
            attractors[index] = replace(attractors[index], patience=patience)
    return search


def _labels(search: Search, first: int, start: str) -> np.ndarray:
    """Label a part of the drawn states, from that number on."""
    part = _drawn(search, start, first, min(PART, required_samples(search.settings.fraction_width) - first))
    if not search.attractors:
        return np.full(len(part[0]), UNDETERMINED, dtype=np.intc)
    labels, _, _ = label_together(search.model, search.attractors, *part, search.settings.label_limit)
    return labels


def _more(search: Search, labels: np.ndarray, start: str) -> tuple[Search, bool]:
    """Look for attractors from states that reach none; return the search, and whether it knows more than before."""
    drawn = _drawn(search, start, 0, len(labels))
    lost = np.flatnonzero(labels == UNDETERMINED)
    return search, search.discover([ChainState(*(values[k] for values in drawn)) for k in lost.tolist()])
