"""The result of a run: observables with errors, named as in point files."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from burridge_knopoff.model.initial import CONTINUED, InitialState, StartedState
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.running.derivative import missing_derivative
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.settling import LEVELS, distance_rounding
from burridge_knopoff.running.status import Status, early_end


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Result of a run: model, initial state, settings, status, and observables. Arrays have the names of point files.

    `final` is the state at the end. `simulate(model, initial=run.final)` continues from it on the same clock, and the
    two runs together have the events and crossings of one long run, bit for bit. `initially_slipping` is true for the
    blocks that slip at the beginning. A block has this slip, if it is true, and one slip from each of its starts.

    Positions are U − vτ (relative to the driver) and velocities are U', as in the paper's figures. `given` is the
    state as it was given, and `initial` that from which the run started: one number per block, those of `minus` and
    `plus` at the v of the model, and velocities 0 of blocks that `start: tested` holds.

    Times are in units of 1/ω. Shapes: `initially_slipping` (blocks,); `settling_time` (levels,); `time`, `distance`
    (samples,); `event_time`, `event_block`, `event_kind` (events,), `event_position`, `event_velocity` (events,
    blocks), and likewise `earlier_event_…` for events without states; `crossing_…` (crossings,); `trajectory_time`
    (times,), `position`, `velocity` (times, blocks); `lyapunov_exponent` and its error (exponents,). The first
    dimension of `batch_…` is the batch. docs/variables.md describes each array. Averages and settling times are NaN
    unless `status` is completed. Lyapunov exponents are also NaN where perturbations have no linear growth;
    `missing_derivative` then says why, and is empty otherwise.

    >>> from burridge_knopoff import Model, simulate
    >>> run = simulate(Model("linearized", a=0.08), "plus", transient=0, window=20, events="all")
    >>> run.status, run.event_count, run.event_position.shape
    ('completed', 10, (10, 3))
    """

    model: Model
    given: InitialState | ChainState = field(repr=False)
    initial: InitialState
    settings: Settings
    status: str
    begin_time: float
    end_time: float
    initially_slipping: np.ndarray = field(repr=False)
    final: ChainState = field(repr=False)
    event_count: int
    step_count: int
    mean_distance: float
    mean_distance_error: float
    batch_mean_distance: np.ndarray = field(repr=False)
    settling_time: np.ndarray = field(repr=False)
    distance_rounding: float
    time: np.ndarray = field(repr=False)
    distance: np.ndarray = field(repr=False)
    earlier_event_time: np.ndarray = field(repr=False)
    earlier_event_block: np.ndarray = field(repr=False)
    earlier_event_kind: np.ndarray = field(repr=False)
    event_time: np.ndarray = field(repr=False)
    event_block: np.ndarray = field(repr=False)
    event_kind: np.ndarray = field(repr=False)
    event_position: np.ndarray = field(repr=False)
    event_velocity: np.ndarray = field(repr=False)
    crossing_time: np.ndarray = field(repr=False)
    crossing_velocity: np.ndarray = field(repr=False)
    crossing_direction: np.ndarray = field(repr=False)
    trajectory_time: np.ndarray = field(repr=False)
    position: np.ndarray = field(repr=False)
    velocity: np.ndarray = field(repr=False)
    least_friction: float
    least_spring_force: float
    window_least_friction: float
    window_least_spring_force: float
    lyapunov_exponent: np.ndarray = field(repr=False)
    lyapunov_error: np.ndarray = field(repr=False)
    batch_lyapunov_exponent: np.ndarray = field(repr=False)
    lyapunov_infinite_count: int
    missing_derivative: str

    def __repr__(self) -> str:
        ended = early_end(Status[self.status.upper()], self.end_time)
        return (
            f"<Trajectory of {self.model.blocks} blocks from {self.initial.name}, {self.model.words}: "
            f"{ended or f'completed at tau = {self.end_time:g}'}, {self.event_count} events, "
            f"<J> = {self.mean_distance:.6g} +- {self.mean_distance_error:.1g}>"
        )


def collect(
    model: Model,
    given: InitialState | ChainState,
    settings: Settings,
    runner: Runner,
    begun: ChainState,
    status: Status,
) -> Trajectory:
    """Return the trajectory of a run that started in the state `begun` and ended with a status."""
    measured = runner.observer.results()
    n = model.blocks
    offset = model.sliding_offset
    log = runner.log
    events = log.events.values()
    earlier_events = log.earlier_events.values()
    final = runner.final(status)
    rounding = distance_rounding(model, final)
    batch = measured["batch_integral"] * (settings.batches / settings.window)
    completed = status == Status.COMPLETED
    if not completed or runner.observer.section_only:
        batch[:] = math.nan
    settled = np.full(len(LEVELS), math.nan)
    if completed and not runner.observer.section_only:
        settled = np.where(np.array(LEVELS) > rounding, measured["settling_time"], math.nan)
    lyapunov = _exponents(runner, settings, completed)
    speed = measured["highest_speed"]
    force = measured["lowest_force"]
    least_friction = [math.nan if np.isnan(u) else model.least_friction(u) for u in (np.fmax(*speed), speed[1])]
    least_force = [float(value) for value in (np.fmin(*force), force[1])]
    return Trajectory(
        model=model,
        # Without the solver that the state holds to continue exactly.
        given=replace(given) if isinstance(given, ChainState) else given,
        initial=_started(model, given, begun),
        settings=settings,
        status=status.name.lower(),
        begin_time=begun.time,
        end_time=runner.clock,
        initially_slipping=~begun.stuck,
        final=final,
        event_count=log.count,
        step_count=runner.kernel.steps,
        mean_distance=float(batch.mean()),
        mean_distance_error=float(batch.std(ddof=1) / math.sqrt(len(batch))),
        batch_mean_distance=batch,
        settling_time=settled,
        distance_rounding=rounding,
        time=np.asarray(runner.observer.distance_time),
        distance=measured["distance"],
        earlier_event_time=log.earlier_events.times(),
        earlier_event_block=earlier_events[:, 0].astype(np.int32),
        earlier_event_kind=earlier_events[:, 1].astype(np.int8),
        event_time=log.events.times(),
        event_block=events[:, 0].astype(np.int32),
        event_kind=events[:, 1].astype(np.int8),
        event_position=events[:, 2 : 2 + n] + offset,
        event_velocity=events[:, 2 + n :],
        crossing_time=measured["crossing_time"],
        crossing_velocity=measured["crossing"][:, 0],
        crossing_direction=measured["crossing"][:, 1].astype(np.int8),
        trajectory_time=np.asarray(runner.observer.trajectory_time),
        position=measured["position"] + offset,
        velocity=measured["velocity"],
        least_friction=least_friction[0],
        least_spring_force=least_force[0],
        window_least_friction=least_friction[1],
        window_least_spring_force=least_force[1],
        **lyapunov,
    )


def _started(model: Model, given: InitialState | ChainState, begun: ChainState) -> InitialState:
    """Return the numbers of the state from which a run started: the given state, if it has them."""
    if isinstance(given, ChainState):
        position, velocity = given.position + model.sliding_offset, given.velocity
        return StartedState(CONTINUED, tuple(position.tolist()), tuple(velocity.tolist()))
    position, velocity = model.initial_coordinates(given)
    numbers = tuple(position.tolist()), tuple(np.where(begun.stuck, 0.0, velocity).tolist())
    return given if numbers == (given.position, given.velocity) else StartedState(given.name, *numbers)


def _exponents(runner: Runner, settings: Settings, completed: bool) -> dict[str, Any]:
    """Return the Lyapunov exponents in descending order, their errors and batch values; NaN for those not computed.

    For chaos the standard error of the batches is appropriate; it falls as one over the square root of the window. In
    regular motion a perturbation may grow as a power of time. Linear growth after an alignment time A gains
    ln(1 + T/(1 + A)) in a window T, which in a run of this length cannot be distinguished from an exponent of this
    value divided by T. The error includes both.
    """
    count = settings.exponent_count(runner.model.chain)
    batch = np.full((settings.batches, count), np.nan)
    mean = np.full(count, np.nan)
    error = np.full(count, np.nan)
    infinite = -1
    reason = missing_derivative(runner) if count else ""
    if completed and count and not settings.has_fixed_step and not reason:
        measured = runner.exponents.results()
        growth, duration = measured["growth"], measured["duration"]
        filled = duration > 0.0
        batch[filled] = growth[filled] / duration[filled, None]
        if filled.any():
            infinite = measured["lost"]
            mean = growth.sum(axis=0) / duration.sum()
        if filled.all():
            finite = np.isfinite(mean)
            statistical = batch[:, finite].std(axis=0, ddof=1) / math.sqrt(settings.batches)
            alignment = min(settings.lyapunov_alignment, settings.transient)
            resolution = math.log1p(duration.sum() / (1.0 + alignment)) / duration.sum()
            error[finite] = np.hypot(statistical, resolution)
    # The vectors are in descending order of growth only within the errors.
    order = np.argsort(-mean, kind="stable")
    return {
        "lyapunov_exponent": mean[order],
        "lyapunov_error": error[order],
        "batch_lyapunov_exponent": batch[:, order],
        "lyapunov_infinite_count": infinite,
        "missing_derivative": reason,
    }
