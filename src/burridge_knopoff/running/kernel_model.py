"""Conversion of a model to the form that the kernel reads."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from burridge_knopoff.kernel._core import KernelModel
from burridge_knopoff.laws.law import MAX_SPEED, Law
from burridge_knopoff.model.model import Model

# A weaker spring to the driver moves a block that creeps less than rounding does.
UNPULLED = 1e-9

# Rounding of forces, relative to thresholds and springs, and a slow slip, relative to the speed of slips.
ROUNDING, SLOW = 1e-13, 1e-6

# Damping that is below critical by no more than this share is critical within rounding.
CRITICAL = 1e-14


def kernel_model(model: Model, loading: str = "steady") -> KernelModel:
    """Return the chain, friction law and driver of a model for the kernel; loading : see `Runner`."""
    chain, law = model.chain, model.law
    operations, constants = law.tape.table
    start, index, strength, damping = chain.neighbours
    v = model.v if loading == "steady" else 0.0
    return KernelModel(
        diagonal=chain.diagonal,
        driving=np.ascontiguousarray(chain.driving),
        threshold=np.ascontiguousarray(chain.thresholds),
        weakening=np.ascontiguousarray(chain.weakenings),
        sliding_force=chain.thresholds * model.sliding_friction,
        mass=np.ascontiguousarray(chain.masses),
        start=start,
        neighbour=index,
        strength=strength,
        damping=damping,
        damping_diagonal=chain.damping_diagonal,
        damping_load=chain.driver_damping * v,
        operations=np.ascontiguousarray(operations, np.int64),
        constants=np.ascontiguousarray(constants, float),
        value=law.tape.value,
        slope=law.tape.slope,
        linear=law.is_linear,
        rate=-law.initial_slope,
        steepest_at_rest=_is_steepest_at_rest(law, *chain.weakening_range),
        v=v,
        symmetric=model.contact == "symmetric",
        creep_speed=creep_speed(model, loading),
        rest_speed=rest_speed(model) if loading == "quasistatic" else 0.0,
    )


@lru_cache(maxsize=256)
def _is_steepest_at_rest(law: Law, least: float, largest: float) -> bool:
    """Return whether no slope of a law between these factors of the largest speed is steeper than that at rest."""
    return law.is_linear or law.steepest_slope(MAX_SPEED * least, MAX_SPEED * largest) <= abs(law.initial_slope)


def creep_speed(model: Model, loading: str) -> float:
    """Return the speed of rounding: a slip that can creep stops below minus this; 0 if no slip of the model can creep.

    A driver that moves pulls blocks that creep, but for those without a spring to it. The speed of those tends to 0, as
    that of all blocks behind a driver at rest does, and must not fall below 0 by rounding of forces. Below critical
    damping it may: there the block stops.
    """
    chain = model.chain
    if not _can_creep(model) or (loading == "steady" and not _has_unpulled_creep(model)):
        return 0.0
    return ROUNDING * float((np.maximum(chain.thresholds, chain.diagonal) / _resistance(model)).min())


def rest_speed(model: Model) -> float:
    """Return the speed below which a slip behind a driver at rest is slow; 0 if no slip of the model can creep.

    It is a small fraction of the slowest speed at which a block slips after the drop of friction at its start.
    """
    if not _can_creep(model):
        return 0.0
    drop = model.chain.thresholds * (1.0 - float(model.law(0.0)))
    return max(SLOW * float((drop / _resistance(model)).min()), 10.0 * creep_speed(model, "quasistatic"))


def _can_creep(model: Model) -> bool:
    return model.chain.is_damped or bool((model.chain.weakenings * model.law.initial_slope > 0.0).any())


def _has_unpulled_creep(model: Model) -> bool:
    """Return whether blocks without a spring to the driver can creep; if two of them are neighbours, they may."""
    chain = model.chain
    unpulled = chain.driving <= UNPULLED
    start, index, _, _ = chain.neighbours
    if (np.repeat(unpulled, np.diff(start)) & unpulled[index]).any():
        return True
    damping = chain.damping_diagonal + chain.thresholds * (chain.weakenings * model.law.initial_slope)
    critical = 2.0 * np.sqrt(chain.diagonal * chain.masses)
    return bool((unpulled & (damping >= (1.0 - CRITICAL) * critical)).any())


def _resistance(model: Model) -> np.ndarray:
    """Return the force per speed that slows each block at most, by its springs or by damping."""
    chain = model.chain
    damping = chain.damping_diagonal + chain.thresholds * np.maximum(chain.weakenings * model.law.initial_slope, 0.0)
    return np.maximum(np.sqrt(chain.diagonal * chain.masses), damping)
