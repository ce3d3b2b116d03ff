"""A hand-made continuation with known summaries."""

import numpy as np

from burridge_knopoff import InitialState, Model, MotionKind, SearchSettings, Symmetry
from burridge_knopoff.attractors.lifetime import Lifetime
from burridge_knopoff.continuation.attractor_continuation import Continuation
from tests.motion.stand_in import stand_in

STATES = [InitialState("here", (0.0,) * 3, (0.1,) * 3), InitialState("back", (0.0,) * 3, (0.1, -0.1, 0.1))]
SETTINGS = SearchSettings(samples=9, fraction_width=0.33, time_limit=123.0, lifetime=500.0)


def continuation(law):
    """Return synchrony and a torus, then a mirror pair that the torus becomes, then nothing.

    One value is inserted between the first two values of the grid; only the torus was followed there.
    """
    torus = {
        "kind": MotionKind.QUASIPERIODIC,
        "section_period": 0,
        "stop_rate": np.array([0.1, 0.0, 0.3]),
        "slow": True,
    }
    first = [
        stand_in(Symmetry.SYMMETRIC, 0.14, 0, 0.5, mean_distance_error=1e-3, **torus),
        stand_in(Symmetry.SYNCHRONIZED, 0.0, 1, 0.0, kind=MotionKind.SYNCHRONIZED, close_returns=20, radius=0.02),
    ]
    between = [stand_in(Symmetry.SYMMETRIC, 0.145, 0, 0.5, **torus)]
    pair = {"kind": MotionKind.CHAOTIC, "exponent": np.array([0.03, 0.0])}
    second = [stand_in(Symmetry.ASYMMETRIC, 0.15, 1, -2.0, **pair), stand_in(Symmetry.ASYMMETRIC, 0.15, 0, 2.0, **pair)]
    numbers = [([1, 0], [0, 0]), ([1], [0]), ([1, 1], [-1, 1]), ([], [])]
    dying = Lifetime(4, 1200.0)
    return Continuation(
        [Model(law, a=a, v=0.2) for a in (0.05, 0.07, 0.1, 0.2)],
        [0, 2, 3],
        [first, between, second, []],
        lifetimes=[[None, None], [None], [dying, dying], []],
        branch=[np.array(branch) for branch, _ in numbers],
        side=[np.array(side) for _, side in numbers],
        upward=[np.array([1, -1]), np.array([-1, -1]), np.zeros(0, int)],
        downward=[np.array([-1, -1]), np.array([0, 0]), np.zeros(0, int)],
        samples=[np.array([0, 0, 1, -1]), np.array([1, 1, 1, 0]), np.full(4, -1)],
    )
