"""Which attractors the states reach that are drawn for the basin fractions: at each a others, and many."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from burridge_knopoff.model.model import Instant
from burridge_knopoff.stability.attractors import Search
from burridge_knopoff.stability.labels import UNDETERMINED, label_together
from burridge_knopoff.stability.radius import midst
from burridge_knopoff.stability.sampling import sample_states
from burridge_knopoff.stability.settings import seed_at

#: States that one process labels at a time; no label depends on it.
PART = 250


def fraction_labels(
    searches: Sequence[Search], start: str, each: Callable[..., list[Any]]
) -> tuple[list[Search], list[np.ndarray]]:
    """Return, for each model, the index of the attractor that each drawn state reaches, and the searches as they are.

    start : see `Model.begin`; each : as `running.processes.shared_out` gives it

    The states are not those from which attractors are looked for; but where one reaches none that is known, it is
    looked for from there as well, and all are labelled once more.
    """
    spared = each("patience spared", partial(_spared, start=start), searches)
    searches = [one or search for one, search in zip(spared, searches, strict=True)]
    labels = [np.zeros(0, dtype=np.intc) for _ in searches]
    waiting = list(range(len(searches)))
    while waiting:
        parts = [(k, first) for k in waiting for first in range(0, searches[k].settings.fraction_samples, PART)]
        those, firsts = [searches[k] for k, _ in parts], [first for _, first in parts]
        found = each("labelled for basin fractions", partial(_labels, start=start), those, firsts)
        for k in waiting:
            labels[k] = labels[k][:0]
        for (k, _), part in zip(parts, found, strict=True):
            labels[k] = np.concatenate([labels[k], part])
        lost = [k for k in waiting if (labels[k] == UNDETERMINED).any()]
        those = [searches[k] for k in lost]
        looked = each("looked for from the others", partial(_more, start=start), those, [labels[k] for k in lost])
        for k, (search, _) in zip(lost, looked, strict=True):
            searches[k] = search
        waiting = [k for k, (_, more) in zip(lost, looked, strict=True) if more]
    return searches, labels


def _drawn(search: Search, start: str, part: slice = slice(None)) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return some of the drawn states: x_i, U_i' and which blocks stick, each of shape (states, blocks)."""
    settings, model = search.settings, search.model
    seed = seed_at(settings.seed, model.a)
    box = settings.position, settings.velocity
    position, velocity = sample_states(model.blocks, settings.fraction_samples, *box, seed)
    position, velocity = position[part], velocity[part]
    stuck = model.starts_stuck(position, start)
    return position - model.sliding_offset, np.where(stuck, 0.0, velocity), stuck


def _spared(search: Search, start: str) -> Search | None:
    """Lessen the patience with attractors whose inner orbits a sample of states reaches much earlier.

    None where no attractor has inner orbits.

    Where chaos is a transient before the orbits, the last of the sample come late and nothing is spared.
    """
    attractors, tuning = search.attractors, search.tuning
    inner = [midst(attractors, index, search.tolerance, tuning) for index in range(len(attractors))]
    sample = _drawn(search, start, slice(search.settings.samples))
    if not any(inner) or not len(sample[0]):
        return None
    labels, times = label_together(search.model, attractors, *sample, search.settings.time_limit)
    for index, orbits in enumerate(inner):
        came = times[np.isin(labels, orbits)]
        if len(came):
            patience = min(tuning.patience_margin * came.max(), attractors[index].patience)
            attractors[index] = replace(attractors[index], patience=patience)
    return search


def _labels(search: Search, first: int, start: str) -> np.ndarray:
    """Label a part of the drawn states, from that number on."""
    part = _drawn(search, start, slice(first, first + PART))
    if not search.attractors:
        return np.full(len(part[0]), UNDETERMINED, dtype=np.intc)
    labels, _ = label_together(search.model, search.attractors, *part, search.settings.label_limit)
    return labels


def _more(search: Search, labels: np.ndarray, start: str) -> tuple[Search, bool]:
    """Look for attractors from states that reach none; return the search, and whether it knows more than before."""
    drawn = _drawn(search, start)
    lost = np.flatnonzero(labels == UNDETERMINED)
    return search, search.discover([Instant(*(values[k] for values in drawn)) for k in lost.tolist()])
