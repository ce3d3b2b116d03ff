"""Settling times of J, the kinds of motion that follow from exponents and section points, and the stored points."""

import dataclasses

import numpy as np
import pytest

from burridge_knopoff import InitialState, Model, MotionKind, simulate
from burridge_knopoff.summaries import bifurcation_diagram
from tests.grids import PAPER_MODELS, grid_of
from tests.sections import MOTION
from tests.summaries.points import kinds, means, write_points

SHORT = {"transient": 50.0, "window": 50.0, "batches": 2}


def test_settling_times_of_runs(tmp_path):
    settings = {"transient": 1500.0, "window": 100.0, "batches": 2}
    run = simulate(Model("linearized", a=0.08), "minus", **settings)
    grid = grid_of(tmp_path, ["minus"], {"0.0800": 0.08}, **settings)
    ended = {"linearized": "completed", "nonlinear": "step_limit"}
    write_points(*grid, lambda trajectory: dataclasses.replace(trajectory, status=ended[trajectory.model.law.name]))
    times = means(*grid)["settling_time"]
    # Near synchrony J decays like the transverse multiplier to the power of the number of periods.
    settled = times.sel(law="linearized", initial="minus", a=0.08)
    np.testing.assert_array_equal(settled.values, run.settling_time)
    assert settled.sel(level=1e-6).item() == pytest.approx(1064.848, abs=1e-3)
    assert settled.sel(level=1e-2) <= settled.sel(level=1e-3) < settled.sel(level=1e-6)
    assert np.isnan(times.sel(law="linearized", level=1e-12))


def test_the_least_friction_in_the_window_is_not_that_of_the_transient(tmp_path):
    """From plus, the first slips are eight times as fast as those on the attractor."""
    grid = grid_of(tmp_path, ["plus"], {"0.0800": 0.08}, transient=500.0, window=100.0, batches=2)
    write_points(*grid)
    dataset = means(*grid).sel(initial="plus", a=0.08)
    for law in ("linearized", "nonlinear"):
        whole, window = (dataset[name].sel(law=law).item() for name in ("least_friction", "window_least_friction"))
        assert whole < 0.9 < 0.97 < window < 1.0


def test_slips_of_the_linearized_law_are_a_multiple_of_the_driver_at_one_a():
    """With stiffer springs at fixed V, a decreases and v increases: aU' is av times a function of a alone."""
    speeds = []
    for v in (0.1, 0.02):
        model = Model("linearized", a=0.08, v=v)
        offset, size = model.sliding_offset, v / 0.1
        state = {"position": tuple(offset + size * np.array([-0.02, 0.03, -0.01])), "velocity": (v, v, v)}
        run = simulate(model, initial=InitialState("near", **state), transient=1500.0, window=200.0, batches=2)
        speeds.append((1.0 - run.window_least_friction) / (0.08 * v))
    assert speeds[1] == pytest.approx(speeds[0], rel=1e-9)
    assert 2.0 < speeds[0] < 2.5


def with_section(trajectory, velocity, direction, **values):
    section = {"velocity": velocity, "direction": direction, "time": np.arange(len(velocity), dtype=float)}
    values["batch_mean_distance"] = np.full_like(trajectory.batch_mean_distance, values["mean_distance"])
    # A start in one and the same state follows each crossing.
    states, ones = np.zeros((len(velocity), trajectory.model.blocks)), np.ones(len(velocity), np.int8)
    events = {"time": section["time"] + 0.25, "block": ones, "kind": ones, "position": states, "velocity": states}
    values |= {f"event_{key}": item for key, item in events.items()}
    return dataclasses.replace(trajectory, **{f"crossing_{key}": item for key, item in section.items()}, **values)


def same_section(trajectory, **values):
    """Return a run with twenty upward section points at one velocity, as on a periodic orbit."""
    return with_section(trajectory, np.full(20, 0.1), np.ones(20, np.int8), **values)


@pytest.mark.parametrize(("thresholds", "synchronized"), [([1.0, 1.1, 1.0], 1), ([1.0, 1.0, 1.1], 0)])
def test_only_a_chain_that_is_its_own_mirror_image_synchronizes(tmp_path, thresholds, synchronized):
    """This holds whatever J is: here the runs have been given the J of synchrony."""
    models = {"laws": {"linearized": {}}, "chain": {**PAPER_MODELS["chain"], "threshold": thresholds}}
    grid = grid_of(tmp_path, ["minus"], {"0.0800": 0.08}, models, **SHORT)
    values = {"mean_distance": 1e-9, "lyapunov_exponent": np.array([0.0, -0.1, -0.2])}
    write_points(*grid, lambda trajectory: same_section(trajectory, **values))
    answers = means(*grid)["synchronized"]
    assert answers.values.ravel().tolist() == [synchronized]
    assert ("not defined" in answers.attrs["comment"]) == (not synchronized)
    kind = kinds(*grid, MOTION)["run_kind"]
    assert kind.item() == (MotionKind.SYNCHRONIZED if synchronized else MotionKind.PERIODIC)


#: {a: exponents, upward section points, status of a run, and the resulting kind, zero exponents and period}.
ORBIT = np.random.default_rng(1).random(150)
GOLDEN = np.cos(np.pi * (np.sqrt(5) - 1) * np.arange(1200))
RUNS = {
    0.1: ((0.0, -0.1, -0.2), np.tile([0.1, 0.3], 10), "completed", MotionKind.PERIODIC, 1, 2),
    0.2: ((1e-4, -1e-4, -0.2), GOLDEN, "completed", MotionKind.QUASIPERIODIC, 2, 0),
    # A long period of section points, though the exponents look like those of a torus.
    0.3: ((1e-4, -1e-4, -0.2), np.tile(ORBIT, 8), "completed", MotionKind.PERIODIC, 2, 150),
    0.4: ((0.02, 0.0, -0.3), ORBIT, "completed", MotionKind.CHAOTIC, 1, 0),
    0.5: ((0.0, -0.1, -0.2), np.tile([0.1, 0.3], 10), "step_limit", MotionKind.UNDETERMINED, 1, 0),
}


@pytest.fixture
def points(tmp_path):
    """Points whose section points are alternately upward and downward, the latter at −1, −2, …"""

    def alter(trajectory):
        exponent, upward, status, *_ = RUNS[trajectory.model.parameter("a")]
        section = np.stack([upward, -1.0 - np.arange(len(upward))], axis=1).ravel()
        averages = {"status": status, "mean_distance": trajectory.model.parameter("a")}
        averages |= {"lyapunov_exponent": np.array(exponent), "lyapunov_error": np.full(3, 1e-5)}
        return with_section(trajectory, section, np.tile(np.array([1, -1], np.int8), len(upward)), **averages)

    grid = grid_of(tmp_path, ["minus", "plus"], {f"{a:.4f}": a for a in RUNS}, **SHORT)
    return write_points(*grid, alter)


def test_kinds_of_motion_of_runs(points):
    dataset = kinds(*points, MOTION)
    assert (dataset.attrs["synchronization_threshold"], dataset.attrs["longest_period"]) == (1e-6, 2000.0)
    for point in (dataset.sel(law=law, initial=state) for law in dataset["law"].values for state in ("minus", "plus")):
        expected = list(zip(*RUNS.values(), strict=True))
        assert point["lyapunov_exponent"].values.tolist() == [list(exponent) for exponent in expected[0]]
        assert (point["lyapunov_error"] == 1e-5).all()
        names = ("run_kind", "zero_exponent_count", "section_period")
        assert tuple(tuple(point[name].values.tolist()) for name in names) == tuple(expected[3:])
        assert point["mean_distance"].values.tolist() == list(RUNS)
        assert point["status"].values.tolist() == [0, 0, 0, 0, 1]


def test_section_points_are_kept_run_by_run(points):
    dataset = bifurcation_diagram.summarize(*points)
    # The last run did not complete.
    completed = list(RUNS.values())[:-1]
    counts = [2 * len(upward) for _, upward, *_ in completed]
    assert dataset["crossing_count"].values.tolist() == 4 * [*counts, 0]
    assert dataset["status"].values.tolist() == 4 * [0, 0, 0, 0, 1]
    assert dataset["a"].values.tolist() == 4 * list(RUNS)
    assert dataset["law"].values.tolist() == ["linearized"] * 10 + ["nonlinear"] * 10
    assert dataset["initial"].values.tolist() == 2 * (["minus"] * 5 + ["plus"] * 5)
    # Each run of the second state and law has its own velocities.
    chosen = (dataset["law"].values == "nonlinear") & (dataset["initial"].values == "plus")
    chosen = np.repeat(chosen, dataset["crossing_count"].values)
    dataset["crossing_velocity"].values[chosen] *= 2.0
    upward = np.concatenate([item[1] for item in completed])
    for law, initial, factor in (("nonlinear", "plus", 2.0), ("nonlinear", "minus", 1.0), ("linearized", "plus", 1.0)):
        a, velocity = bifurcation_diagram.section_points(dataset, law, initial, 1)
        assert velocity.tolist() == (factor * upward).tolist()
        assert a.tolist() == np.repeat(list(RUNS)[:-1], np.array(counts) // 2).tolist()
        assert (bifurcation_diagram.section_points(dataset, law, initial, -1)[1] <= -1.0).all()
