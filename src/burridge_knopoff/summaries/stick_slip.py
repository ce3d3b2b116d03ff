"""Stick-slip cycles over (law, initial, a): rate and duration of sticks, and correlation of the velocities."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import Variable
from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.frequency import leading_frequency, starts_of_blocks
from burridge_knopoff.motion.jumps import event_jumps
from burridge_knopoff.periodic_orbits.grazing_distances import longest_spacing
from burridge_knopoff.running.ensemble import new_ensemble
from burridge_knopoff.running.status import Status
from burridge_knopoff.study.study import Study
from burridge_knopoff.summaries.correlation import correlation
from burridge_knopoff.summaries.points import EVENTS, all_events, point_axes
from burridge_knopoff.summaries.runs import RUN, over_runs
from burridge_knopoff.summaries.sentences import RUN as LINE
from burridge_knopoff.summaries.sentences import at_value, incomplete, lines_of, values_where

STOP, START = 0, 1

RECOMPUTED = "recomputed from the first stop: in chaos, this soon diverges from the trajectory of the run"

_BLOCK = (*RUN, "block")
VARIABLES = {
    "stop_rate": Variable(_BLOCK, "f8", "stop rate: stops per unit of time tau in the window"),
    "cycle_time": Variable(
        _BLOCK,
        "f8",
        "cycle time: mean time between successive stops of a block in the window",
        {"ancillary_variables": "cycle_time_error"},
    ),
    "cycle_time_error": Variable(_BLOCK, "f8", "standard error of the cycle time: from batches of cycles"),
    "stick_fraction": Variable(_BLOCK, "f8", "stick fraction: fraction of the window in which a block sticks"),
    "velocity_frequency": Variable(
        _BLOCK,
        "f8",
        "frequency of U': in cycles per unit time, of the highest peak of the spectrum of U', or of "
        "short slips by their starts, over the time of events with states",
        {"ancillary_variables": "velocity_frequency_error", "comment": RECOMPUTED},
    ),
    "velocity_frequency_error": Variable(
        _BLOCK, "f8", "error of this frequency: half the resolution of the spectrum, 1/(2 T) for a duration T"
    ),
    "velocity_correlation": Variable(
        RUN,
        "f8",
        "velocity correlation: Pearson correlation of the velocities U' of the end blocks over the time "
        "of events with states",
        {"comment": RECOMPUTED},
    ),
    "least_velocity": Variable(
        _BLOCK, "f8", "smallest velocity U': among the samples of the stored trajectory and the events in its time"
    ),
    "position_amplitude": Variable(
        _BLOCK,
        "f8",
        "amplitude of the position: half its range relative to the driver in the stored trajectory, between samples by "
        "the cubics through positions and velocities",
    ),
    "stop_jump": Variable(
        RUN, "f8", "smallest jump of U'' at a stop: of the block that stops, among the events with states"
    ),
    "start_jump": Variable(
        RUN,
        "f8",
        "smallest jump of U''' at a start: of the block that starts, among the events with states; U'' does not jump",
    ),
}
_READ = ["status", "position", "velocity", "trajectory_time", "event_position", "event_velocity", *EVENTS]


def summarize(study: Study, results: Path) -> xarray.Dataset:
    """Return rates, durations and velocities of the stick-slip motion; NaN for a run that did not complete.

    results : folder of the study. Stops are counted in the window of its runs
    """
    about = {name: study.config[name] for name in ("transient", "window", "batches")}

    def cycles(run: Mapping[str, np.ndarray], point: Mapping[str, str]) -> dict[str, Any]:
        return _cycles(run, study.run_of(**point)[0], **about) if run["status"] == Status.COMPLETED else {}

    return summary(
        "Stick-slip cycles of each block, and correlation of the velocities of the end blocks",
        VARIABLES,
        over_runs(study, results, VARIABLES, _READ, cycles, block=study.blocks),
        {**point_axes(study), **axes(block=range(1, study.blocks + 1))},
        about,
        module=__name__,
    )


def _cycles(
    run: Mapping[str, np.ndarray], model: Model, transient: float, window: float, batches: int
) -> dict[str, Any]:
    """Return the values of VARIABLES for a completed run of a model."""
    time, block, kind = all_events(run)
    record, begin, duration = long_velocity(run, model, transient)
    during = (time >= begin) & (time <= begin + duration)
    starts = starts_of_blocks(time[during], block[during], kind[during], model.blocks)
    blocks = []
    for number in range(1, model.blocks + 1):
        of_block = block == number
        stops = time[of_block & (kind == STOP) & (time >= transient)]
        ends_stuck = bool(run["velocity"][-1, number - 1] == 0.0)
        cycle, error = cycle_time(stops, batches)
        frequency = leading_frequency(record[:, number - 1], duration, starts[number - 1])
        blocks.append(
            {
                "stop_rate": len(stops) / window,
                "cycle_time": cycle,
                "cycle_time_error": error,
                "stick_fraction": stick_fraction(
                    time[of_block], kind[of_block], transient, transient + window, ends_stuck
                ),
                "velocity_frequency": frequency,
                "velocity_frequency_error": 0.5 / duration if math.isfinite(frequency) else np.nan,
            }
        )
    return {
        **{name: [values[name] for values in blocks] for name in blocks[0]},
        "velocity_correlation": correlation(record[:, 0], record[:, -1]),
        "least_velocity": least_velocity(run, time, block),
        "position_amplitude": position_amplitude(run["trajectory_time"], run["position"], run["velocity"] - model.v),
        **_smallest_jumps(run, model),
    }


def _smallest_jumps(run: Mapping[str, np.ndarray], model: Model) -> dict[str, float]:
    """Return the smallest jumps of U'' and U''' at events; NaN without any."""
    states = run["event_position"], run["event_velocity"]
    stops, starts = event_jumps(model, *states, run["event_block"], run["event_kind"] == STOP)
    return {
        "stop_jump": stops.min() if len(stops) else np.nan,
        "start_jump": starts.min() if len(starts) else np.nan,
    }


def least_velocity(run: Mapping[str, np.ndarray], time: np.ndarray, block: np.ndarray) -> np.ndarray:
    """Return the smallest U' of each block among the samples of the stored trajectory and the events in its time.

    time, block : of all events of the run. A stick between two samples has no sample, but a stop, at which U' is 0.
    """
    least = run["velocity"].min(axis=0)
    during = (time >= run["trajectory_time"][0]) & (time <= run["trajectory_time"][-1])
    stopped = np.isin(np.arange(1, len(least) + 1), block[during])
    return np.where(stopped, np.minimum(least, 0.0), least)


def position_amplitude(time: np.ndarray, position: np.ndarray, rate: np.ndarray) -> np.ndarray:
    """Return half the range of each of several motions, shape (blocks,), from equidistant samples of x and x'.

    A position turns between two samples where x' changes its sign: there it is that of the cubic through both.
    """
    step = np.diff(time)[:, None]
    first, last = step * rate[:-1], step * rate[1:]
    change = np.diff(position, axis=0)
    # x' = first + 2 b s + c s² on the interval, s from 0 to 1; the root of a change of sign, without cancellation.
    b, c = 3.0 * change - 2.0 * first - last, 3.0 * (first + last - 2.0 * change)
    turns = first * last < 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(np.maximum(b * b - first * c, 0.0))
        s = np.where(turns, -first / (b + np.copysign(root, -first)), 0.0)
    between = position[:-1] + s * (first + s * (b + s * c / 3.0))
    values = np.concatenate([position, between])
    return 0.5 * np.ptp(values, axis=0)


def long_velocity(run: Mapping[str, np.ndarray], model: Model, transient: float) -> tuple[np.ndarray, float, float]:
    """Return the longest available series of equidistant velocities U', shape (n, blocks), its begin and duration.

    run : arrays of a point file of the model; transient : of the run

    The motion is recomputed from the first stop with a stored state after the transient to the last event. If the
    stored trajectory lasts longer, its samples are returned instead.
    """
    time, kept = run["event_time"], float(np.ptp(run["trajectory_time"]))
    stops = np.flatnonzero((run["event_kind"] == STOP) & (time >= transient))
    if not len(stops) or time[-1] - time[stops[0]] <= kept:
        return run["velocity"], float(run["trajectory_time"][0]), kept
    first, duration = stops[0], float(time[-1] - time[stops[0]])
    position, velocity = run["event_position"][first] - model.sliding_offset, run["event_velocity"][first]
    instants = np.linspace(0.0, duration, math.ceil(duration / longest_spacing(model.chain)) + 1)
    states = (position[None], velocity[None], velocity[None] == 0.0)
    return new_ensemble(model).run(*states, instants.tolist())["velocity"][0], float(time[first]), duration


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


def digest(data: xarray.Dataset) -> str:
    """Return where all blocks stop, the longest sticks, and where the end blocks move against each other."""

    def sentence(part: xarray.Dataset) -> str:
        a = part["a"].values
        rate, stuck = part["stop_rate"].values, part["stick_fraction"].values
        completed = np.isfinite(rate).all(axis=-1)
        if not completed.any():
            return "no run completed"
        place, block = np.unravel_index(np.nanargmax(stuck), stuck.shape)
        words = [f"every block stops {values_where(completed & (rate > 0.0).all(axis=-1), a)}"]
        if stuck[place, block] > 0.0:
            which = f"block {part['block'].values[block]}{at_value(a, int(place))}"
            words.append(f"the largest fraction of time in which a block sticks is {stuck[place, block]:.2g} ({which})")
        negative = np.count_nonzero(part["velocity_correlation"].values < 0.0)
        where = f"at {negative} of {len(a)} values of a" if len(a) > 1 else values_where(np.array([negative > 0]), a)
        words.append(f"the velocities of the end blocks are negatively correlated {where}")
        return "; ".join([*words, *incomplete(completed)])

    return lines_of(data, LINE, sentence)
