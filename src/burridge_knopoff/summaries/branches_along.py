"""The branches of attractors along a parameter and their basin fractions: variables of `attractors.nc`."""

from __future__ import annotations

import numpy as np

from burridge_knopoff.attractors.labels import UNDETERMINED
from burridge_knopoff.attractors.table import NOTHING, slot_values, slot_variables
from burridge_knopoff.continuation.attractor_continuation import Continuation
from burridge_knopoff.dataset.columns import empty_columns
from burridge_knopoff.dataset.variables import YES_OR_NO, Variable
from burridge_knopoff.model.parameters import plain_name
from burridge_knopoff.model.sampling import fraction_interval
from burridge_knopoff.model.uniform_sliding import is_sliding_attracting


def branch_variables(parameter: str) -> dict[str, Variable]:
    """Return the variables over (parameter, attractor), and over the parameter."""
    dimension = plain_name(parameter)
    slot = dimension, "attractor"
    return {
        **slot_variables(dimension, parameter),
        "upward_branch": Variable(
            slot,
            "i2",
            f"branch reached at the next larger {parameter}: from the attractor, at the next larger {parameter} of the "
            "grid",
            NOTHING,
        ),
        "downward_branch": Variable(
            slot,
            "i2",
            f"branch reached at the next smaller {parameter}: from the attractor, at the next smaller {parameter} of "
            "the grid",
            NOTHING,
        ),
        "basin_count": Variable(
            slot, "i4", "states in the basin: number of sampled initial states that reach the attractor", nothing=0
        ),
        "basin_fraction": Variable(
            slot,
            "f8",
            "basin fraction: fraction of the sampled initial states that reach the attractor",
            {"comment": "if chaos is transient, the fraction of its successor grows with the time states are followed"},
        ),
        "basin_fraction_low": Variable(slot, "f8", "lower end of the basin fraction: of its 95 % Wilson interval"),
        "basin_fraction_high": Variable(slot, "f8", "upper end of the basin fraction: of its 95 % Wilson interval"),
        "sample_count": Variable(
            (dimension,), "i4", "number of sampled states: initial states drawn for the basin fractions", nothing=0
        ),
        "undetermined_count": Variable(
            (dimension,),
            "i4",
            "number of undetermined states: sampled initial states that reach no attractor by label_limit",
            nothing=0,
        ),
        "sliding_attracts": Variable(
            (dimension,),
            "i1",
            "uniform sliding attracts: whether small perturbations of uniform sliding decay",
            YES_OR_NO,
        ),
    }


def branch_values(continuation: Continuation, least_lifetime: float) -> dict[str, np.ndarray]:
    """Return the values of these variables on the grid; least_lifetime : up to which chaos counts as transient."""
    models = [continuation.models[k] for k in continuation.grid]
    rows = [continuation.rows(k) for k in continuation.grid]
    return {
        **slot_values(models, rows, least_lifetime, plain_name(continuation.parameter)),
        **_basin_fractions(continuation),
        **_neighbour_branches(continuation),
        "sliding_attracts": np.array([is_sliding_attracting(model) for model in models]),
    }


def _basin_fractions(continuation: Continuation) -> dict[str, np.ndarray]:
    """Return how many of the sampled states reach each attractor, and their fraction with its interval."""
    variables, dimension = branch_variables(continuation.parameter), plain_name(continuation.parameter)
    shape = {dimension: len(continuation.grid), "attractor": continuation.most_attractors}
    values = empty_columns(variables, shape, "basin", "undet", "sample_count")
    for k, (place, reached) in enumerate(zip(continuation.grid, continuation.samples, strict=True)):
        values["sample_count"][k] = len(reached)
        values["undetermined_count"][k] = np.count_nonzero(reached == UNDETERMINED)
        for slot, row in enumerate(continuation.rows(place)):
            hits = int(np.count_nonzero(reached == row.index))
            values["basin_count"][k, slot] = hits
            interval = fraction_interval(hits, len(reached))
            for name, value in zip(("", "_low", "_high"), interval, strict=True):
                values[f"basin_fraction{name}"][k, slot] = value
    return values


def _neighbour_branches(continuation: Continuation) -> dict[str, np.ndarray]:
    """Return the branch that each attractor leads to at the next larger and smaller value of the grid."""
    values = {}
    for name, step, following in (("upward", 1, continuation.upward), ("downward", -1, continuation.downward)):
        values[f"{name}_branch"] = np.full(
            (len(continuation.grid), continuation.most_attractors), UNDETERMINED, dtype="i2"
        )
        for k, place in enumerate(continuation.grid):
            for slot, row in enumerate(continuation.rows(place)):
                if following[k][row.index] != UNDETERMINED:
                    branch = continuation.branch[continuation.grid[k + step]]
                    values[f"{name}_branch"][k, slot] = branch[following[k][row.index]]
    return values
