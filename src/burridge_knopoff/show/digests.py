"""Sentences about summaries of runs, computed from their data: the main result of each law and initial state."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import product

import numpy as np
import xarray

from burridge_knopoff.claims.verdict import format_values
from burridge_knopoff.dataset.decoding import decode_flags
from burridge_knopoff.motion.kind import CHAOS, MotionKind
from burridge_knopoff.running.status import Status
from burridge_knopoff.study.formatting import format_count, span
from burridge_knopoff.summaries.bifurcation_diagram import section_points
from burridge_knopoff.summaries.solvers import NO_RUN

_UNCLEAR = "undetermined at {} of a from the run alone (agreement.nc has the kind of the attractor)"
NO_EVENT = "neighbours slip without end (try a slower driver), or the window is too short"


#: What a line of a digest is about.
RUN = ("law", "initial")


def lines_of(data: xarray.Dataset, dimensions: Sequence[str], sentence: Callable[[xarray.Dataset], str]) -> str:
    """Return a line `law, initial: sentence` for all coordinates of some dimensions, given their part of the data."""
    cases = product(*(data[name].values for name in dimensions))
    parts = ((case, data.sel(dict(zip(dimensions, case, strict=True)))) for case in cases)
    return "\n".join(f"{', '.join(case)}: {sentence(part)}" for case, part in parts)


def values_where(holds: np.ndarray, a: np.ndarray) -> str:
    """Return the values of a at which something holds: `up to a = 0.085`, `at a = 0.02 to 0.04, 0.05`, `at no a`."""
    if holds.all():
        return "at all a"
    if not holds.any():
        return "at no a"
    last = int(np.flatnonzero(holds)[-1])
    return f"up to a = {a[last]:g}" if holds[: last + 1].all() else format_values(a, holds)


def _largest(name: str, values: xarray.DataArray) -> Iterator[str]:
    """Yield the largest finite value and where it is, over a or other parameters, if there is one."""
    finite = values.where(np.isfinite(values))
    if finite.notnull().any():
        place = finite.isel(finite.argmax(...))
        where = ", ".join(f"{dimension} = {place[dimension].item():g}" for dimension in values.dims)
        yield f"largest {name} {place.item():.4g} at {where}"


def _incomplete(completed: np.ndarray) -> Iterator[str]:
    """Yield how many runs did not complete, if there are any."""
    if not completed.all():
        yield f"{np.count_nonzero(~completed)} of {format_count(completed.size, 'run')} did not complete"


def runs(data: xarray.Dataset) -> str:
    """Return how many runs of each law and initial state completed."""

    def sentence(part: xarray.Dataset) -> str:
        completed = part["status"].values == Status.COMPLETED
        return next(_incomplete(completed), f"all {completed.size} runs completed")

    return lines_of(data, RUN, sentence)


def mean_distance(data: xarray.Dataset) -> str:
    """Return where each law and initial state is synchronized, and its largest ⟨J⟩."""

    def sentence(part: xarray.Dataset) -> str:
        is_synchronized = decode_flags(part["synchronized"]).values == "yes"
        where = f"at {np.count_nonzero(is_synchronized)} of {format_count(is_synchronized.size, 'point')}"
        if is_synchronized.ndim == 1:
            where = values_where(is_synchronized, part["a"].values)
        return "; ".join([f"synchronized {where}", *_largest("<J>", part["mean_distance"])])

    return lines_of(data, RUN, sentence)


def lyapunov(data: xarray.Dataset) -> str:
    """Return where the runs of each law and initial state are chaotic or undetermined, and the largest exponent.

    Over several parameters all kinds of motion are counted.
    """

    def sentence(part: xarray.Dataset) -> str:
        kind = part["run_kind"]
        largest = _largest("exponent", part["lyapunov_exponent"].max("exponent")) if part.sizes["exponent"] else []
        words = _chaotic_values(kind) if kind.ndim == 1 else [_kind_counts(kind.values)]
        return "; ".join([*words, *largest])

    return lines_of(data, RUN, sentence)


def _chaotic_values(kind: xarray.DataArray) -> Iterator[str]:
    is_chaotic = kind.isin(CHAOS).values
    first = f", first at a = {kind['a'].values[is_chaotic.argmax()]:g}" if is_chaotic.any() else ""
    yield f"chaotic at {is_chaotic.sum()} of {kind.size} values of a{first}"
    if unclear := int((kind == MotionKind.UNDETERMINED).sum()):
        yield _UNCLEAR.format(format_count(unclear, "value"))


def _kind_counts(kinds: np.ndarray) -> str:
    counts = [f"{kind.words} {count}" for kind in MotionKind if (count := np.count_nonzero(kinds == kind))]
    return f"{format_count(kinds.size, 'point')}: {', '.join(counts)}"


def bifurcation_diagram(data: xarray.Dataset) -> str:
    """Return the range of W' at upward crossings of the section for each law and initial state."""
    lines = []
    for law, initial in dict.fromkeys(zip(data["law"].values, data["initial"].values, strict=True)):
        a, velocity = section_points(data, law, initial, 1)
        words = "W never crosses 0 upward"
        if len(a):
            ends = span(f"{velocity.min():.4g}", f"{velocity.max():.4g}")
            words = f"W' at upward crossings is {ends}, largest at a = {a[velocity.argmax()]:g}"
        lines.append(f"{law}, {initial}: {words}")
    return "\n".join(lines)


def stick_slip(data: xarray.Dataset) -> str:
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
            which = f"block {part['block'].values[block]} at a = {a[place]:g}"
            words.append(f"the largest fraction of time in which a block sticks is {stuck[place, block]:.2g} ({which})")
        negative = np.count_nonzero(part["velocity_correlation"].values < 0.0)
        words.append(
            f"the velocities of the end blocks are negatively correlated at {negative} of {len(a)} values of a"
        )
        return "; ".join([*words, *_incomplete(completed)])

    return lines_of(data, RUN, sentence)


def solvers(data: xarray.Dataset) -> str:
    """Return how far ⟨J⟩ and the order of events of other solvers differ from those of the study's points."""
    lines = []
    for law in data["law"].values:
        main_solver = data.attrs[f"solver_{law}"]
        reference = data.sel(law=law, solver=main_solver)
        for solver in data["solver"].values:
            part = data.sel(law=law, solver=solver)
            status = part["status"].values
            if solver == main_solver or (status == NO_RUN).all():
                continue
            runs = status != NO_RUN
            completed = (status == Status.COMPLETED) & (reference["status"].values == Status.COMPLETED)
            difference = np.where(completed, np.abs(part["difference"].values), np.nan)
            words = []
            if np.isfinite(difference).any():
                i, k = np.unravel_index(np.nanargmax(difference), difference.shape)
                largest, error = f"{difference[i, k]:.2g}", part["difference_error"].values[i, k]
                where = f"{part['initial'].values[i]}, a = {part['a'].values[k]:g}"
                words.append(f"<J> differs by at most {largest}{f' +- {error:.2g}' if error > 0.0 else ''} ({where})")
            until = part["event_order_time"].values
            end = np.fmin(part["end_time"].values, reference["end_time"].values)
            same = runs & (until >= end)
            order = f"the order of events is the same in {np.count_nonzero(same)} of {format_count(runs.sum(), 'run')}"
            if (runs & ~same).any():
                order += f" and in the others at least until tau = {until[runs & ~same].min():.4g}"
            words.append(order)
            lines.append(
                f"{law}, {solver} compared with {main_solver}: {'; '.join([*words, *_incomplete(completed[runs])])}"
            )
    return "\n".join(lines)


def catalogue(data: xarray.Dataset) -> str:
    """Return the number of slip events under each law, the range of their slopes, and how many catalogues are empty."""

    def sentence(part: xarray.Dataset) -> str:
        events = format_count(int(np.maximum(part["event_count"].values, 0).sum()), "slip event")
        words = f"{events} at {format_count(part.sizes['a'], 'value')} of a"
        slope = part["slope"].values
        if np.isfinite(slope).any():
            ends = span(f"{np.nanmin(slope):.3g}", f"{np.nanmax(slope):.3g}")
            words += f"; slope b of the magnitudes {ends} (rates decrease as exp(-b magnitude))"
        return "; ".join([words, *_incomplete(part["status"].values == Status.COMPLETED)])

    return "\n".join(filter(None, [lines_of(data, ["law"], sentence), empty_catalogues(data)]))


def empty_catalogues(data: xarray.Dataset) -> str:
    """Return at how many values of a catalogues of completed runs are empty, and why; empty if none is."""
    is_empty = (data["event_count"].values == 0) & (data["status"].values == Status.COMPLETED)
    return f"no slip event at {is_empty.sum()} of {is_empty.size} values: {NO_EVENT}" if is_empty.any() else ""


def slip_events(data: xarray.Dataset) -> str:
    """Return why the catalogue of one completed run is empty; empty if it is not."""
    is_empty = not data.sizes["event"] and data["status"].item() == Status.COMPLETED
    return f"no slip event: {NO_EVENT}" if is_empty else ""


#: {name of a result: function that returns its digest}
DIGESTS: dict[str, Callable[[xarray.Dataset], str]] = {
    function.__name__: function
    for function in (
        *(runs, mean_distance, lyapunov, bifurcation_diagram, stick_slip, solvers),
        *(catalogue, slip_events),
    )
}
