"""One run in one call."""

from __future__ import annotations

from typing import Unpack

from burridge_knopoff.laws import Law
from burridge_knopoff.library.coercion import GivenLaw, Initial, given_model, given_state, warn_of_cost
from burridge_knopoff.library.keyword_settings import RunSettings, settings_of, show_settings
from burridge_knopoff.library.run import Run
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run


@show_settings(Settings)
def simulate(
    law: Model | GivenLaw = "linearized",
    a: float | None = None,
    initial: Initial | ChainState = "minus",
    settings: Settings | None = None,
    *,
    chain: Chain | None = None,
    v: float | None = None,
    contact: str | None = None,
    **by_name: Unpack[RunSettings],
) -> Run:
    """Run one simulation.

    law, a : the name of a built-in law and the friction parameter (0.08 by default), a `Law` (with its own a), or
        {"formula": "1 - c*a*u", "c": 0.5}; or instead of both a `Model`, with its own chain, v and contact
    initial : minus (default) or plus (the paper's, three blocks), whose velocities and distances from uniform sliding
        are in proportion to v; an `InitialState`, {"position": …, "velocity": …} or (position, velocity): U(0) and
        U'(0), each of shape (blocks,), at any v; or a `ChainState`, such as `final` of another run: the run continues
        from there on the same clock
    settings : of the run; by_name : some or all of them by name (see `Settings`)
    chain : by default the paper's springs, with as many blocks as the initial state
    v, contact : see `Model`, which has the defaults

    All quantities are dimensionless: times in units of 1/ω, U = kX/F(0), as in the paper (Section II). Raises
    ValueError, one line, for anything that the model or the solver does not allow. Warns of a run of more than a minute
    whose step is set by stiff dashpots or springs. docs/model.md derives the equations
    and the solvers, and explains why no event can be missed.

    >>> from burridge_knopoff import simulate
    >>> run = simulate("linearized", 0.08, "plus", transient=100, window=100, batches=2)
    >>> run.status, run.event_count, round(run.mean_distance, 4)
    ('completed', 204, 0.1401)
    >>> own = {"position": [-0.9, -1.1], "velocity": [0.1, 0.1]}
    >>> simulate("nonlinear", 0.1, own, transient=0, window=50).model.blocks
    2
    >>> longer = simulate(run.model, initial=run.final, transient=0, window=100)
    >>> longer.begin_time, longer.end_time
    (200.0, 300.0)
    """
    if not isinstance(law, Model) and a is None:
        a = law.a if isinstance(law, Law) else 0.08
    state = initial if isinstance(initial, ChainState) else given_state(initial)
    blocks = state.position.size if isinstance(state, ChainState) else state.blocks
    model = given_model(law, a, blocks, chain, v, contact)
    chosen = settings_of(Settings, settings, by_name)
    warn_of_cost(model, state, chosen)
    return Run(**vars(run(model, state, chosen)))
