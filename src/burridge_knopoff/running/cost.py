"""What a run costs, estimated before it starts: that of a long chain grows with the square of its blocks."""

from __future__ import annotations

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.running.settings import Settings

# Measured, see docs/performance.md: events of a block in a unit of time; CPU seconds of an event for each block of its
# group, without perturbations and for each of them; memory of a block.
EVENTS, SECONDS, SECONDS_OF_PERTURBATION, BYTES = 0.2, 1.5e-7, 1e-7, 4500.0


def cost_of(model: Model, begun: ChainState, settings: Settings) -> tuple[float, float]:
    """Return about how many CPU seconds a unit of time takes, and the memory in bytes, of a run by the solver series.

    begun : state at the start; without exponents only blocks that slip share the cost of an event, and those that slip
        at the start are taken to go on together
    """
    exponents = settings.exponent_count(model.chain)
    together = model.blocks if exponents else int((~begun.stuck).sum())
    event = together * (SECONDS + exponents * SECONDS_OF_PERTURBATION)
    return EVENTS * model.blocks * event, BYTES * model.blocks
