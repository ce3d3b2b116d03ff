"""Observables against a dense trajectory: section crossings, samples of J, extremes."""

import numpy as np
import pytest

from burridge_knopoff import InitialState, Model, simulate
from burridge_knopoff.running.runner import Runner, new_observer
from tests.flows import wave


def dense(law, a, initial, solver="series"):
    """Run to τ = 60 with a point of the trajectory every millisecond; the window begins at 10."""
    window = {"transient": 10.0, "window": 50.0, "batches": 2, "sampling": 0.5, "events": "all"}
    model = Model(law, a=a, blocks=len(initial.position) if isinstance(initial, InitialState) else 3)
    return simulate(model, initial, solver=solver, trajectory=60.0, trajectory_sampling=1e-3, **window)


def check_crossings(run):
    """Require a crossing of W = 0 between two points of the window exactly where W changes its sign; return its index.

    W is the sum of the positions relative to uniform sliding.
    """
    inside = run.trajectory_time >= 10.0
    time, w = run.trajectory_time[inside], (run.position - run.model.sliding_offset).sum(axis=1)[inside]
    change = np.nonzero(np.sign(w[1:]) * np.sign(w[:-1]) < 0)[0]
    assert len(change) == len(run.crossing_time) > 5
    assert np.all((time[change] <= run.crossing_time) & (run.crossing_time <= time[change + 1]))
    assert (run.crossing_direction == np.sign(w[change + 1])).all()
    return time, w, change


@pytest.mark.parametrize("blocks", [2, 4, 7, 8, 16])
def test_section_of_other_chains(law, blocks):
    """W follows the blocks in the lanes, and may be in the first lane of another vector."""
    run = dense(law, 0.2, wave(blocks))
    time, w, change = check_crossings(run)
    # By the secant, whose error is a second derivative times the interval squared over the slope.
    secant = time[change] - w[change] * 1e-3 / (w[change + 1] - w[change])
    assert np.abs(run.crossing_time - secant).max() < 1e-5


def test_a_crossing_between_two_pieces_counts_once():
    model = Model("linearized", a=0.1)
    generator = np.random.default_rng(1)

    def crossings(start, *cuts):
        runner = Runner(model, observer=new_observer(model, [0.0, 1.0]))
        runner.begin(start)
        for time in (*cuts, None):
            runner.run(time)
        return runner.observer.results()["crossing_time"]

    for _ in range(250):
        position = generator.uniform(-1.0, 1.0, 3)
        position += (model.sliding_offset - position).mean() - generator.uniform(0.0, 0.02)
        start = model.begin(InitialState("rising", tuple(position), tuple(generator.uniform(0.2, 0.4, 3))))
        (time,) = crossings(start)
        for cut in (np.nextafter(time, 0.0), time, np.nextafter(time, 1.0)):
            assert crossings(start, cut) == pytest.approx([time], abs=1e-12)


@pytest.fixture(
    scope="module",
    params=[
        ("linearized", 0.08, "plus", "map"),
        ("linearized", 0.25, "minus", "series"),
        ("nonlinear", 0.2, "plus", "series"),
    ],
)
def run(request):
    return dense(*request.param)


def test_velocity_at_section_crossings(run):
    check_crossings(run)
    rate = run.velocity.sum(axis=1) - 0.3
    assert (np.sign(run.crossing_velocity) == run.crossing_direction).all()
    assert np.allclose(run.crossing_velocity, np.interp(run.crossing_time, run.trajectory_time, rate), atol=1e-6)


def test_sampled_distance(run):
    distance = np.hypot(run.position[:, 2] - run.position[:, 0], run.velocity[:, 2] - run.velocity[:, 0])
    picked = np.round(run.time / 1e-3).astype(int)
    assert np.allclose(run.time, 0.5 * np.arange(121), atol=1e-12)
    assert np.allclose(run.distance, distance[picked], rtol=0, atol=1e-12)


def test_extremes(run):
    speed, a = run.velocity.max(), run.model.parameter("a")
    friction = 1.0 - a * speed if run.model.law.name == "linearized" else 1.0 / (1.0 + a * speed)
    assert friction - 1e-6 < run.least_friction <= friction + 1e-12
    force = run.position @ np.array([[-2.0, 1.0, 0.0], [1.0, -4.0, 1.0], [0.0, 1.0, -2.0]])
    stuck = run.velocity == 0.0
    inside = stuck & (run.trajectory_time >= 10.0)[:, None]
    for least, sampled in ((run.least_spring_force, force[stuck]), (run.window_least_spring_force, force[inside])):
        assert sampled.min() - 1e-3 < least <= sampled.min() + 1e-12
