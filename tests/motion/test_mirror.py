"""Mirror blocks of a state."""

import math

import numpy as np

from burridge_knopoff import ChainState
from burridge_knopoff.motion.mirror import pair_distances, symmetrized


def test_symmetrized_and_pair_distances():
    state = ChainState(np.array([1.0, 5.0, 4.0]), np.array([0.0, 1.0, 3.0]), np.array([True, False, False]))
    assert pair_distances(state).tolist() == [math.hypot(3.0, 3.0)]
    symmetric = symmetrized(state)
    assert symmetric.position.tolist() == [2.5, 5.0, 2.5]
    assert symmetric.velocity.tolist() == [0.0, 1.0, 0.0]
    assert symmetric.stuck.tolist() == [True, False, True]
