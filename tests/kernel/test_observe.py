"""Observables against mpmath and against a dense trajectory that SciPy integrates."""

from itertools import pairwise

import numpy as np
import pytest
from mpmath import mp
from scipy.integrate import quad

from burridge_knopoff.kernel.distance import _gauss_legendre
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.running.simulation import simulate


def dense(law, a, initial, solver, end, interval=1e-3):
    """Run with a dense trajectory: times, x_3 − x_1 and so on from position and velocity."""
    return simulate(
        law,
        a,
        initial,
        solver=solver,
        transient=10.0,
        window=end - 10.0,
        batches=2,
        sampling=0.5,
        trajectory=end,
        trajectory_sampling=interval,
        events="all",
    )


@pytest.mark.parametrize(
    ("law", "solver", "a", "initial"),
    [
        ("linearized", "map", 0.08, "plus"),
        ("linearized", "series", 0.25, "minus"),
        ("nonlinear", "series", 0.2, "plus"),
    ],
)
class TestAgainstTheTrajectory:
    def test_section_crossings(self, law, solver, a, initial):
        run = dense(law, a, initial, solver, 60.0)
        from burridge_knopoff.laws import law_of
        from burridge_knopoff.model.chain import Chain

        offset = Chain(3).sliding_offset(float(law_of(law, a)(0.1)))
        w = (run.position - offset).sum(axis=1)
        rate = run.velocity.sum(axis=1) - 0.3
        inside = run.trajectory_time >= 10.0
        sign = np.sign(w[inside])
        change = np.nonzero(sign[1:] * sign[:-1] < 0)[0]
        time = run.trajectory_time[inside]
        assert len(change) == len(run.crossing_time) > 5
        assert np.all((time[change] <= run.crossing_time) & (run.crossing_time <= time[change + 1]))
        assert (run.crossing_direction == sign[change + 1]).all()
        assert (np.sign(run.crossing_velocity) == run.crossing_direction).all()
        expected = np.interp(run.crossing_time, time, rate[inside])
        assert np.allclose(run.crossing_velocity, expected, atol=1e-6)

    def test_sampled_distance(self, law, solver, a, initial):
        run = dense(law, a, initial, solver, 60.0)
        distance = np.hypot(run.position[:, 2] - run.position[:, 0], run.velocity[:, 2] - run.velocity[:, 0])
        picked = np.round(run.time / 1e-3).astype(int)
        assert np.allclose(run.time, 0.5 * np.arange(121), atol=1e-12)
        assert np.allclose(run.distance, distance[picked], rtol=0, atol=1e-12)

    def test_extremes(self, law, solver, a, initial):
        run = dense(law, a, initial, solver, 60.0)
        speed = run.velocity.max()
        friction = 1.0 - a * speed if law == "linearized" else 1.0 / (1.0 + a * speed)
        assert friction - 1e-6 < run.least_friction <= friction + 1e-12
        pull = np.stack(
            [
                run.position[:, 1] - 2 * run.position[:, 0],
                run.position[:, 0] - 4 * run.position[:, 1] + run.position[:, 2],
                run.position[:, 1] - 2 * run.position[:, 2],
            ],
            axis=1,
        )
        stuck = run.velocity == 0.0
        assert pull[stuck].min() - 1e-3 < run.least_spring_force <= pull[stuck].min() + 1e-12
        inside = stuck & (run.trajectory_time >= 10.0)[:, None]
        assert pull[inside].min() - 1e-3 < run.window_least_spring_force <= pull[inside].min() + 1e-12


@pytest.mark.parametrize("blocks", [2, 4, 7, 8, 16])
@pytest.mark.parametrize("law", ["linearized", "nonlinear"])
def test_section_of_other_chains(law, blocks):
    """W is looked for in a lane behind those of the blocks, which may be the first of a vector of its own."""
    position = tuple(-0.9 + 0.1 * np.sin(1.0 + 2.0 * np.arange(blocks)))
    state = InitialState("wave", position, (0.1,) * blocks)
    run = dense(law, 0.2, state, "series", 60.0)
    w = (run.position - run.model.sliding_offset).sum(axis=1)[run.trajectory_time >= 10.0]
    time = run.trajectory_time[run.trajectory_time >= 10.0]
    change = np.nonzero(np.sign(w[1:]) * np.sign(w[:-1]) < 0)[0]
    assert len(change) == len(run.crossing_time) > 5
    # By the secant, whose error is a second derivative times the interval squared over the slope.
    secant = time[change] - w[change] * 1e-3 / (w[change + 1] - w[change])
    assert np.abs(run.crossing_time - secant).max() < 1e-5


def test_mean_distance_to_rounding():
    """⟨J⟩ against the quadrature of the same run cut into its smooth pieces, each by adaptive Gauss-Kronrod."""
    run = simulate(
        "linearized",
        0.2,
        "plus",
        transient=0.0,
        window=40.0,
        batches=4,
        events="all",
        trajectory=0.0,
    )

    def distance(tau):
        state = simulate("linearized", 0.2, "plus", transient=0.0, window=tau, events="none", trajectory=0.0, batches=2)
        return float(
            np.hypot(state.position[-1, 2] - state.position[-1, 0], state.velocity[-1, 2] - state.velocity[-1, 0])
        )

    edges = np.unique(np.concatenate([[1e-3], run.event_time[run.event_time > 1e-3], [40.0]]))
    total = sum(quad(distance, low, high, epsabs=1e-13, epsrel=1e-12, limit=200)[0] for low, high in pairwise(edges))
    # The first millisecond, where the window would be shorter than allowed: J is smooth, two values suffice.
    total += 1e-3 * 0.5 * (run.distance[0] + distance(1e-3))
    assert run.mean_distance * 40.0 == pytest.approx(total, rel=1e-9)
    assert run.mean_distance == pytest.approx(run.batch_mean_distance.mean(), rel=1e-15)
    error = run.batch_mean_distance.std(ddof=1) / 2.0
    assert run.mean_distance_error == pytest.approx(error, rel=1e-14)


def test_mean_distance_has_a_closed_form_before_any_event():
    """Two blocks slip freely with d'' = a d' − 3 d: ⟨J⟩ by 30-digit quadrature of the closed form."""
    from burridge_knopoff.model.initial import InitialState

    a = 0.1
    sliding = -(1.0 - a * 0.1)
    state = InitialState("near", (sliding - 0.01, sliding + 0.02), (0.1, 0.13))
    run = simulate("linearized", a, state, transient=0.0, window=3.0, batches=3, events="all")
    assert run.event_count == 0
    with mp.workdps(30):
        d0 = mp.mpf(state.position[1]) - mp.mpf(state.position[0])
        r0 = mp.mpf(state.velocity[1]) - mp.mpf(state.velocity[0])
        half = mp.mpf(a) / 2
        omega = mp.sqrt(3 - half**2)

        def d(t):
            return mp.exp(half * t) * (d0 * mp.cos(omega * t) + (r0 - half * d0) / omega * mp.sin(omega * t))

        def rate(t):
            return mp.exp(half * t) * (r0 * mp.cos(omega * t) + (half * r0 - 3 * d0) / omega * mp.sin(omega * t))

        expected = mp.quad(lambda t: mp.sqrt(d(t) ** 2 + rate(t) ** 2), [0, 1, 2, 3]) / 3
    assert run.mean_distance == pytest.approx(float(expected), rel=3e-15)


def test_the_quadrature_rule_is_numpys():
    """Nodes and weights against NumPy's, and exactness for the highest degree that the rule integrates."""
    x, w, last, previous = (values.astype(float) for values in _gauss_legendre(16))
    node, weight = np.polynomial.legendre.leggauss(16)
    assert np.allclose(x, node, rtol=0, atol=3e-16)
    assert np.allclose(w, weight, rtol=0, atol=1e-15)
    assert abs((w * x**30).sum() - 2 / 31) < 1e-16
    basis = np.polynomial.legendre.legvander(x, 15)
    assert np.allclose(last, basis[:, 15], rtol=0, atol=1e-14)
    assert np.allclose(previous, basis[:, 14], rtol=0, atol=1e-14)
