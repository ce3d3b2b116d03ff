"""The coexisting attractors under each law at each a of the grid, their basin fractions, and sweeps of a.

The file also has the branches of the attractors and the branch that each initial state reaches. `refined` has the
attractors at the inserted values of a as well.

Each slot `attractor` has one attractor, in the order of branches. `basin_fraction` refers to `sample_count` states,
drawn independently at each a. `rounded_branch` has 64 states, which round to the initial state at the paper's digits.
Sweeps start on each attractor of the smallest a (upward) or of the largest a (downward). `section_count` and the other
observables that are given for some attractors only are those of a run of 1000 time units.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, replace
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.attractors.attractor import Attractor
from burridge_knopoff.attractors.labels import UNDETERMINED, label
from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.attractors.table import NOTHING
from burridge_knopoff.continuation.attractor_continuation import Continuation
from burridge_knopoff.dataset.columns import empty_columns
from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import Variable
from burridge_knopoff.laws.law import recorded_a
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import CONTACTS, STARTS, Model
from burridge_knopoff.motion.period import count_distinct
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.running.section import Section
from burridge_knopoff.summaries.attractor_observables import follow_attractor
from burridge_knopoff.summaries.branches_along import branch_values, branch_variables

_SLOT = ("a", "attractor")
_REACHED = ("contact", "start", "initial", "a")
_SWEEP = ("direction", "sweep", "a")
DIRECTIONS = ("upward", "downward")
#: Rounding error of the paper's initial states: half a unit of the last digit of their positions.
ROUNDING = 5e-4
CORNERS = 64
_V = Variable
ALONG_COMMENT = {"comment": "known for attractors that an initial state of the study reaches under some convention"}
VARIABLES = {
    **branch_variables("a"),
    "initial_branch": _V(_REACHED, "i2", "branch reached: by an initial state under each convention", NOTHING),
    "initial_side": _V(_REACHED, "i1", "side of that branch", nothing=0),
    "section_count": _V(
        _SLOT,
        "i4",
        "number of section points: distinct W' at upward crossings of the section W = 0 along an attractor",
        ALONG_COMMENT,
    ),
    "section_velocity_mean": _V(
        _SLOT, "f8", "mean of W' at the section: over these crossings, NaN if there are none", ALONG_COMMENT
    ),
    "velocity_correlation": _V(
        _SLOT, "f8", "velocity correlation: Pearson correlation of the velocities U' of the end blocks", ALONG_COMMENT
    ),
    "velocity_frequency": _V(
        (*_SLOT, "block"),
        "f8",
        "frequency of U': in cycles per unit time, of the highest peak of the spectrum of U', or of short slips by "
        "their starts",
        ALONG_COMMENT,
    ),
    "rounded_branch": _V(
        ("initial", "a", "corner"),
        "i2",
        "branch reached by rounded states: under the study's convention, by states whose positions and "
        "velocities are each 0.0005 above or below those of an initial state; for a state that follows "
        "v, 0.0005 v/0.1",
        NOTHING,
    ),
    "sweep_branch": _V(_SWEEP, "i2", "branch in a sweep: that a sweep of a follows", NOTHING),
    "sweep_mean_distance": _V(_SWEEP, "f8", "<J> in a sweep: of the attractor that a sweep of a follows"),
}

COORDINATES = {
    "contact": Variable(("contact",), "O", "convention of contact", coordinate=True),
    "start": Variable(("start",), "O", "convention of start", coordinate=True),
    "direction": Variable(("direction",), "O", "direction in which a is swept", coordinate=True),
}


def one_law(
    continuation: Continuation,
    initial: Sequence[InitialState],
    settings: SearchSettings,
    motion: MotionSettings,
    start: str,
) -> xarray.Dataset:
    """Return the attractors of one law at the values of the grid.

    continuation : the result of the search with the settings `settings` and `motion`
    initial : states whose attractor is determined under each convention
    start : convention for the sampled states
    """
    models = [continuation.models[k] for k in continuation.grid]
    values = branch_values(continuation, settings.lifetime)
    values.update(_initial_branches(continuation, initial, settings.label_limit))
    values.update(_observables(continuation, values["initial_branch"], values["initial_side"], motion.section))
    values.update(_rounded_branches(continuation, initial, settings.label_limit, start))
    values.update(_sweeps(continuation))
    coordinates = axes(
        COORDINATES,
        initial=[state.name for state in initial],
        a=[recorded_a(model.law) for model in models],
        block=range(1, models[0].blocks + 1),
        contact=CONTACTS,
        start=STARTS,
        direction=DIRECTIONS,
    )
    law = models[0].law.name
    attributes = search_attributes(models[0], settings, motion, start)
    return summary(f"Attractors, {law} friction law", VARIABLES, values, coordinates, attributes, module=__name__)


def search_attributes(model: Model, settings: SearchSettings, motion: MotionSettings, start: str) -> dict[str, Any]:
    """Return the settings of the search for the attractors of a law as attributes of a file."""
    return {
        "law": model.law.name,
        "history": "snakemake, from sampled initial states",
        "v": model.v,
        "contact": model.contact,
        "start": start,
        "synchronization_threshold": motion.synchronization_threshold,
        "section": str(motion.section),
        "longest_period": motion.scaled_to_velocity(model.v).longest_period,
        "position_box": np.array(settings.position),
        "velocity_box": _numbers_or_text(settings.velocity),
        **{key: value for key, value in asdict(settings).items() if key not in ("position", "velocity")},
        "label_limit": settings.label_limit,
    }


def _numbers_or_text(ends: Sequence[float | str]) -> np.ndarray | str:
    """Return the ends of an interval as an attribute: as a text if one of them is a formula."""
    return ", ".join(map(str, ends)) if any(isinstance(end, str) for end in ends) else np.array(ends)


def _initial_branches(
    continuation: Continuation, states: Sequence[InitialState], label_limit: float
) -> dict[str, np.ndarray]:
    """Return which branch each initial state reaches under each convention of contact and start."""
    shape = {"contact": len(CONTACTS), "start": len(STARTS), "initial": len(states), "a": len(continuation.grid)}
    values = empty_columns(VARIABLES, shape, "initial")
    for k, place in enumerate(continuation.grid):
        reached = _labels_of_states(continuation.models[place], continuation.attractors[place], states, label_limit)
        for where in np.argwhere(reached != UNDETERMINED):
            at, index = (*where, k), reached[tuple(where)]
            values["initial_branch"][at] = continuation.branch[place][index]
            values["initial_side"][at] = continuation.side[place][index]
    return values


def _observables(
    continuation: Continuation, branch: np.ndarray, side: np.ndarray, section: Section
) -> dict[str, np.ndarray]:
    """Return the observables along each attractor that an initial state reaches.

    branch, side : reached by the initial states, shape (…, a)
    """
    sizes = {
        "a": len(continuation.grid),
        "attractor": continuation.most_attractors,
        "block": continuation.models[0].blocks,
    }
    values = empty_columns(VARIABLES, sizes, "section_count", "section_velocity", "velocity_")
    for k, place in enumerate(continuation.grid):
        wanted = {*zip(branch[..., k].ravel().tolist(), side[..., k].ravel().tolist(), strict=True)}
        for slot, row in enumerate(continuation.rows(place)):
            if (row.branch, row.side) in wanted:
                observables = follow_attractor(continuation.models[place], row.attractor.motion.state(), section)
                values["section_count"][k, slot] = count_distinct(observables.section)
                values["section_velocity_mean"][k, slot] = (
                    observables.section.mean() if len(observables.section) else np.nan
                )
                values["velocity_correlation"][k, slot] = observables.velocity_correlation
                values["velocity_frequency"][k, slot] = observables.velocity_frequency
    return values


def _rounded_branches(
    continuation: Continuation, states: Sequence[InitialState], label_limit: float, start: str
) -> dict[str, np.ndarray]:
    """Return the branches reached by the `corners` of each initial state, with the models' contact and `start`."""
    shape = {"initial": len(states), "a": len(continuation.grid), "corner": CORNERS}
    values = empty_columns(VARIABLES, shape, "rounded")
    for k, place in enumerate(continuation.grid):
        model = continuation.models[place]
        for n, state in enumerate(states):
            if _is_allowed(state, model.contact, model.blocks):
                starts = [model.begin(corner, start) for corner in corners(state, model.contact, model.blocks)]
                reached, _ = label(model, continuation.attractors[place], starts, label_limit)
                determined = reached != UNDETERMINED
                values["rounded_branch"][n, k, determined] = continuation.branch[place][reached[determined]]
    return values


def _is_allowed(state: InitialState, contact: str, blocks: int) -> bool:
    """Return whether the velocities of a state are allowed: under one-sided contact no block slips backward."""
    return contact == "symmetric" or bool(state.coordinates(blocks)[1].min() >= 0.0)


def corners(state: InitialState, contact: str, blocks: int) -> list[InitialState]:
    """Return CORNERS states, whose positions and velocities are each ROUNDING above or below those of a state.

    Those of a state of the paper follow v, as it does.

    With three blocks these are all corners of the box around the state; in longer chains every sixth number changes
    together.
    contact : if one_sided, velocities are at least 0
    """
    above = np.arange(CORNERS)[:, None] >> (np.arange(2 * blocks) % 6) & 1
    numbers = np.concatenate(state.coordinates(blocks)) + ROUNDING * (2 * above - 1)
    if contact == "one_sided":
        numbers[:, blocks:] = np.maximum(numbers[:, blocks:], 0.0)
    return [replace(state, position=row[:blocks].tolist(), velocity=row[blocks:].tolist()) for row in numbers]


def _labels_of_states(
    model: Model, attractors: Sequence[Attractor], states: Sequence[InitialState], label_limit: float
) -> np.ndarray:
    """Return the index of the attractor that each state reaches, −1 for none, shape (contact, start, initial)."""
    labels = np.full((len(CONTACTS), len(STARTS), len(states)), UNDETERMINED)
    for i, contact in enumerate(CONTACTS):
        other = replace(model, contact=contact)
        allowed = [n for n, state in enumerate(states) if _is_allowed(state, contact, model.blocks)]
        cases = [(j, n) for j in range(len(STARTS)) for n in allowed]
        reached, _ = label(other, attractors, [other.begin(states[n], STARTS[j]) for j, n in cases], label_limit)
        for (j, n), index in zip(cases, reached, strict=True):
            labels[i, j, n] = index
    return labels


def _sweeps(continuation: Continuation) -> dict[str, np.ndarray]:
    """Follow each attractor of the smallest a upward and each of the largest a downward, step by step of the grid."""
    attractors = [continuation.attractors[place] for place in continuation.grid]
    count = len(attractors)
    # A sweep cannot begin where there is no attractor, as at a = 0.
    occupied = [k for k in range(count) if attractors[k]] or [0]
    ends = (occupied[0], occupied[-1])
    sweeps = max(1, *(len(attractors[end]) for end in ends))
    values = empty_columns(VARIABLES, {"direction": 2, "sweep": sweeps, "a": count}, "sweep")
    for direction, (end, steps, following) in enumerate(
        zip(
            ends,
            (range(ends[0], count), range(ends[1], -1, -1)),
            (continuation.upward, continuation.downward),
            strict=True,
        )
    ):
        for sweep, row in enumerate(continuation.rows(continuation.grid[end])):
            index = row.index
            for k in steps:
                values["sweep_branch"][direction, sweep, k] = continuation.branch[continuation.grid[k]][index]
                values["sweep_mean_distance"][direction, sweep, k] = attractors[k][index].motion.mean_distance
                index = int(following[k][index])
                if index == UNDETERMINED:
                    break
    return values
