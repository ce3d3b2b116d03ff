"""⟨J⟩ over (law, initial, a), or the study's parameters in place of a: the paper's Figs. 3a and 3b."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import xarray

from burridge_knopoff.dataset.decoding import decode_flags
from burridge_knopoff.dataset.summary import summary
from burridge_knopoff.dataset.variables import YES_OR_NO, Variable
from burridge_knopoff.running.status import Status
from burridge_knopoff.study.formatting import format_count
from burridge_knopoff.summaries import runs as all_runs
from burridge_knopoff.summaries.runs import RUN
from burridge_knopoff.summaries.sentences import RUN as LINE
from burridge_knopoff.summaries.sentences import incomplete, largest, lines_of, values_where

SYNCHRONIZED = Variable(RUN, "i1", "synchronized: whether <J> is below the threshold", YES_OR_NO)
_OF_RUNS = (
    *("mean_distance", "mean_distance_error", "least_friction", "window_least_friction", "window_least_spring_force"),
    *("event_count", "status", "settling_time", "distance_rounding"),
)
VARIABLES = {**{name: all_runs.VARIABLES[name] for name in _OF_RUNS}, "synchronized": SYNCHRONIZED}
_NOWHERE = {"comment": "synchrony is not defined: the chain is not its own mirror image"}


def summarize(runs: xarray.Dataset, synchronization_threshold: float) -> xarray.Dataset:
    """Return ⟨J⟩, its error, the settling times of J and which points are synchronized.

    A run that did not complete has NaN and counts as not synchronized, as does every run of a chain that is not its own
    mirror image.

    runs : the summary of that name
    """
    synchronized = (runs["mean_distance"] < synchronization_threshold) & (runs["mirror_symmetric"] == 1)
    variables = VARIABLES
    if not runs["mirror_symmetric"].any():
        about = {**SYNCHRONIZED.attributes, **_NOWHERE}
        variables = {**VARIABLES, "synchronized": replace(SYNCHRONIZED, attributes=about)}
    return summary(
        "Mean distance <J> between the end blocks",
        variables,
        runs.assign(synchronized=synchronized),
        runs.coords,
        {"history": "snakemake, from runs.nc", "synchronization_threshold": synchronization_threshold},
        module=__name__,
    )


def digest(data: xarray.Dataset) -> str:
    """Return where each law and initial state is synchronized, and its largest ⟨J⟩."""

    def sentence(part: xarray.Dataset) -> str:
        is_synchronized = decode_flags(part["synchronized"]).values == "yes"
        where = f"at {np.count_nonzero(is_synchronized)} of {format_count(is_synchronized.size, 'point')}"
        if is_synchronized.ndim == 1:
            where = values_where(is_synchronized, part["a"].values)
        completed = part["status"].values == Status.COMPLETED
        return "; ".join([f"synchronized {where}", *largest("<J>", part["mean_distance"]), *incomplete(completed)])

    return lines_of(data, LINE, sentence)
