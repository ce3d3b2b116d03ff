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
    )
