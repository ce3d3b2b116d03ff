"""The flow on arcs under the friction law of a model."""

from __future__ import annotations

from flint import arb

from burridge_knopoff.laws.linearized import Linearized as LinearizedLaw
from burridge_knopoff.laws.nonlinear import Nonlinear as NonlinearLaw
from burridge_knopoff.model.model import Model
from burridge_knopoff.proof.arcs import Flow
from burridge_knopoff.proof.balls import ProofError, arithmetic
from burridge_knopoff.proof.closed import Linearized
from burridge_knopoff.proof.scope import is_linearized
from burridge_knopoff.proof.taylor import Nonlinear


def flow_of(model: Model) -> Flow:
    """Return the flow for the law of a model; raises ProofError if it is not one of the paper's laws.

    The driver velocity is taken to be the decimal number as written: 0.1, not the nearest double.
    """
    if is_linearized(model):
        return Linearized()
    if model.law.formula == NonlinearLaw.formula:
        with arithmetic():
            return Nonlinear(arb(repr(model.v)))
    raise ProofError(
        f"law {model.law.name}: got {model.law.formula!r}, expected {LinearizedLaw.formula} | {NonlinearLaw.formula}"
    )
