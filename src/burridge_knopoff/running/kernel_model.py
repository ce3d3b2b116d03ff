"""Conversion of a model to the form that the kernel reads."""

from __future__ import annotations

import numpy as np

from burridge_knopoff.kernel._core import KernelModel
from burridge_knopoff.model.model import Model

# A weaker spring to the driver moves a block that creeps less than rounding does.
UNPULLED = 1e-9


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
        rate=-float(law.slope(0.0)),
        steepest=law.steepest_slope,
        v=v,
        symmetric=model.contact == "symmetric",
        creep_speed=creep_speed(model, loading),
    )


def creep_speed(model: Model, loading: str) -> float:
    """Return the speed below which a slip that can creep does not stop; 0 if no slip of the model can creep.

    Behind a driver at rest it is a small fraction of the slowest speed at which a block slips after the drop of
    friction at its start. A driver that moves pulls blocks that creep, but for those without a spring to it: their
    speed tends to 0 as well, and must not fall below 0 by rounding of forces.
    """
    chain, slope = model.chain, float(model.law.slope(0.0))
    if not chain.is_damped and slope <= 0.0:
        return 0.0
    damping = chain.damping_diagonal + chain.thresholds * max(slope, 0.0)
    resistance = np.maximum(np.sqrt(chain.diagonal * chain.masses), damping)
    if loading == "quasistatic":
        return 1e-6 * float((chain.thresholds * (1.0 - float(model.law(0.0))) / resistance).min())
    if (chain.driving > UNPULLED).all():
        return 0.0
    return 1e-13 * float((np.maximum(chain.thresholds, chain.diagonal) / resistance).min())
