"""Where the flow of a chain has no derivative: where several blocks stop or start at one instant.

The kernel maps perturbations in one order of these changes, and reports the blocks whose order matters
(`kernel/exponents.h`).
"""

from __future__ import annotations

import numpy as np

from burridge_knopoff.model.model import ChainState
from burridge_knopoff.running.runner import Runner

# Largest relative difference of mirror blocks that counts as rounding.
MIRROR_ROUNDING = 1e-9


def missing_derivative(runner: Runner, *, mirror_symmetric: bool | None = None) -> str:
    """Return why the perturbations of a run have no common linear map, in words; empty if they have one.

    mirror_symmetric : whether the motion is its own mirror image; by default judged by the present state. If so, the
        order of two mirror blocks does not matter for the growth of perturbations. Exchanging the two reflects the
        linear map. Both maps therefore agree on mirror-symmetric perturbations, and lead from antisymmetric ones to
        the same antisymmetric ones

    Reference: S. A. Burden, S. S. Sastry, D. E. Koditschek and S. Revzen, SIAM J. Appl. Dyn. Syst. 15 (2016) 1227.
    """
    exponents, chain = runner.exponents, runner.model.chain
    if mirror_symmetric is None:
        mirror_symmetric = chain.is_mirror_symmetric and _is_mirror_symmetric(runner.state())
    if exponents.tied[0] >= 0:
        return f"{_pair(exponents.tied)} start together under quasi-static loading"
    pairs = [exponents.unordered] if mirror_symmetric else [exponents.unordered, exponents.unordered_mirrors]
    for pair in pairs:
        if pair[0] >= 0:
            return f"{_pair(pair)}, joined by a dashpot, change at one instant where friction drops at a start"
    return ""


def _pair(blocks: tuple[int, int]) -> str:
    return f"blocks {blocks[0] + 1} and {blocks[1] + 1}"


def _is_mirror_symmetric(state: ChainState) -> bool:
    return all(
        bool(np.abs(values - values[::-1]).max() <= MIRROR_ROUNDING * np.abs(values).max())
        for values in (state.position, state.velocity)
    )
