"""One run of a chain: from chain, friction law and initial state to a trajectory with a readable status."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from burridge_knopoff.chain import Chain
from burridge_knopoff.friction import Friction
from burridge_knopoff.initial import InitialState, initial_state
from burridge_knopoff.kernel.event_driven import EventDriven
from burridge_knopoff.kernel.events import EventLog
from burridge_knopoff.kernel.exponents import Exponents
from burridge_knopoff.kernel.observe import Observer
from burridge_knopoff.kernel.state import State
from burridge_knopoff.kernel.time_stepping import TimeStepping
from burridge_knopoff.settings import Settings

if TYPE_CHECKING:
    import xarray

DEFAULT_SOLVER = {"linearized": "map", "nonlinear": "series"}
RUNNING = -1
STATUS = ("completed", "step_limit", "accumulating_events", "diverged")

# Terms of the Taylor series: enough for a piece of about one time unit, the usual gap between two events.
SERIES_ORDER = 24
RK4_ORDER = 3

# Real sequences stay far below: a block needs at least about a time unit for a slip.
EVENTS_PER_BLOCK_AND_UNIT = 1000
STEP_LIMIT = 10**10


@dataclass(frozen=True, eq=False)
class Trajectory:
    """What a run left: settings, status, and the observables; arrays are named as in the point files.

    Positions are U − vτ (relative to the driver) and velocities are U', as in the paper's figures.
    """

    chain: Chain
    friction: Friction
    initial: InitialState
    settings: Settings
    status: str
    end_time: float
    event_count: int
    step_count: int
    mean_distance: float
    mean_distance_error: float
    batch_mean_distance: np.ndarray = field(repr=False)
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
    least_friction: float = math.nan
    least_spring_force: float = math.nan
    window_least_friction: float = math.nan
    window_least_spring_force: float = math.nan
    lyapunov_exponent: np.ndarray = field(default_factory=lambda: np.zeros(0), repr=False)
    lyapunov_error: np.ndarray = field(default_factory=lambda: np.zeros(0), repr=False)
    batch_lyapunov_exponent: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)), repr=False)
    lyapunov_infinite_count: int = -1

    def to_dataset(self) -> xarray.Dataset:
        """Return the run as an xarray Dataset, the same as its point file."""
        from burridge_knopoff.dataset.point import to_dataset

        return to_dataset(self)


def simulate(
    law: str = "linearized",
    a: float = 0.08,
    initial: str | InitialState = "minus",
    *,
    chain: Chain | None = None,
    **settings: Any,
) -> Trajectory:
    """Run one simulation and return its trajectory.

    law : linearized or nonlinear; a : friction parameter, 0 ≤ a < 2
    initial : minus or plus (the paper's, three blocks) or an InitialState; the chain follows from its length
    settings : see Settings

    Raises ValueError, one line, for anything that the model or the solver does not allow.
    """
    state = initial_state(initial) if isinstance(initial, str) else initial
    chain = Chain(len(state.position)) if chain is None else chain
    known = {item.name for item in fields(Settings)}
    for key in settings:
        if key not in known:
            raise ValueError(f"{key}: not a setting: {' | '.join(sorted(known))}")
    return run(chain, Friction(law, a), state, Settings(**settings))


def run(
    chain: Chain, friction: Friction, initial: InitialState, settings: Settings, stuck: np.ndarray | None = None
) -> Trajectory:
    """Run one simulation of a chain; see `simulate`.

    stuck : which blocks stick at τ = 0, shape (blocks,), for a state in the middle of a motion; without it the
        convention `start` decides
    """
    if len(initial.position) != chain.blocks:
        raise ValueError(
            f"blocks: {chain.blocks} is not allowed for initial state {initial.name!r}, "
            f"which has {len(initial.position)} positions"
        )
    initial.check_contact(settings.contact)
    solver = settings.solver or DEFAULT_SOLVER[friction.law]
    if solver == "map" and friction.law == "nonlinear":
        raise ValueError("solver: 'map' is not allowed for law nonlinear: it has no closed form; series | rk4")
    settings.check_blocks(chain.blocks)
    if stuck is None:
        stuck = starts_stuck(chain, np.array(initial.position), settings.start)
    solution = _prepare(chain, friction, initial, settings, solver, stuck)
    # Each call makes a limited number of steps, so that a long run can be interrupted from the keyboard.
    while (code := solution.run()) == RUNNING:
        pass
    status = STATUS[code]
    return _collect(chain, friction, initial, settings, solution, status)


def new_state(chain: Chain, friction: Friction, v: float, contact: str) -> State:
    """Return the kernel's state of a chain under a friction law, with nothing in it yet."""
    return State(
        2.0 * chain.driving, friction.a, v, float(friction(v)), friction.law == "nonlinear", contact == "symmetric"
    )


def starts_stuck(chain: Chain, position: np.ndarray, start: str) -> np.ndarray:
    """Return which blocks stick at τ = 0 under the convention of start, shape of the positions U(0), (…, blocks)."""
    # Spring forces from U itself: in co-moving coordinates rounding could move a block across its threshold.
    pull = np.zeros_like(position)
    pull[..., 1:] += position[..., :-1]
    pull[..., :-1] += position[..., 1:]
    return (start == "tested") & (pull - 2.0 * chain.driving * position <= 1.0)


def _prepare(
    chain: Chain, friction: Friction, initial: InitialState, settings: Settings, solver: str, stuck: np.ndarray
) -> EventDriven | TimeStepping:
    state = new_state(chain, friction, settings.v, settings.contact)
    offset = chain.sliding_offset(float(friction(settings.v)))
    state.begin(np.array(initial.position) - offset, np.array(initial.velocity), stuck)
    duration = settings.duration
    edge = settings.transient + settings.window * np.arange(settings.batches + 1) / settings.batches
    edge[-1] = duration
    distance_time = settings.sampling * np.arange(math.floor(duration / settings.sampling + 1e-9) + 1)
    trajectory = min(settings.trajectory, duration)
    count = math.floor(trajectory / settings.trajectory_sampling + 1e-9)
    trajectory_time = duration - settings.trajectory_sampling * np.arange(count, -1, -1)
    order = RK4_ORDER if solver == "rk4" else SERIES_ORDER
    observer = Observer(
        chain.blocks,
        order,
        edge,
        np.minimum(distance_time, duration),
        trajectory_time,
    )
    log = EventLog(
        chain.blocks,
        0.0 if settings.events == "all" else duration - min(settings.event_window, settings.window),
        settings.events != "none",
        EVENTS_PER_BLOCK_AND_UNIT * chain.blocks,
    )
    if solver == "rk4":
        return TimeStepping(state, log, observer, settings.step)
    exponents = Exponents(
        chain.blocks,
        settings.lyapunov_exponents,
        order,
        max(0.0, settings.transient - settings.lyapunov_alignment),
        edge,
    )
    return EventDriven(state, log, observer, exponents, order, solver == "map", STEP_LIMIT)


def _collect(
    chain: Chain,
    friction: Friction,
    initial: InitialState,
    settings: Settings,
    solution: EventDriven | TimeStepping,
    status: str,
) -> Trajectory:
    measured = solution.observer.results()
    n = chain.blocks
    offset = chain.sliding_offset(float(friction(settings.v)))
    events = solution.log.events.values()
    earlier_events = solution.log.earlier_events.values()
    batch = measured["batch_integral"] * (settings.batches / settings.window)
    completed = status == "completed"
    if not completed:
        batch[:] = math.nan
    lyapunov = _exponents(solution, settings, completed)
    speed = measured["highest_speed"]
    force = measured["lowest_force"]
    least_friction = [float(friction(value)) if value > -1e299 else math.nan for value in (speed.max(), speed[1])]
    least_force = [float(value) if value < 1e299 else math.nan for value in (force.min(), force[1])]
    return Trajectory(
        chain=chain,
        friction=friction,
        initial=initial,
        settings=settings,
        status=status,
        end_time=solution.clock,
        event_count=solution.log.count,
        step_count=solution.steps,
        mean_distance=float(batch.mean()),
        mean_distance_error=float(batch.std(ddof=1) / math.sqrt(len(batch))),
        batch_mean_distance=batch,
        time=np.asarray(solution.observer.distance_time),
        distance=measured["distance"],
        earlier_event_time=solution.log.earlier_events.times(),
        earlier_event_block=earlier_events[:, 0].astype(np.int16),
        earlier_event_kind=earlier_events[:, 1].astype(np.int8),
        event_time=solution.log.events.times(),
        event_block=events[:, 0].astype(np.int16),
        event_kind=events[:, 1].astype(np.int8),
        event_position=events[:, 2 : 2 + n] + offset,
        event_velocity=events[:, 2 + n :],
        crossing_time=measured["crossing_time"],
        crossing_velocity=measured["crossing"][:, 0],
        crossing_direction=measured["crossing"][:, 1].astype(np.int8),
        trajectory_time=np.asarray(solution.observer.trajectory_time),
        position=measured["position"] + offset,
        velocity=measured["velocity"],
        least_friction=least_friction[0],
        least_spring_force=least_force[0],
        window_least_friction=least_friction[1],
        window_least_spring_force=least_force[1],
        **lyapunov,
    )


def _exponents(solution: EventDriven | TimeStepping, settings: Settings, completed: bool) -> dict[str, Any]:
    """Return the Lyapunov exponents, their errors and their batch values; NaN where there are none.

    The standard error of the batches, which falls like the root of the window, is right for chaos. In regular motion
    perturbations may grow like a power of time: from an alignment A through a window T one that grows linearly gains
    ln(1 + T/(1 + A)), which no run of that length can tell from an exponent of that over T. Both go into the error.
    """
    count = settings.lyapunov_exponents
    batch = np.full((settings.batches, count), np.nan)
    mean = np.full(count, np.nan)
    error = np.full(count, np.nan)
    infinite = -1
    if completed and count and isinstance(solution, EventDriven):
        measured = solution.exponents.results()
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
    return {
        "lyapunov_exponent": mean,
        "lyapunov_error": error,
        "batch_lyapunov_exponent": batch,
        "lyapunov_infinite_count": infinite,
    }
