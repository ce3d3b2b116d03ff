"""The cost of a run, estimated before it starts. The cost of a long chain grows as the square of its length."""

from __future__ import annotations

from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.running.settings import Settings

# Measured (benchmarks/chains.py): events per block and time unit; CPU seconds per event and block of its group,
# without perturbations and for each perturbation; memory per block; CPU seconds per step of rk4 and block.
EVENTS, SECONDS, SECONDS_OF_PERTURBATION, BYTES, SECONDS_OF_STEP = 0.2, 1.5e-7, 1e-7, 4500.0, 6.5e-8
#: In a dense network: CPU seconds per event and block, and in addition for each spring of a block that slips; memory
#: per spring.
SECONDS_OF_DENSE, SECONDS_OF_PULL, BYTES_OF_SPRING = 2.5e-7, 1e-8, 250.0
#: Mean number of neighbours from which on the springs of a network decide what it costs.
DENSE = 8.0
#: Expansions per time unit and unit of the highest rate of a chain, each as expensive as an event: 0.1 to 0.6 in chains
#: of 1 to 40 blocks whose dashpots or springs are stiff.
EXPANSIONS = 0.2
#: Runs that take longer, in CPU seconds, are announced with their cost.
LONG = 60.0


def cost_of(model: Model, begun: ChainState, settings: Settings) -> tuple[float, float]:
    """Return estimates of the CPU seconds per time unit and of the memory in bytes of a run with the solver series.

    begun : state at the start. The cost of an event is proportional to the number of blocks that slip together; those
        that slip at the start are assumed to keep slipping together
    """
    together = int((~begun.stuck).sum())
    event = together * (SECONDS + settings.exponent_count(model.chain) * SECONDS_OF_PERTURBATION)
    memory = BYTES * model.blocks
    if is_dense(model.chain):
        entries = len(model.chain.neighbours.index)
        degree = entries / model.blocks
        # A group is the whole network, or the neighbours of a block and theirs.
        event += min(model.blocks, degree**2) * SECONDS_OF_DENSE + together * degree * SECONDS_OF_PULL
        memory += BYTES_OF_SPRING * 0.5 * entries
    return max(EVENTS * model.blocks, _expansions(model.chain)) * event, memory


def run_seconds(model: Model, begun: ChainState, settings: Settings) -> float:
    """Return an estimate of the CPU seconds of a run; begun : see `cost_of`."""
    if settings.has_fixed_step:
        return settings.duration / settings.step * model.blocks * SECONDS_OF_STEP
    return cost_of(model, begun, settings)[0] * settings.duration


def stiffness(chain: Chain) -> float:
    """Return how many times longer runs take because of the highest rate of a chain, at least 1."""
    return max(1.0, _expansions(chain) / (EVENTS * len(chain.driving)))


def is_stiff(chain: Chain) -> bool:
    """Return whether the highest rate of a chain, not its events, decides how long a run takes."""
    return stiffness(chain) > 10.0


def is_dense(chain: Chain) -> bool:
    """Return whether a network has so many springs that they decide what it costs."""
    return chain.is_network and len(chain.neighbours.index) > DENSE * chain.blocks


def _expansions(chain: Chain) -> float:
    return EXPANSIONS * chain.highest_rate


def cost_note(model: Model, begun: ChainState, settings: Settings) -> str:
    """Return the estimated cost of a run if its blocks keep slipping as at the start, and what sets it, in words.

    Empty for a run of less than a minute, and for one with a fixed step.
    """
    seconds, memory = cost_of(model, begun, settings)
    if settings.has_fixed_step or seconds * settings.duration <= LONG:
        return ""
    whole = f"{_time(seconds)} per time unit, {_time(seconds * settings.duration)} for the run if they keep slipping"
    dense = is_dense(model.chain)
    springs = f", {len(model.chain.neighbours.index) // 2} springs" if dense else ""
    blocks = f"{model.blocks} block{'s' * (model.blocks > 1)}{springs}: about {whole}"
    if dense or not is_stiff(model.chain):
        return f"{blocks}; {1e-9 * memory:.2g} GB in addition to the recorded events"
    rate, frequency = model.chain.highest_rate, model.chain.highest_frequency
    fastest = f"decay rate of the dashpots, {rate - frequency:.2g}" if rate > 2.0 * frequency else ""
    return f"{blocks}: the step is set by the highest {fastest or f'frequency of the springs, {frequency:.2g}'}"


def _time(seconds: float) -> str:
    for unit, name in ((86400.0, "days"), (3600.0, "h"), (60.0, "min")):
        if seconds >= 2.0 * unit:
            return f"{seconds / unit:.0f} {name}"
    return f"{seconds:.2g} s"
