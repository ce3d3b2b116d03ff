"""One run in one call."""

from __future__ import annotations

from typing import Any

from burridge_knopoff.library.keyword_settings import settings_of, show_settings
from burridge_knopoff.library.run import Run
from burridge_knopoff.library.state_forms import Initial, state_in, warn_of_run
from burridge_knopoff.model.model import Model
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run
from burridge_knopoff.values import instance_of


@show_settings(Settings)
def simulate(model: Model, initial: Initial = "minus", settings: Settings | None = None, **by_name: Any) -> Run:
    """Run one simulation.

    initial : minus or plus (the paper's, three blocks), whose velocities and distances from uniform sliding are in
        proportion to v; an `InitialState`, {"position": …, "velocity": …} or (position, velocity): U(0) and U'(0), each
        of shape (blocks,), at any v; or a `ChainState` or a `Run`, meaning its `final`: the run continues from there on
        the same clock
    settings : of the run; by_name : some or all of them by name (see `Settings`)

    All quantities are dimensionless: times in units of 1/ω, U = kX/F(0), as in the paper (Section II). Raises
    ValueError, one line, for anything that the model or the solver does not allow. Warns of a run of more than a minute
    whose step is set by stiff dashpots or springs, and if it continues a run of another model: the positions relative
    to the driver, the velocities and the stuck blocks are kept. docs/model.md derives the equations and the solvers,
    and explains why no event is missed.

    >>> from burridge_knopoff import Model, simulate
    >>> model = Model("linearized", a=0.08)
    >>> run = simulate(model, "plus", transient=100, window=100, batches=2)
    >>> run.status, run.event_count, round(run.mean_distance, 4)
    ('completed', 204, 0.1401)
    >>> run = simulate(model, "plus")
    >>> run.kind.words, round(run.period, 4)
    ('periodic', 157.2451)
    >>> own = {"position": [-0.9, -1.1], "velocity": [0.1, 0.1]}
    >>> simulate(Model("stribeck", a=0.1, blocks=2), own, transient=0, window=50).status
    'completed'
    >>> longer = simulate(model, run, transient=0, window=100)
    >>> longer.begin_time, longer.end_time
    (10000.0, 10100.0)
    """
    state = state_in(instance_of(model, Model, "model"), initial)
    chosen = settings_of(Settings, settings, by_name)
    warn_of_run(model, state, chosen)
    return Run(**vars(run(model, state, chosen)))
