"""The scope of the proofs: the paper's chain and its two laws."""

from __future__ import annotations

from burridge_knopoff.laws.linearized import Linearized
from burridge_knopoff.laws.nonlinear import Nonlinear
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.model import Model

#: The v of the proofs under the nonlinear law: that of the paper.
NONLINEAR_V = 0.1
#: Under the linearized law v only sets the scale. With symmetric contact, this is the largest v at which stuck blocks
#: resist the backward pull, as `summaries/proof.py` proves: their spring force differs from static friction by about v.
LARGEST_V = 1.0


def is_linearized(model: Model) -> bool:
    """Return whether the law of a model is the paper's linearized law."""
    return model.law.formula == Linearized.formula


def is_covered(model: Model) -> bool:
    """Return whether the proofs cover a model: its chain, law, v and contact; a does not matter."""
    springs = model.chain.is_equivalent_to(Chain(3))
    if is_linearized(model):
        return bool(springs and (model.contact == "one_sided" or model.v <= LARGEST_V))
    return bool(springs and model.law.formula == Nonlinear.formula and model.v == NONLINEAR_V)
