"""Conversion of a model to the form that the kernel reads."""

from __future__ import annotations

import numpy as np

from burridge_knopoff.kernel._core import KernelModel
from burridge_knopoff.model.model import Model


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
        sliding_force=chain.thresholds * float(law(model.v)),
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
        creep_speed=0.0 if loading == "steady" else creep_speed(model),
    )


def creep_speed(model: Model) -> float:
    """Return the speed below which a slip creeps under quasi-static loading; 0 if no slip of the model can creep.

    It is a small fraction of the slowest speed at which a block slips after the drop of friction at its start, and far
    above the speeds that rounding of forces causes.
    """
    chain, slope = model.chain, float(model.law.slope(0.0))
    if not chain.is_damped and slope <= 0.0:
        return 0.0
    damping = chain.damping_diagonal + chain.thresholds * max(slope, 0.0)
    resistance = np.maximum(np.sqrt(chain.diagonal * chain.masses), damping)
    return 1e-6 * float((chain.thresholds * (1.0 - float(model.law(0.0))) / resistance).min())
