"""Steady and quasi-static loading of a chain by the driver."""

from __future__ import annotations

from burridge_knopoff.model.model import LOADINGS, Model
from burridge_knopoff.model.ranges import OneOf


def is_quasistatic(loading: str, model: Model, solver: str) -> bool:
    """Return whether loading is quasi-static.

    Raises ValueError, one line, if it is neither of LOADINGS, or if model or solver do not allow it.
    """
    if OneOf(LOADINGS).form(loading, "loading") == "steady":
        return False
    if float(model.law(0.0)) >= 1.0:
        raise ValueError(
            f"loading: got 'quasistatic', expected steady: friction of the law {model.law.name} does not drop at the "
            "start of a slip, so a block at its threshold would never move"
        )
    if solver != "series":
        raise ValueError(f"loading: got 'quasistatic', expected steady with the solver {solver}; series allows both")
    return True
