"""One run of a model: from an initial state to a trajectory with a readable status."""

from __future__ import annotations

import math
from dataclasses import fields
from typing import Any, overload

import numpy as np

from burridge_knopoff.kernel.exponents import Exponents
from burridge_knopoff.laws import Law, law_of
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.initial import InitialState, initial_state
from burridge_knopoff.model.model import Instant, Model
from burridge_knopoff.running.runner import RK4_ORDER, SERIES_ORDER, Runner, new_observer
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.trajectory import Trajectory, collect


@overload
def simulate(model: Model, initial: str | InitialState = ..., settings: Settings = ..., /) -> Trajectory: ...


@overload
def simulate(
    law: str | Law = ...,
    a: float = ...,
    initial: str | InitialState = ...,
    *,
    chain: Chain | None = ...,
    v: float = ...,
    contact: str = ...,
    **settings: Any,
) -> Trajectory: ...


def simulate(
    law: Any = "linearized",
    a: Any = None,
    initial: Any = None,
    *,
    chain: Chain | None = None,
    v: float = 0.1,
    contact: str = "one_sided",
    **settings: Any,
) -> Trajectory:
    """Run one simulation and return its trajectory: `simulate(model, initial, settings)`, or in short by numbers.

    law, a : a law and its friction parameter, 0.08 if none is given: the name of a law that is built in, or a `Law`
    initial : minus (if none is given) or plus (the paper's, three blocks) or an InitialState
    chain : without one the paper's springs, as many blocks as the initial state has
    v, contact : see Model; settings : those of Settings by name

    Raises ValueError, one line, for anything that the model or the solver does not allow.
    """
    if isinstance(law, Model):
        if settings or (chain, v, contact) != (None, 0.1, "one_sided"):
            raise ValueError("chain, v, contact, settings by name: not allowed beside a model, which takes a Settings")
        return run(law, _state(a), initial)
    state = _state(initial)
    known = {item.name for item in fields(Settings)}
    for key in settings:
        if key not in known:
            raise ValueError(f"{key}: not a setting: {' | '.join(sorted({*known, 'chain', 'contact', 'v'}))}")
    a = 0.08 if a is None else a
    law = law.at(a) if isinstance(law, Law) else law_of(law, a)
    return run(Model(chain or Chain(len(state.position)), law, v, contact), state, Settings(**settings))


def _state(initial: str | InitialState | None) -> InitialState:
    return initial if isinstance(initial, InitialState) else initial_state(initial or "minus")


def run(model: Model, initial: InitialState, settings: Settings | None = None, at: Instant | None = None) -> Trajectory:
    """Run one simulation of a model; see `simulate`.

    at : the state to begin from if it is one in the middle of a motion; without it that of the initial state
    """
    settings = Settings() if settings is None else settings
    settings.check_blocks(model.blocks)
    at = model.begin(initial, settings.start) if at is None else at
    runner = _prepare(model, settings)
    runner.begin(at)
    return collect(model, initial, settings, runner, runner.run())


def _prepare(model: Model, settings: Settings) -> Runner:
    """Return a solver that measures what the settings ask for."""
    duration = settings.duration
    edge = settings.transient + settings.window * np.arange(settings.batches + 1) / settings.batches
    edge[-1] = duration
    distance_time = settings.sampling * np.arange(math.floor(duration / settings.sampling + 1e-9) + 1)
    trajectory = min(settings.trajectory, duration)
    count = math.floor(trajectory / settings.trajectory_sampling + 1e-9)
    trajectory_time = duration - settings.trajectory_sampling * np.arange(count, -1, -1)
    order = RK4_ORDER if settings.solver == "rk4" else SERIES_ORDER
    exponents = Exponents(
        model.blocks,
        settings.lyapunov_exponents,
        order,
        max(0.0, settings.transient - settings.lyapunov_alignment),
        edge,
    )
    return Runner(
        model,
        settings.solver,
        step=settings.step,
        events_from=0.0 if settings.events == "all" else duration - min(settings.event_window, settings.window),
        keep_events=settings.events != "none",
        observer=new_observer(model, edge, np.minimum(distance_time, duration), trajectory_time, order),
        exponents=exponents,
    )
