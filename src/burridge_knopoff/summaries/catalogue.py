"""Statistics of slip events over (law, a): rates, their slope, extents, intervals and recurrence.

Each value of a has its own run, whose catalogue file has all events. Rates are NaN for runs that did not complete.
Standard errors are those of batch means: see `catalogue.batches`.

Bins are 0.5 wide, in the magnitude and in the natural logarithm of the interval. The last 3000 events of each run are
listed. On a grid or network the blocks of an event are known only with `profiles`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.catalogue.batches import batch_index, batch_sums, rate_error, ratio_error
from burridge_knopoff.catalogue.distribution import EDGES, WIDTH, covered_blocks, fit_range, recurrence
from burridge_knopoff.catalogue.slip_events import NO_EVENT
from burridge_knopoff.catalogue.slope import fit_slope
from burridge_knopoff.dataset.point import STATUS_FLAG
from burridge_knopoff.dataset.summary import axes, open_summary, summary
from burridge_knopoff.dataset.variables import Variable
from burridge_knopoff.running.status import Status
from burridge_knopoff.study.formatting import format_count, span
from burridge_knopoff.summaries.sentences import incomplete, lines_of

TITLE = "Slip events: rates, slopes, extents and intervals"

#: Number of events in the map of slips: the last ones of a run.
LAST_EVENTS = 3000

_V = Variable
_RUN = ("law", "a")
_MAGNITUDE, _INTERVAL, _BLOCK, _SHOWN, _BAR = (
    (*_RUN, name) for name in ("magnitude", "interval", "block", "shown_event", "bar")
)
VARIABLES = {
    "status": _V(_RUN, "i1", "how the run ended", STATUS_FLAG),
    "event_count": _V(_RUN, "i8", "number of events in the catalogue"),
    "event_rate": _V(_RUN, "f8", "events per unit of time tau"),
    "event_rate_error": _V(_RUN, "f8", "standard error of this rate: from batch means"),
    "largest_magnitude": _V(_RUN, "f8", "largest magnitude"),
    "slope": _V(_RUN, "f8", "slope b: the rate decreases as exp(-b magnitude) in the range of the fit"),
    "slope_error": _V(_RUN, "f8", "error of the slope: root of the sum of the squares of scatter and spread"),
    "slope_scatter": _V(_RUN, "f8", "standard error of the slope in this range: from batch means"),
    "slope_spread": _V(
        _RUN,
        "f8",
        "spread of the slope: its largest difference from the slopes in the lower and the upper half of the range",
        {"comment": "0 if these differ by less than two standard errors, or if a half has too few events"},
    ),
    "slope_low": _V(_RUN, "f8", "smallest magnitude in the fit"),
    "slope_high": _V(_RUN, "f8", "largest magnitude in the fit"),
    "slope_count": _V(_RUN, "i8", "number of events in the fit"),
    "slope_p_value": _V(
        _RUN,
        "f8",
        "p value: probability that a catalogue drawn from the fit deviates from its own fit by at least as much",
        {"comment": "Kolmogorov-Smirnov distance, parametric bootstrap; allows for correlated events"},
    ),
    "magnitude_count": _V(_MAGNITUDE, "i8", "number of events per bin of magnitude"),
    "magnitude_rate": _V(_MAGNITUDE, "f8", "rate per magnitude: events per unit of time tau and of magnitude"),
    "magnitude_rate_error": _V(_MAGNITUDE, "f8", "standard error of this rate: from batch means"),
    "mean_extent": _V(
        _MAGNITUDE, "f8", "mean extent: mean number of slipping blocks of the events in a bin of magnitude"
    ),
    "mean_extent_error": _V(_MAGNITUDE, "f8", "standard error of the mean extent: from batch means"),
    "interval_count": _V(_INTERVAL, "i8", "number of events per bin of interval"),
    "interval_count_error": _V(_INTERVAL, "f8", "standard error of this number: from batch means"),
    "block_event_count": _V(_BLOCK, "i8", "number of events that contain a block", {"comment": "-1 unknown"}),
    "recurrence": _V(_BLOCK, "f8", "recurrence time: mean time tau between events that contain a block"),
    "recurrence_error": _V(_BLOCK, "f8", "standard error of the recurrence time: from batch means"),
    "recurrence_spread": _V(_BLOCK, "f8", "standard deviation of the time between these events"),
    "recurrence_spread_error": _V(_BLOCK, "f8", "standard error of this standard deviation: from batch means"),
    "shown_time": _V(
        _SHOWN, "f8", "time tau of a shown event: of one of the last events of the run, NaN if there are fewer"
    ),
    "shown_magnitude": _V(_SHOWN, "f8", "magnitude of this event"),
    "bar_event": _V(
        _BAR,
        "i4",
        "number of the shown event: from 1, in which a range of consecutive blocks slips, 0 if there are fewer",
    ),
    "bar_first_block": _V(_BAR, "i4", "first block of this range"),
    "bar_last_block": _V(_BAR, "i4", "last block of this range"),
}
COORDINATES = {
    "magnitude": _V(("magnitude",), "f8", "magnitude: natural logarithm of the moment, at the middle of a bin"),
    "interval": _V(
        ("interval",),
        "f8",
        "interval: time tau since the start of the last event in which the epicentre slipped, at the middle of a bin",
    ),
}
#: Attributes that all catalogue files have in common.
SHARED = ("contact", "loading", "start", "begin_time", "end_time")


def statistics(config: Mapping[str, Any], paths: Iterable[Path]) -> xarray.Dataset:
    """Return the statistics of all catalogues, one file for each law and a, opened one after another.

    config : `laws` and the keys of `catalogue` of a study's config
    """
    fit = {name: value for name, value in config["catalogue"].items() if name != "a"}
    return summarize(map(open_summary, paths), list(config["laws"]), config["catalogue"]["a"], **fit)


def summarize(
    catalogues: Iterable[xarray.Dataset],
    laws: Sequence[str],
    grid: Sequence[float],
    low: float | None = None,
    high: float | None = None,
) -> xarray.Dataset:
    """Return the summary of the catalogue files of all laws at all a, in this order.

    low, high : ends of the range in which slopes are fitted; by default those of `fit_range`
    """
    runs, attributes = [], {}
    # One catalogue at a time is kept in memory.
    for catalogue in catalogues:
        runs.append(_run_statistics(catalogue, low, high))
        attributes = {name: catalogue.attrs[name] for name in SHARED} | {"v": catalogue["v"].item()}
    most = max(len(run["bar_event"]) for run in runs)
    for run in runs:
        run |= {name: _pad(run[name], 0, most) for name in VARIABLES if name.startswith("bar_")}
    values = {
        name: np.reshape([run[name] for run in runs], (len(laws), len(grid), *np.shape(runs[0][name])))
        for name in VARIABLES
    }
    middle = EDGES[:-1] + WIDTH / 2
    blocks = range(1, values["recurrence"].shape[-1] + 1)
    coordinates = axes(COORDINATES, law=laws, a=grid, magnitude=middle, interval=np.exp(middle), block=blocks)
    head = {"history": "snakemake, from the catalogue files", "bin_width": WIDTH, **attributes}
    whole = summary(TITLE, VARIABLES, values, coordinates, head, module=__name__)
    there = {
        "magnitude": whole["magnitude_count"],
        "interval": whole["interval_count"],
        "shown_event": whole["shown_time"].notnull(),
    }
    return whole.isel({name: _nonzero_range(counts, name) for name, counts in there.items()})


def _nonzero_range(counts: xarray.DataArray, name: str) -> slice:
    """Return the range of a dimension outside which all counts are 0."""
    indices = np.flatnonzero((counts > 0).any([other for other in counts.dims if other != name]).values)
    return slice(indices[0], indices[-1] + 1) if len(indices) else slice(0)


def _run_statistics(catalogue: xarray.Dataset, low: float | None, high: float | None) -> dict[str, Any]:
    """Return the values of all variables for one catalogue."""
    begin, end = (catalogue.attrs[f"{name}_time"] for name in ("begin", "end"))
    completed = catalogue["status"].item() == Status.COMPLETED
    length = end - begin if completed else np.nan
    names = ("time", "magnitude", "moment", "blocks", "interval")
    time, magnitude, moment, extent, interval = (catalogue[name].values for name in names)
    batch = batch_index(time, begin, end)
    with np.errstate(divide="ignore", invalid="ignore"):
        counts, covered = (_binned(batch, magnitude, values) for values in (None, extent))
        mean_extent = covered.sum(axis=1) / counts.sum(axis=1)
        among = _binned(batch, np.log(interval))
    number = catalogue.attrs["blocks"]
    members = _members(catalogue)
    known = None if members is None else recurrence(time, members, number, begin, end)
    unknown = np.full(number, np.nan)
    return {
        "status": catalogue["status"].item(),
        "event_count": len(time),
        "event_rate": len(time) / length,
        "event_rate_error": rate_error(batch_sums(batch)[0], length),
        "largest_magnitude": magnitude.max() if len(time) else np.nan,
        **_slope(time, magnitude, fit_range(magnitude, moment, extent, low, high), completed),
        "magnitude_count": counts.sum(axis=1),
        "magnitude_rate": counts.sum(axis=1) / (length * WIDTH),
        "magnitude_rate_error": rate_error(counts, length) / WIDTH,
        "mean_extent": mean_extent,
        "mean_extent_error": ratio_error(covered, counts),
        "interval_count": among.sum(axis=1),
        "interval_count_error": rate_error(among, length) * length,
        "block_event_count": known.count if known else np.full(number, -1),
        "recurrence": known.mean if known else unknown,
        "recurrence_error": known.mean_error if known else unknown,
        "recurrence_spread": known.spread if known else unknown,
        "recurrence_spread_error": known.spread_error if known else unknown,
        "shown_time": _pad(time[-LAST_EVENTS:], np.nan, LAST_EVENTS),
        "shown_magnitude": _pad(magnitude[-LAST_EVENTS:], np.nan, LAST_EVENTS),
        **_bars([] if members is None else members[-LAST_EVENTS:]),
    }


def _binned(batch: np.ndarray, values: np.ndarray, weights: np.ndarray | None = None) -> np.ndarray:
    """Return the events, or the sums of weights, in each bin of values and each batch, shape (bins, batches)."""
    bins = np.searchsorted(EDGES, values, side="right") - 1
    inside = (bins >= 0) & (bins < len(EDGES) - 1)
    chosen = None if weights is None else weights[inside]
    return batch_sums(batch[inside], chosen, bins[inside], len(EDGES) - 1)


def _members(catalogue: xarray.Dataset) -> Sequence[np.ndarray] | None:
    """Return the blocks of each event; None if they are unknown, as on a grid or network without slip profiles."""
    if "slip_block" in catalogue:
        return np.split(catalogue["slip_block"].values, np.cumsum(catalogue["blocks"].values)[:-1])
    if catalogue.sizes["event"] and {"chain_grid", "chain_springs"} & set(catalogue.attrs):
        return None
    return covered_blocks(catalogue["first_block"].values, catalogue["last_block"].values, catalogue.attrs["blocks"])


def _bars(members: Sequence[np.ndarray]) -> dict[str, np.ndarray]:
    """Return the ranges of consecutive blocks that slip in the same event, in the order of the events."""
    event = np.repeat(np.arange(1, len(members) + 1), [len(part) for part in members])
    block = np.concatenate([np.zeros(0, dtype=int), *(np.sort(part) for part in members)])
    first = np.ones(len(block), dtype=bool)
    first[1:] = (np.diff(event) > 0) | (np.diff(block) > 1)
    last = np.roll(first, -1)
    return {"bar_event": event[first], "bar_first_block": block[first], "bar_last_block": block[last]}


def _pad(values: np.ndarray, none: float, length: int) -> np.ndarray:
    """Return values padded to a length."""
    return np.pad(values, (0, length - len(values)), constant_values=none)


def _slope(
    time: np.ndarray, magnitude: np.ndarray, fitted: tuple[float, float], completed: bool
) -> Mapping[str, float]:
    """Return the fit of a slope in a range, NaN if there is none."""
    low, high = fitted
    names = ("low", "high", "count", "error", "scatter", "spread", "p_value")
    fit = dict.fromkeys(("b", *names), np.nan) | {"low": low, "high": high, "count": 0}
    # The fit fails if there are too few events, or if all have the same magnitude.
    with suppress(ValueError):
        fit |= vars(fit_slope(magnitude, low, high, time=time)) if completed else {}
    return {"slope": fit["b"]} | {f"slope_{name}": fit[name] for name in names}


def digest(data: xarray.Dataset) -> str:
    """Return the number of slip events under each law, the range of their slopes, and how many catalogues are empty."""

    def sentence(part: xarray.Dataset) -> str:
        events = format_count(int(np.maximum(part["event_count"].values, 0).sum()), "slip event")
        words = f"{events} at {format_count(part.sizes['a'], 'value')} of a"
        slope = part["slope"].values
        if np.isfinite(slope).any():
            ends = span(f"{np.nanmin(slope):.3g}", f"{np.nanmax(slope):.3g}")
            words += f"; slope b of the magnitudes {ends} (rates decrease as exp(-b magnitude))"
        return "; ".join([words, *incomplete(part["status"].values == Status.COMPLETED)])

    return "\n".join(filter(None, [lines_of(data, ["law"], sentence), empty_catalogues(data)]))


def empty_catalogues(data: xarray.Dataset) -> str:
    """Return at how many values of a catalogues of completed runs are empty, and why; empty if none is."""
    is_empty = (data["event_count"].values == 0) & (data["status"].values == Status.COMPLETED)
    return f"no slip event at {is_empty.sum()} of {is_empty.size} values: {NO_EVENT}" if is_empty.any() else ""
