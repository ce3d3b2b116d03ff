"""Ensembles: many trajectories of one model at once, several times faster than one by one."""

from __future__ import annotations

from burridge_knopoff.kernel.ensemble import Ensemble
from burridge_knopoff.model.model import Model
from burridge_knopoff.running.runner import EVENTS_PER_BLOCK_AND_UNIT, check_kernel


def new_ensemble(model: Model) -> Ensemble:
    """Return an ensemble that moves many trajectories of a model at once; one thread at a time may use it."""
    chain, law = model.chain, model.law
    check_kernel(chain)
    codes, constants = law.tape.table
    used = slice(law.tape.value)
    return Ensemble(
        diagonal=chain.diagonal,
        left=chain.before,
        right=chain.after,
        threshold=chain.thresholds,
        sliding_force=chain.thresholds * float(law(model.v)),
        v=model.v,
        symmetric=model.contact == "symmetric",
        **dict(zip(("code", "first", "second"), codes[used].T, strict=True)),
        **dict(zip(("alpha", "beta", "gamma"), constants[used].T, strict=True)),
        value=law.tape.value,
        rate_limit=EVENTS_PER_BLOCK_AND_UNIT * model.blocks,
    )
