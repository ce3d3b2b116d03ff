"""The cost of a run, estimated before it starts. The cost of a long chain grows as the square of its length."""

from __future__ import annotations

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.running.settings import Settings

# Measured (docs/performance.md): events per block and time unit; CPU seconds per event and block of its group, without
# perturbations and for each perturbation; memory per block.
EVENTS, SECONDS, SECONDS_OF_PERTURBATION, BYTES = 0.2, 1.5e-7, 1e-7, 4500.0


def cost_of(model: Model, begun: ChainState, settings: Settings) -> tuple[float, float]:
    """Return estimates of the CPU seconds per time unit and of the memory in bytes of a run with the solver series.

    begun : state at the start. Without exponents the cost of an event is proportional to the number of blocks that slip
        together; the blocks that slip at the start are assumed to keep slipping together
    """
    exponents = settings.exponent_count(model.chain)
    together = model.blocks if exponents else int((~begun.stuck).sum())
    event = together * (SECONDS + exponents * SECONDS_OF_PERTURBATION)
    return EVENTS * model.blocks * event, BYTES * model.blocks
