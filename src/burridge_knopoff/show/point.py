"""A page of text about a point file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.dataset.law_attributes import has_a
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.motion.kind import format_motion, motion_of_run
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.running.command import CHAIN_OPTIONS
from burridge_knopoff.running.status import early_end, none_because
from burridge_knopoff.show.formatting import list_numbers, quoted_history, wrap_lines
from burridge_knopoff.show.result import Result
from burridge_knopoff.study.formatting import format_count, to_ascii, with_error
from burridge_knopoff.summaries.text_table import UNLIMITED, table

# Options of a chain that are listed only if they differ from their defaults.
RARE = ("damping", "pulling_damping", "weakening")


def point_lines(result: Result, width: int = UNLIMITED) -> list[str]:
    """Return a description of a point file, one row for each fact, in lines of at most a width."""
    point, attributes = result.data, result.data.attrs
    head = f"{result.path}: a run from {attributes['initial']}, {attributes['law']} law"
    if has_a(attributes):
        head += f", a = {point['a'].item()!r}"
    rows = [
        *_model(point),
        *_run(point),
        ("", ""),
        *_outcome(point, result.motion),
        ("", ""),
        *_contents(point),
        ("", ""),
        ("made by", result.origin),
    ]
    # The command is not wrapped, so that it can be copied.
    history = quoted_history(str(attributes["history"]))
    command = f"reproduce with: {history} --out FILE" if history.startswith("bk simulate ") else f"history: {history}"
    return [*wrap_lines([head], width), "", *table((), rows, width), "", command]


def _model(point: xarray.Dataset) -> Iterator[tuple[str, str]]:
    attributes = point.attrs
    options = {
        key: attributes[name] for key in CHAIN_OPTIONS if key != "ends" and (name := f"chain_{key}") in attributes
    }
    options = {key: value for key, value in options.items() if key not in RARE or np.any(value != getattr(Chain, key))}
    chain = ", ".join(f"{key} {_text(value)}" for key, value in options.items())
    yield "chain", f"{point.sizes['block']} blocks, {attributes['chain_ends']}: {chain}"
    numbers = [
        f"{key.removeprefix('law_')} = {value:g}"
        for key, value in attributes.items()
        if key.startswith("law_") and key != "law_formula"
    ]
    yield "law", ", ".join([f"{attributes['law']}: Phi = {attributes['law_formula']}", *numbers])
    if has_a(attributes):
        yield "", f"a = {point['a'].item():g}"
    yield "driver", f"v = {point['v'].item():g}; contact {attributes['contact']}"
    yield "initial state", f"{attributes['initial']} (start {attributes['start']})"
    yield "", f"U(0)  = {list_numbers(point['initial_position'].values)}"
    yield "", f"U'(0) = {list_numbers(point['initial_velocity'].values)}"


def _text(value: object) -> str:
    return value if isinstance(value, str) else list_numbers(value)  # type: ignore[arg-type]


def _run(point: xarray.Dataset) -> Iterator[tuple[str, str]]:
    attributes = point.attrs
    step = f", step {attributes['step']:g}" if "step" in attributes else ""
    yield "solver", f"{attributes['solver']}{step}; {point['step_count'].item()} steps"
    yield (
        "time",
        f"transient {attributes['transient']:g}, window {attributes['window']:g} in {point.sizes['batch']} batches",
    )


def _outcome(point: xarray.Dataset, motion: MotionSettings) -> Iterator[tuple[str, str]]:
    run = {str(name): variable.values for name, variable in point.variables.items()}
    options = {key: _plain_value(point.attrs[name]) for key in CHAIN_OPTIONS if (name := f"chain_{key}") in point.attrs}
    chain = Chain(point.sizes["block"], **options)
    end_time = point["end_time"].item()
    ended = early_end(point["status"].item(), end_time)
    yield "status", ended or f"completed at tau = {end_time:g}"
    mean = with_error(point["mean_distance"].item(), point["mean_distance_error"].item())
    yield "<J>", "unknown" if ended else to_ascii(mean)
    motion = motion.scaled_to_velocity(point["v"].item())
    yield "motion", format_motion(motion_of_run(run, chain.is_mirror_symmetric, motion), motion)
    exponents = list(zip(run["lyapunov_exponent"], run["lyapunov_error"], strict=True))
    if exponents and not np.isnan(run["lyapunov_exponent"]).all():
        yield "exponents", ", ".join(to_ascii(with_error(*map(float, exponent))) for exponent in exponents)
        if run["lyapunov_infinite_count"] > 0:
            infinite = int(run["lyapunov_infinite_count"])
            verb = "is" if infinite == 1 else "are"
            yield "", f"at least {infinite} of the {2 * chain.blocks} exponents {verb} -infinity"
    else:
        reason = point.attrs.get("missing_derivative", "")
        yield "exponents", "unknown" if ended else none_because(reason)
    yield "events", f"{point['event_count'].item()} stops and starts {'until then' if ended else 'in the whole run'}"
    yield "", f"smallest friction Phi of a slipping block {run['least_friction']:.4g}"
    word = "most negative" if run["least_spring_force"] < 0.0 else "smallest"
    yield "", f"{word} spring force on a stuck block {run['least_spring_force']:.4g}"


def _plain_value(value: Any) -> Any:
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value


def _contents(point: xarray.Dataset) -> Iterator[tuple[str, str]]:
    sampled = point["time"].values[np.isfinite(point["distance"].values)]
    yield "J(tau)", f"{format_count(len(sampled), 'sample')}{_span(sampled)}"
    direction = point["crossing_direction"].values
    up, down = int((direction > 0).sum()), int((direction < 0).sum())
    yield "section W = 0", f"{up} upward and {down} downward crossings{_span(point['crossing_time'].values)}"
    blocks = range(1, point.sizes["block"] + 1)
    for name, words in (("event", "with the states of all blocks"), ("earlier_event", "before them, without states")):
        moved = point[f"{name}_block"].values[point[f"{name}_kind"].values == 0]
        stops = (
            f"; stops of each block: {list_numbers([(moved == block).sum() for block in blocks])}" if len(moved) else ""
        )
        if name == "event" or point.sizes[name]:
            yield (
                "stops and starts" if name == "event" else "",
                f"{point.sizes[name]} {words}{_span(point[f'{name}_time'].values)}{stops}",
            )
    # A run that ended early did not reach its last part.
    time = point["trajectory_time"].values[np.isfinite(point["velocity"].values).all(axis=1)]
    yield "trajectory", f"positions and velocities at {format_count(len(time), 'time')}{_span(time)}"


def _span(time: np.ndarray) -> str:
    return f", tau = {time[0]:g} to {time[-1]:g}" if len(time) else ""
