"""What the proofs are about: the paper's chain under its linearized law."""

from __future__ import annotations

import numpy as np

from burridge_knopoff.laws.linearized import Linearized
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.model import Model

#: The largest v for which stuck blocks hold under a symmetric contact as well, which `summaries/proof.py` shows.
LARGEST_V = 1.0


def is_covered(model: Model) -> bool:
    """Tell whether the proofs are about a model: its chain, law and contact; a does not matter.

    Under the linearized law v is only a scale. It matters under symmetric contact: the spring force on a stuck block,
    which on these orbits differs from the static friction by about v, must stay above −1.
    """
    chain, paper = model.chain, Chain(3)
    return bool(
        chain.blocks == 3
        and np.array_equal(chain.stiffness, paper.stiffness)
        and np.array_equal(chain.driving, paper.driving)
        and np.array_equal(chain.thresholds, paper.thresholds)
        and model.law.formula == Linearized.formula
        and (model.contact == "one_sided" or model.v <= LARGEST_V)
    )
