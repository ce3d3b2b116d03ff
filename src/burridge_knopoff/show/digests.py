"""Sentences about summaries whose modules have no digest, computed from their data."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import xarray

from burridge_knopoff.dataset.variables import decode_flags
from burridge_knopoff.motion.kind import CHAOS, MotionKind
from burridge_knopoff.running.status import Status

NO_EVENT = "neighbours slip without end (try a slower driver), or the window is too short"


def _lines(data: xarray.Dataset, sentence: Callable[[xarray.Dataset, np.ndarray], str]) -> str:
    """Return a line with a sentence about each law and initial state, given its part of the data and a."""
    return "\n".join(
        f"{law}, {initial}: {sentence(data.sel(law=law, initial=initial), data['a'].values)}"
        for law in data["law"].values
        for initial in data["initial"].values
    )


def values_where(holds: np.ndarray, a: np.ndarray) -> str:
    """Return the values of a at which something holds: `up to a = 0.085`, `at a = 0.02 to 0.04, 0.05`."""
    if holds.all():
        return "at all a"
    edges = np.flatnonzero(np.diff([False, *holds, False])).reshape(-1, 2)
    spans = [f"{a[first]:g}" if first == end - 1 else f"{a[first]:g} to {a[end - 1]:g}" for first, end in edges]
    if holds[0] and len(spans) == 1:
        return f"up to a = {a[edges[0, 1] - 1]:g}"
    return f"at a = {', '.join(spans)}"


def _synchrony(is_synchronized: np.ndarray, a: np.ndarray) -> str:
    return f"synchronized {values_where(is_synchronized, a)}" if is_synchronized.any() else "synchronized at no a"


def _largest(name: str, values: np.ndarray, a: np.ndarray) -> Iterator[str]:
    if np.isfinite(values).any():
        place = np.nanargmax(np.where(np.isfinite(values), values, np.nan))
        yield f"largest {name} {values[place]:.4g} at a = {a[place]:g}"


def mean_distance(data: xarray.Dataset) -> str:
    """Return where each law and initial state is synchronized, and its largest ⟨J⟩."""

    def sentence(one: xarray.Dataset, a: np.ndarray) -> str:
        is_synchronized = decode_flags(one["synchronized"]).values == "yes"
        return "; ".join([_synchrony(is_synchronized, a), *_largest("<J>", one["mean_distance"].values, a)])

    return _lines(data, sentence)


def lyapunov(data: xarray.Dataset) -> str:
    """Return where the runs of each law and initial state are chaotic or undetermined, and the largest exponent."""

    def sentence(one: xarray.Dataset, a: np.ndarray) -> str:
        kind = one["run_kind"].values
        is_chaotic = np.isin(kind, CHAOS)
        first = f", first at a = {a[is_chaotic.argmax()]:g}" if is_chaotic.any() else ""
        unclear = np.count_nonzero(kind == MotionKind.UNDETERMINED)
        return "; ".join(
            [
                f"chaotic at {is_chaotic.sum()} of {len(a)} values of a{first}",
                *([f"by the run alone undetermined at {unclear} (see agreement.nc)"] if unclear else []),
                *_largest("exponent", one["lyapunov_exponent"].values.max(axis=-1, initial=-np.inf), a),
            ]
        )

    return _lines(data, sentence)


def catalogue(data: xarray.Dataset) -> str:
    """Return at how many values of a catalogues of completed runs are empty, and why; empty if none is."""
    is_empty = (data["event_count"].values == 0) & (data["status"].values == Status.COMPLETED)
    return f"no slip event at {is_empty.sum()} of {is_empty.size} values: {NO_EVENT}" if is_empty.any() else ""


def slip_events(data: xarray.Dataset) -> str:
    """Return why the catalogue of one completed run is empty; empty if it is not."""
    is_empty = not data.sizes["event"] and data["status"].item() == Status.COMPLETED
    return f"no slip event: {NO_EVENT}" if is_empty else ""


#: {name of a result: function that returns its digest}
DIGESTS: dict[str, Callable[[xarray.Dataset], str]] = {
    function.__name__: function for function in (mean_distance, lyapunov, catalogue, slip_events)
}
