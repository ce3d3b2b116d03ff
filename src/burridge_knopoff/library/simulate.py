"""One run in one call."""

from __future__ import annotations

from typing import Any

from burridge_knopoff.library.keyword_settings import has_own_a, settings_of, show_settings, takes_model
from burridge_knopoff.library.model_forms import GivenLaw, model_and_settings
from burridge_knopoff.library.run import Run
from burridge_knopoff.library.state_forms import Initial, state_blocks, state_in, warn_of_run
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.model import Model
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run


@takes_model
@show_settings(Settings)
def simulate(
    law: Model | GivenLaw = "linearized",
    a: Any = None,
    initial: Initial = "minus",
    settings: Settings | None = None,
    *,
    chain: Chain | None = None,
    blocks: int | None = None,
    v: float | None = None,
    contact: str | None = None,
    **by_name: Any,
) -> Run:
    """Run one simulation.

    law, a : the name of a built-in law and the friction parameter (0.08 by default), a `Law` (with its own a), or
        {"formula": "1 - c*a*u", "c": 0.5}; or a `Model`, with its own a, chain, v and contact
    initial : minus (default) or plus (the paper's, three blocks), whose velocities and distances from uniform sliding
        are in proportion to v; an `InitialState`, {"position": …, "velocity": …} or (position, velocity): U(0) and
        U'(0), each of shape (blocks,), at any v; or a `ChainState` or a `Run`, meaning its `final`: the run continues
        from there on the same clock
    settings : of the run; by_name : some or all of them by name (see `Settings`), and parameters of the model (see
        `Model.at`), such as sigma of the law, coupling or `**{"mass[3]": 1.2}`
    chain : by default the paper's springs, with as many blocks as the initial state, or with this number of blocks
    v, contact : see `Model`, which has the defaults; at a parameter given by name a `Model` has another value of it

    All quantities are dimensionless: times in units of 1/ω, U = kX/F(0), as in the paper (Section II). Raises
    ValueError, one line, for anything that the model or the solver does not allow, and for a setting with the name of a
    parameter of the law. Warns of a run of more than a minute whose step is set by stiff dashpots or springs, and if it
    continues a run of another model: the positions relative to the driver, the velocities and the stuck blocks are
    kept. docs/model.md derives the equations and the solvers, and explains why no event is missed.

    >>> from burridge_knopoff import simulate
    >>> run = simulate("linearized", 0.08, "plus", transient=100, window=100, batches=2)
    >>> run.status, run.event_count, round(run.mean_distance, 4)
    ('completed', 204, 0.1401)
    >>> run = simulate("linearized", 0.08, "plus")
    >>> run.kind.words, round(run.period, 4)
    ('periodic', 157.2451)
    >>> own = {"position": [-0.9, -1.1], "velocity": [0.1, 0.1]}
    >>> simulate("stribeck", 0.1, own, sigma=0.05, coupling=1.5, transient=0, window=50).model.chain.coupling
    1.5
    >>> longer = simulate(run.model, initial=run, transient=0, window=100)
    >>> longer.begin_time, longer.end_time
    (10000.0, 10100.0)
    """
    if a is None and not has_own_a(law):
        a = 0.08
    model, named = model_and_settings(
        Settings, law, a, by_name, v=v, chain=chain, blocks=blocks, contact=contact, state_blocks=state_blocks(initial)
    )
    state = state_in(model, initial)
    chosen = settings_of(Settings, settings, named)
    warn_of_run(model, state, chosen)
    return Run(**vars(run(model, state, chosen)))
