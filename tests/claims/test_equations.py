"""The paper's Eqs. 1 and 2 are those of the model."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from burridge_knopoff import Chain, InitialState, Model
from burridge_knopoff.claims.equations import equation_difference
from burridge_knopoff.running.runner import Runner


@pytest.mark.parametrize("chain", [Chain(3, coupling=2.0), Chain(3, pulling=1.0), Chain(3, threshold=(1.0, 1.0, 1.1))])
def test_eq_1_is_that_of_the_papers_chain_only(chain: Chain) -> None:
    assert equation_difference(Chain(3), np.random.default_rng(1)) == 0
    assert equation_difference(chain, np.random.default_rng(1)) > 0


def test_eq_2_is_what_a_run_solves() -> None:
    """Eq. 1 is solved by SciPy with units, from a state in which all blocks slip."""
    mass, spring, friction, slope, speed = 3.0, 7.0, 5.0, 0.4, 0.6
    root = np.sqrt(spring * mass)
    a, v = slope * friction / root, speed * root / friction
    model = Model("nonlinear", a=a, v=v)
    start = InitialState("start", (-0.8, -0.65, -0.8), (1.1 * v, 0.9 * v, v))
    length, time = friction / spring, np.sqrt(mass / spring)
    springs = spring * np.array([[2.0, -1.0, 0.0], [-1.0, 4.0, -1.0], [0.0, -1.0, 2.0]])

    def motion(t: float, state: np.ndarray) -> np.ndarray:
        position, velocity = np.split(state, 2)
        pull = spring * np.array([1.0, 2.0, 1.0]) * speed * t - springs @ position
        return np.concatenate([velocity, (pull - friction / (1.0 + slope * velocity)) / mass])

    first = np.concatenate([length * np.array(start.position), length / time * np.array(start.velocity)])
    found = solve_ivp(motion, (0.0, time), first, "DOP853", rtol=1e-12, atol=1e-14).y[:, -1]
    assert (found[3:] > 0.0).all()
    end = Runner(model).state_after(model.begin(start), 1.0)
    assert end.velocity == pytest.approx(found[3:] * time / length, rel=1e-9)
    position = end.position + model.sliding_offset + v
    assert position == pytest.approx(found[:3] / length, rel=1e-9)
