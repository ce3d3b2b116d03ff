"""Stick-slip cycles over (law, initial, a): rate and duration of sticks, and correlation of the velocities."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import xarray

from burridge_knopoff.dataset.summary import summary
from burridge_knopoff.dataset.variables import Variable
from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.frequency import leading_frequency
from burridge_knopoff.periodic_orbits.grazing_distances import longest_spacing
from burridge_knopoff.running.ensemble import new_ensemble
from burridge_knopoff.running.status import Status
from burridge_knopoff.summaries.correlation import correlation
from burridge_knopoff.summaries.points import EVENTS, Grid, all_events, read_point

STOP, START = 0, 1

RECOMPUTED = "recomputed from the first stop: in chaos, this soon diverges from the trajectory of the run"

_POINT = ("law", "initial", "a")
_BLOCK = (*_POINT, "block")
VARIABLES = {
    "stop_rate": Variable(_BLOCK, "f8", "stops per unit of time tau in the window"),
    "cycle_time": Variable(
        _BLOCK,
        "f8",
        "mean time between successive stops of a block in the window",
        {"ancillary_variables": "cycle_time_error"},
    ),
    "cycle_time_error": Variable(_BLOCK, "f8", "standard error of the mean time between stops, from batches of cycles"),
    "stick_fraction": Variable(_BLOCK, "f8", "fraction of the window in which a block sticks"),
    "velocity_frequency": Variable(
        _BLOCK,
        "f8",
        "frequency, in cycles per unit time, of the highest peak of the spectrum of U', or of short slips, over the "
        "time of events with states",
        {"ancillary_variables": "velocity_frequency_error", "comment": RECOMPUTED},
    ),
    "velocity_frequency_error": Variable(
        _BLOCK, "f8", "half the resolution of this spectrum, 1/(2 T) for a duration T"
    ),
    "velocity_correlation": Variable(
        _POINT,
        "f8",
        "Pearson correlation of the velocities U' of the end blocks over the time of events with states",
        {"comment": RECOMPUTED},
    ),
    "least_velocity": Variable(_BLOCK, "f8", "smallest U' among the samples of the stored trajectory"),
    "position_amplitude": Variable(
        _BLOCK, "f8", "half the range of the position relative to the driver among the samples of the stored trajectory"
    ),
}
BLOCK = Variable(("block",), "i4", "block number, 1 to N along the chain", coordinate=True)
_READ = ["status", "position", "velocity", "trajectory_time", "event_position", "event_velocity", *EVENTS]


def summarize(grid: Grid, transient: float, window: float, batches: int) -> xarray.Dataset:
    """Return rates, durations and velocities of the stick-slip motion; NaN for a run that did not complete.

    transient, window, batches : of the runs; stops are counted from transient to transient + window
    """
    blocks = grid.blocks
    sizes = dict(zip(_POINT, grid.shape, strict=True), block=blocks)
    values = {name: np.full([sizes[key] for key in item.dimensions], np.nan) for name, item in VARIABLES.items()}
    for index, point in grid:
        read = read_point(grid, point, _READ)
        if read["status"] != Status.COMPLETED:
            continue
        time, block, kind = all_events(read)
        velocity = read["velocity"]
        law, _, a = point
        record, duration = long_velocity(read, grid.model(law, grid.a[a]), transient)
        for n in range(blocks):
            own = block == n + 1
            stops = time[own & (kind == STOP) & (time >= transient)]
            values["stop_rate"][index][n] = len(stops) / window
            values["cycle_time"][index][n], values["cycle_time_error"][index][n] = cycle_time(stops, batches)
            ends_stuck = bool(velocity[-1, n] == 0.0)
            values["stick_fraction"][index][n] = stick_fraction(
                time[own], kind[own], transient, transient + window, ends_stuck
            )
            frequency = leading_frequency(record[:, n], duration)
            values["velocity_frequency"][index][n] = frequency
            values["velocity_frequency_error"][index][n] = 0.5 / duration if math.isfinite(frequency) else np.nan
        values["velocity_correlation"][index] = correlation(record[:, 0], record[:, -1])
        values["least_velocity"][index] = velocity.min(axis=0)
        values["position_amplitude"][index] = 0.5 * np.ptp(read["position"], axis=0)
    return summary(
        "Stick-slip cycles of each block, and correlation of the velocities of the end blocks",
        VARIABLES,
        values,
        {
            **grid.axes(),
            "block": ("block", np.arange(1, blocks + 1, dtype=BLOCK.dtype), BLOCK.all_attributes()),
        },
        {"transient": transient, "window": window, "batches": batches},
        module=__name__,
    )


def long_velocity(run: Mapping[str, np.ndarray], model: Model, transient: float) -> tuple[np.ndarray, float]:
    """Return the longest available series of equidistant velocities U', shape (n, blocks), and its duration.

    run : arrays of a point file of the model; transient : of the run

    The motion is recomputed from the first stop with a stored state after the transient to the last event. If the
    stored trajectory lasts longer, its samples are returned instead.
    """
    time, kept = run["event_time"], float(np.ptp(run["trajectory_time"]))
    stops = np.flatnonzero((run["event_kind"] == STOP) & (time >= transient))
    if not len(stops) or time[-1] - time[stops[0]] <= kept:
        return run["velocity"], kept
    first, duration = stops[0], float(time[-1] - time[stops[0]])
    position, velocity = run["event_position"][first] - model.sliding_offset, run["event_velocity"][first]
    instants = np.linspace(0.0, duration, math.ceil(duration / longest_spacing(model.chain)) + 1)
    states = (position[None], velocity[None], velocity[None] == 0.0)
    return new_ensemble(model).run(*states, instants.tolist())["velocity"][0], duration


def cycle_time(stops: np.ndarray, batches: int) -> tuple[float, float]:
    """Return the mean time between successive stops and its standard error, NaN for fewer than two stops.

    Successive cycles are correlated. The error is therefore that of the means of `batches` batches of successive
    cycles, as for ⟨J⟩, or of single cycles if there are fewer.
    """
    cycles = np.diff(stops)
    if not len(cycles):
        return math.nan, math.nan
    means = np.array([part.mean() for part in np.array_split(cycles, min(batches, len(cycles)))])
    error = float(means.std(ddof=1) / math.sqrt(len(means))) if len(means) > 1 else math.nan
    return float(stops[-1] - stops[0]) / len(cycles), error


def stick_fraction(time: np.ndarray, kind: np.ndarray, start: float, end: float, ends_stuck: bool) -> float:
    """Return the fraction of [start, end] in which a block sticks.

    time, kind : all stops and starts of the block since τ = 0, in order
    ends_stuck : whether the block sticks at the end; needed if it has no stops and starts
    """
    before = kind[0] == START if len(kind) else ends_stuck
    edge = np.clip(np.concatenate([[start], time, [end]]), start, end)
    stuck = np.concatenate([[before], kind == STOP])
    return float(np.diff(edge)[stuck].sum()) / (end - start)
