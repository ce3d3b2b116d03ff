"""The solvers of a run, and what each of them can do."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Solver:
    """What a solver needs and computes.

    order : order of convergence in the step, None for a solver that finds events to rounding and has no fixed step
    closed_form : whether it needs a closed form of the motion between events
    quasistatic : whether it takes quasi-static loading
    of_settings : whether it is one of `Settings`; the others serve catalogues of slip events only
    """

    order: int | None = None
    closed_form: bool = False
    quasistatic: bool = False
    of_settings: bool = True

    @property
    def has_fixed_step(self) -> bool:
        """Whether it advances by a fixed step; it then computes no Lyapunov exponents."""
        return self.order is not None


#: The solvers by name, the usual one first.
SOLVERS: Mapping[str, Solver] = {
    "series": Solver(quasistatic=True),
    "map": Solver(closed_form=True),
    "rk4": Solver(order=4),
    "euler": Solver(order=1, of_settings=False),
}
#: Names of the solvers of `Settings`.
RUN_SOLVERS = tuple(name for name, solver in SOLVERS.items() if solver.of_settings)
