"""Mirror blocks of a state: their distances, and the nearest mirror-symmetric state."""

from __future__ import annotations

import numpy as np

from burridge_knopoff.model.model import ChainState


def pair_distances(state: ChainState) -> np.ndarray:
    """Return the distances J_i of mirror blocks, from the ends to the middle, shape (blocks // 2,)."""
    pairs = len(state.position) // 2
    apart = [(values - values[::-1])[:pairs] for values in (state.position, state.velocity)]
    return np.hypot(*apart)


def symmetrized(state: ChainState) -> ChainState:
    """Return the nearest mirror-symmetric state; a block sticks if it or its mirror block sticks."""
    stuck = state.stuck | state.stuck[::-1]
    velocity = 0.5 * (state.velocity + state.velocity[::-1])
    return ChainState(0.5 * (state.position + state.position[::-1]), np.where(stuck, 0.0, velocity), stuck)
