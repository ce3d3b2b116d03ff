"""What must hold for whole runs: solvers agree, symmetries, synchronization, settings."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from burridge_knopoff.laws import LAWS
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.initial import PAPER_STATES, InitialState
from burridge_knopoff.model.model import Model
from burridge_knopoff.running.simulation import simulate


@pytest.mark.parametrize("initial", ["minus", "plus"])
def test_map_and_series_agree_on_the_mean_distance_outside_chaos(initial):
    """To 1e-11 on every grid value of a at which the run is not chaotic.

    Chaos is told without regard to the agreement: a shift of the initial state by 1e-12 changes the mean distance.
    """
    state = PAPER_STATES[initial]
    shifted = InitialState("shifted", (state.position[0] + 1e-12, *state.position[1:]), state.velocity)
    compared = 0
    for a in np.arange(0.0, 0.3001, 0.02):
        runs = [simulate("linearized", a, initial, solver=solver, events="none") for solver in ("map", "series")]
        other = simulate("linearized", a, shifted, events="none")
        if abs(other.mean_distance - runs[0].mean_distance) > 1e-9:
            continue
        compared += 1
        assert runs[0].mean_distance == pytest.approx(runs[1].mean_distance, rel=0, abs=1e-11), a
        if runs[0].mean_distance > 1e-3:
            assert len(runs[0].crossing_time) == len(runs[1].crossing_time)
    assert compared >= 7


@pytest.mark.parametrize(("law", "solver"), [("linearized", "map"), ("linearized", "series"), ("nonlinear", "series")])
def test_the_synchronous_state_stays_synchronous(law, solver):
    run = simulate(law, 0.08, "minus", solver=solver, transient=9e5, window=1e5, events="none", sampling=500.0)
    assert run.status == "completed"
    assert run.distance[run.time >= 1e4].max() < 1e-13
    assert run.distance[0] > 1e-3


@pytest.mark.parametrize(("law", "solver"), [("linearized", "map"), ("linearized", "series"), ("nonlinear", "series")])
@pytest.mark.parametrize("contact", ["one_sided", "symmetric"])
def test_mirror_symmetry(law, solver, contact):
    """Numbering the blocks from the other end changes nothing else."""
    state = PAPER_STATES["plus"]
    mirror = InitialState("mirror", state.position[::-1], state.velocity[::-1])
    options = {"solver": solver, "contact": contact, "transient": 20.0, "window": 40.0, "events": "all"}
    run, other = (simulate(law, 0.12, initial, **options) for initial in (state, mirror))
    assert run.event_block.tolist() == (4 - other.event_block).tolist()
    assert np.allclose(run.event_time, other.event_time, rtol=0, atol=1e-11)
    assert run.mean_distance == pytest.approx(other.mean_distance, rel=1e-11)
    assert np.allclose(run.position, other.position[:, ::-1], atol=1e-11)


@given(st.integers(3, 25), st.sampled_from([("linearized", "map"), ("linearized", "series"), ("nonlinear", "series")]))
def test_time_shift(count, which):
    """A run started from the state at one of its events repeats what comes after it."""
    law, solver = which
    options = {"solver": solver, "events": "all", "transient": 0.0}
    run = simulate(law, 0.1, "plus", window=60.0, **options)
    # A stop with all other blocks in motion or clearly stuck: `tested` then tells stuck from slipping by the force.
    k = count + int(np.argmax(run.event_kind[count:] == 0))
    time = run.event_time[k]
    later = InitialState("later", tuple(run.event_position[k]), tuple(run.event_velocity[k]))
    again = simulate(law, 0.1, later, window=60.0 - time, start="tested", **options)
    moving = run.event_velocity[k] > 0.0
    stuck_force = _spring_force(run.event_position[k]) <= 1.0
    if not (moving == ~stuck_force).all():
        return
    expected = run.event_time[run.event_time > time] - time
    assert len(again.event_time) == len(expected)
    assert np.allclose(again.event_time, expected, rtol=0, atol=1e-10)


def _spring_force(position):
    k = Chain(3).stiffness
    return -k @ position


def test_energy_balance():
    """Kinetic plus spring energy changes by the driver's work minus friction, over a dense trajectory."""
    a, v = 0.2, 0.1
    run = simulate(
        "nonlinear", a, "plus", transient=0.0, window=40.0, trajectory=40.0, trajectory_sampling=1e-3, batches=2
    )
    x, u = run.position, run.velocity
    driving = Chain(3).driving
    energy = 0.5 * (u**2).sum(axis=1) + 0.5 * (driving * x**2).sum(axis=1) + 0.5 * (np.diff(x, axis=1) ** 2).sum(axis=1)
    power = -v * (driving * x).sum(axis=1) - (u / (1.0 + a * u)).sum(axis=1)
    work = np.concatenate([[0.0], np.cumsum(0.5e-3 * (power[1:] + power[:-1]))])
    assert np.allclose(energy - energy[0], work, atol=2e-7)


@pytest.mark.parametrize(
    ("law", "a"), [("linearized", 0.05), ("linearized", 0.2), ("nonlinear", 0.08), ("nonlinear", 0.5)]
)
def test_a_block_exactly_at_its_threshold_starts_stuck(law, a):
    """s = (1, −1, 1) without rounding: `tested` stops all three, whatever Φ(av) rounds to."""
    state = InitialState("threshold", (-0.5, 0.0, -0.5), (0.1, 0.1, 0.1))
    run = simulate(law, a, state, start="tested", transient=0.0, window=5.0, trajectory=5.0, trajectory_sampling=5.0)
    assert run.velocity[0].tolist() == [0.0, 0.0, 0.0]
    assert run.position[-1, 0] == pytest.approx(run.position[-1, 2], abs=1e-12)


@pytest.mark.parametrize(("law", "solver"), [("linearized", "map"), ("linearized", "series"), ("nonlinear", "series")])
@pytest.mark.parametrize("a", [0.2, 0.21, 0.234])
def test_an_exactly_symmetric_state_stays_symmetric(law, solver, a):
    """Synchrony is unstable there, but its mirror symmetry is exact: no rounding may break it."""
    state = InitialState("symmetric", (-0.99, -0.993, -0.99), (0.1, 0.101, 0.1))
    run = simulate(law, a, state, solver=solver, events="none")
    assert run.distance.max() == 0.0


@pytest.mark.parametrize(("window", "batches", "sampling"), [(0.7, 3, 0.7), (0.3, 2, 0.1), (14.7, 6, 4.9)])
def test_the_last_samples_are_there_whatever_rounds(window, batches, sampling):
    run = simulate(
        transient=0.0,
        window=window,
        batches=batches,
        sampling=sampling,
        trajectory=window,
        trajectory_sampling=window / 2,
    )
    assert run.status == "completed"
    assert run.end_time == window
    assert np.isfinite(run.distance).all()
    assert np.isfinite(run.position).all()


def test_more_blocks_and_two():
    for blocks in (2, 5, 12):
        position = tuple(-0.9 + 0.05 * np.sin(3.0 * np.arange(blocks)))
        state = InitialState("wave", position, (0.1,) * blocks)
        runs = [
            simulate("linearized", 0.1, state, solver=solver, transient=0.0, window=30.0, events="all")
            for solver in ("map", "series")
        ]
        assert runs[0].event_block.tolist() == runs[1].event_block.tolist()
        assert len(runs[0].event_block) > 5
        assert np.allclose(runs[0].event_time, runs[1].event_time, rtol=0, atol=1e-11)
        assert runs[0].event_position.shape[1] == blocks


def test_no_sticks_means_no_events():
    run = simulate("linearized", 0.0, InitialState("uniform", (-5 / 6, -2 / 3, -5 / 6), (0.1,) * 3), window=100.0)
    assert run.event_count == 0
    assert run.mean_distance < 1e-13
    assert np.isnan(run.least_spring_force)


def test_accumulating_events_end_the_run(monkeypatch):
    """More events in one time unit than the limit end a run with a status, and NaN for the averages."""
    monkeypatch.setattr("burridge_knopoff.running.runner.EVENTS_PER_BLOCK_AND_UNIT", 0)
    run = simulate("linearized", 0.08, "minus", transient=0.0, window=50.0, events="all")
    assert run.status == "accumulating_events"
    assert np.isnan(run.mean_distance)
    assert run.end_time < 50.0


@pytest.mark.parametrize(("law", "solver"), [("linearized", "map"), ("linearized", "series"), ("linearized", "rk4")])
def test_motion_without_bound_ends_the_run(law, solver):
    """Backward slip under the linearized law is fed without limit: friction 1 − a|U'| turns negative."""
    run = simulate(law, 1.9, "minus", solver=solver, contact="symmetric", transient=0.0, window=1e4)
    assert run.status == "diverged"
    assert run.end_time < 1000.0
    assert np.isnan(run.mean_distance)


def test_the_step_limit_ends_the_run(monkeypatch):
    monkeypatch.setattr("burridge_knopoff.running.runner.STEP_LIMIT", 10)
    run = simulate("linearized", 0.08, "minus", transient=0.0, window=50.0)
    assert run.status == "step_limit"
    assert run.step_count == 10
    assert np.isnan(run.mean_distance)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"v": 0.0}, "v: 0.0"),
        ({"v": float("nan")}, "v: nan"),
        ({"window": 0.0}, "window: 0.0"),
        ({"transient": -1.0}, "transient: -1.0"),
        ({"batches": 1}, "batches: 1"),
        ({"contact": "sticky"}, "one_sided | symmetric"),
        ({"start": "soon"}, "moving | tested"),
        ({"solver": "euler"}, "series | map | rk4"),
        ({"events": "some"}, "none | window | all"),
        ({"sampling": 1e-5, "window": 1e9}, "samples"),
        ({"colour": "blue"}, "colour: not a setting"),
        ({"law": "cubic"}, " | ".join(LAWS)),
        ({"a": 2.0, "solver": "map"}, "not too steep"),
        ({"a": float("nan")}, "a: nan"),
        ({"initial": "middle"}, "minus | plus"),
        ({"law": "nonlinear", "solver": "map"}, "closed form"),
        ({"chain": Chain(4)}, "blocks: 4"),
        ({"initial": InitialState("back", (0.0, 0.0), (0.1, -0.1))}, "one_sided"),
    ],
)
def test_bad_input_is_refused_in_one_line(options, words):
    with pytest.raises(ValueError, match="not allowed|not known|not a setting") as caught:
        simulate(**options)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("options", [{"window": 10.0}, {"windows": 10.0}, {"v": 0.2}, {"chain": Chain(3)}])
def test_settings_by_name_are_refused_beside_a_model(options):
    """They would have no effect."""
    with pytest.raises(ValueError, match="not allowed beside a model"):
        simulate(Model(Chain(3), LAWS["linearized"](0.08)), "plus", **options)
