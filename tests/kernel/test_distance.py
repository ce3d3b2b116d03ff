"""The mean distance ⟨J⟩ against quadrature and mpmath, and the quadrature rule itself."""

from itertools import pairwise

import numpy as np
import pytest
from mpmath import mp
from scipy.integrate import quad

from burridge_knopoff import InitialState, Model, simulate
from burridge_knopoff.kernel._core import quadrature


def test_mean_distance_is_exact_to_rounding():
    """⟨J⟩ against the quadrature of the same run cut into its smooth pieces, each by adaptive Gauss-Kronrod."""
    options = {"transient": 0.0, "trajectory": 0.0}
    run = simulate(Model("linearized", a=0.2), "plus", window=15.0, batches=5, events="all", **options)

    def distance(tau):
        state = simulate(Model("linearized", a=0.2), "plus", window=tau, batches=2, events="none", **options)
        return float(np.hypot(*(part[-1, 2] - part[-1, 0] for part in (state.position, state.velocity))))

    edges = np.unique(np.concatenate([[1e-3], run.event_time[run.event_time > 1e-3], [15.0]]))
    total = sum(quad(distance, low, high, epsabs=1e-13, epsrel=1e-12, limit=200)[0] for low, high in pairwise(edges))
    # The first millisecond, where the window would be shorter than allowed: J is smooth, two values suffice.
    total += 1e-3 * 0.5 * (run.distance[0] + distance(1e-3))
    assert run.mean_distance * 15.0 == pytest.approx(total, rel=1e-9)
    assert run.mean_distance == pytest.approx(run.batch_mean_distance.mean(), rel=1e-15)
    assert run.mean_distance_error == pytest.approx(run.batch_mean_distance.std(ddof=1) / 5.0**0.5, rel=1e-14)


def test_mean_distance_has_a_closed_form_before_any_event():
    """Two blocks slip freely with d'' = a d' − 3 d: ⟨J⟩ by 30-digit quadrature of the closed form."""
    a = 0.1
    sliding = -(1.0 - a * 0.1)
    state = InitialState("near", (sliding - 0.01, sliding + 0.02), (0.1, 0.13))
    run = simulate(Model("linearized", a=a, blocks=2), state, transient=0.0, window=3.0, batches=3, events="all")
    assert run.event_count == 0
    with mp.workdps(30):
        d0, r0 = (mp.mpf(last) - mp.mpf(first) for first, last in (state.position, state.velocity))
        half = mp.mpf(a) / 2
        omega = mp.sqrt(3 - half**2)

        def turning(t, first, second):
            return mp.exp(half * t) * (first * mp.cos(omega * t) + second / omega * mp.sin(omega * t))

        def distance(t):
            return mp.hypot(turning(t, d0, r0 - half * d0), turning(t, r0, half * r0 - 3 * d0))

        expected = mp.quad(distance, [0, 1, 2, 3]) / 3
    assert run.mean_distance == pytest.approx(float(expected), rel=3e-15)


def test_the_quadrature_rule_agrees_with_numpy():
    """It is exact for the highest degree that it integrates."""
    x, w = quadrature()
    w = 2.0 * w
    node, weight = np.polynomial.legendre.leggauss(16)
    assert np.allclose(x, node, rtol=0, atol=3e-16)
    assert np.allclose(w, weight, rtol=0, atol=1e-15)
    assert abs((w * x**30).sum() - 2 / 31) < 1e-16
