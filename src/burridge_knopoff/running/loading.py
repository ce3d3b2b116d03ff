"""Steady and quasi-static loading of a chain by the driver."""

from __future__ import annotations

from burridge_knopoff.model.model import LOADINGS, Model
from burridge_knopoff.model.ranges import OneOf
from burridge_knopoff.running.solvers import SOLVERS


def check_loading(loading: str, model: Model, solver: str) -> None:
    """Check that loading is one of LOADINGS, and that model and solver allow it; raises ValueError, one line."""
    if OneOf(LOADINGS).form(loading, "loading") == "steady":
        return
    if float(model.law(0.0)) >= 1.0:
        raise ValueError(
            f"loading: got 'quasistatic', expected steady: friction of the law {model.law.name} does not drop at the "
            "start of a slip, so a block at its threshold would never move"
        )
    if not SOLVERS[solver].quasistatic:
        allowed = " | ".join(name for name in SOLVERS if SOLVERS[name].quasistatic)
        raise ValueError(f"loading: got 'quasistatic', expected steady with the solver {solver}; {allowed} allows both")
