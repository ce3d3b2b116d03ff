"""The example studies with laws and springs of their own, held against SciPy, which shares nothing with the package."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run
from burridge_knopoff.study import load_study, read_config


def events(stiffness, driving, threshold, friction, v, position, end):
    """Return time, block (0 …) and kind (1 start, 0 stop) of all events of blocks that are at rest at τ = 0.

    friction : Φ(U') with Φ(0) < 1, so that a block leaves rest with an acceleration
    """
    n = len(position)
    state, stuck = np.concatenate([position, np.zeros(n)]), np.ones(n, dtype=bool)
    clock, found = 0.0, []
    force = lambda t, y: driving * v * t - stiffness @ y[:n]  # noqa: E731
    assert (force(0.0, state) < threshold).all()
    while True:

        def slope(t, y):
            acceleration = np.where(stuck, 0.0, force(t, y) - threshold * friction(y[n:]))
            return np.concatenate([np.where(stuck, 0.0, y[n:]), acceleration])

        def reached(i):
            function = (lambda t, y: force(t, y)[i] - threshold[i]) if stuck[i] else (lambda t, y: y[n + i])
            function.terminal, function.direction = True, 1 if stuck[i] else -1
            return function

        ended = solve_ivp(
            slope,
            (clock, end),
            state,
            "DOP853",
            rtol=1e-12,
            atol=1e-14,
            max_step=np.inf if stuck.all() else 0.05,
            events=[reached(i) for i in range(n)],
        )
        if ended.status == 0:
            return tuple(np.array(column) for column in zip(*found, strict=True))
        block = next(i for i in range(n) if len(ended.t_events[i]))
        clock, state = ended.t[-1], ended.y[:, -1].copy()
        found.append((clock, block, int(stuck[block])))
        stuck[block] = not stuck[block]
        state[n:][stuck] = 0.0
        state[n + block] = 0.0


def unequal(a):
    stiffness = np.array([[2.0, -1.0], [-1.0, 1.8]])
    return stiffness, np.array([1.0, 0.8]), np.array([1.0, 2.25]), lambda u: np.full_like(u, 1.0 / (1.0 + a))


def carlson_langer(a):
    stiffness = np.diag([10.0, *8 * [19.0], 10.0]) - 9.0 * (np.eye(10, k=1) + np.eye(10, k=-1))
    return stiffness, np.ones(10), np.ones(10), lambda u: 0.99 / (1.0 + a * u / 0.99)


@pytest.mark.parametrize(
    ("name", "model", "a", "end", "least", "tolerance"),
    [
        ("unequal_blocks", unequal, 0.1, 500.0, 60, 1e-8),
        ("unequal_blocks", unequal, 0.4, 500.0, 20, 1e-8),
        # Chaos: errors grow by a factor of e in about ten units of time.
        ("carlson_langer", carlson_langer, 2.0, 100.0, 40, 1e-6),
        ("carlson_langer", carlson_langer, 5.0, 150.0, 40, 1e-6),
    ],
)
def test_events_are_those_of_scipy(repository, name, model, a, end, least, tolerance):
    file = repository / "config" / "examples" / f"{name}.yaml"
    study = load_study(read_config(file), str(file))
    settings = Settings(start="tested", transient=0.0, window=end, events="all", lyapunov_exponents=0)
    state = study.state(study.initial[0])
    found = run(study.model(study.laws[0], a), state, settings)
    time, block, kind = events(*model(a), study.config["v"], np.array(state.position), end)
    assert len(time) >= least
    assert (found.event_block - 1).tolist() == block.tolist()
    assert found.event_kind.tolist() == kind.tolist()
    assert np.allclose(found.event_time, time, rtol=0, atol=tolerance)
