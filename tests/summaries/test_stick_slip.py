"""Stick-slip cycles: hand-made event lists and spectra, and the synchronized orbit, whose times are known."""

import dataclasses

import numpy as np
import pytest

from burridge_knopoff import Chain, InitialState, Model, Settings, simulate
from burridge_knopoff.motion.frequency import leading_frequency
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbits
from burridge_knopoff.summaries.attractor_observables import follow_attractor
from burridge_knopoff.summaries.stick_slip import (
    correlation,
    cycle_time,
    least_velocity,
    long_velocity,
    position_amplitude,
    stick_fraction,
    summarize,
)
from tests.grids import grid_of
from tests.summaries.points import write_points

STOP, START = 0, 1
#: Five blocks near uniform sliding that synchronize.
FIVE = {"position": [-0.989, -0.993, -0.993, -0.993, -0.991], "velocity": [0.099, 0.1012, 0.1012, 0.1012, 0.1023]}
EVENT_STATES = ("event_time", "event_block", "event_kind", "event_position", "event_velocity")
NONE = pytest.approx(np.nan, nan_ok=True)


@pytest.mark.parametrize(
    ("stops", "batches", "mean", "error"),
    [
        ([1.0, 3.0, 7.0, 9.0, 13.0], 2, 3.0, 0.0),  # two batches of two cycles: means 3 and 3
        # Means 1 and 3: standard deviation sqrt(2), over sqrt(2).
        ([0.0, 1.0, 2.0, 5.0, 8.0], 2, 2.0, pytest.approx(1.0)),
        ([0.0, 1.0, 4.0], 7, 2.0, pytest.approx(1.0)),  # fewer cycles than batches: single cycles 1 and 3
        ([5.0, 7.5], 4, 2.5, NONE),
        ([5.0], 4, NONE, NONE),
        ([], 4, NONE, NONE),
    ],
)
def test_cycle_time_of_hand_made_lists(stops, batches, mean, error):
    assert cycle_time(np.array(stops), batches) == (mean, error)


@pytest.mark.parametrize(
    ("time", "kind", "ends_stuck", "expected"),
    [
        # The window is [10, 20].
        ([12.0, 13.0, 15.0, 17.0], [STOP, START, STOP, START], False, 0.3),
        ([8.0, 11.0], [STOP, START], False, 0.1),  # begins stuck
        ([18.0], [STOP], True, 0.2),  # ends stuck
        ([11.0, 19.0], [START, STOP], True, 0.2),  # stuck from τ = 0 on
        ([2.0], [STOP], True, 1.0),  # its last event lies before the window
        ([2.0, 5.0], [STOP, START], False, 0.0),
        ([], [], True, 1.0),  # never an event
        ([], [], False, 0.0),
        ([12.0, 12.0], [STOP, START], False, 0.0),  # reverses at once
    ],
)
def test_stick_fraction_of_hand_made_lists(time, kind, ends_stuck, expected):
    fraction = stick_fraction(np.array(time), np.array(kind, dtype=int), 10.0, 20.0, ends_stuck)
    assert fraction == pytest.approx(expected, abs=1e-15)


@pytest.mark.parametrize("frequency", [0.1, 0.1763, 0.35, 1.234])
def test_the_frequency_of_a_sine_is_found_far_below_the_resolution(frequency):
    time = np.linspace(0.0, 30.0, 601)
    values = 0.1 + 0.05 * np.sin(2 * np.pi * frequency * time + 1.0) + 0.01 * np.sin(2 * np.pi * 2.9 * time)
    allowed = 0.05 * 0.5 / 30.0 / (30.0 * frequency) ** 0.5
    assert leading_frequency(values, 30.0) == pytest.approx(frequency, abs=allowed)


def test_no_frequency_without_a_cycle():
    time = np.linspace(0.0, 30.0, 601)
    assert np.isnan(leading_frequency(np.zeros(601), 30.0))
    assert np.isnan(leading_frequency(np.full(601, 0.1) + 1e-17 * np.cos(time), 30.0))
    assert np.isnan(leading_frequency(np.array([0.1]), 0.0))
    # A trend alone has no cycle and does not hide one.
    assert leading_frequency(np.exp(-time / 40.0) + 0.5 * np.sin(time), 30.0) == pytest.approx(0.5 / np.pi, abs=3e-3)


def test_four_samples_are_enough_for_a_frequency():
    values = np.sin(0.84 * np.pi * np.arange(4))
    assert leading_frequency(values, 3.0) == pytest.approx(0.42, abs=0.05)
    assert np.isnan(leading_frequency(values[:3], 2.0))


def test_correlation():
    one, other = np.sin(np.arange(500) * 0.1), np.cos(np.arange(500) * 0.1)
    assert correlation(one, one) == 1.0
    assert correlation(one, 0.3 - 2.0 * one) == pytest.approx(-1.0, abs=1e-14)
    assert correlation(one, other) == pytest.approx(np.corrcoef(one, other)[0, 1], abs=1e-14)
    assert np.isnan(correlation(one, np.zeros(500)))
    assert np.isnan(correlation(np.full(500, 0.1), one))
    # Rounding errors have no correlation, in either series.
    constant = 0.1 + 1e-12 * one
    assert np.isnan([correlation(constant, one), correlation(one, constant)]).all()


def test_the_amplitude_of_a_position_is_found_between_samples():
    """Of motions with a known range; in one the extreme is at the end, and in one there is a single sample."""
    time = np.linspace(0.0, 3.1, 63)
    position = np.stack([np.sin(2.0 * time + 0.3), 0.3 * np.cos(5.0 * time), time**2], axis=1)
    rate = np.stack([2.0 * np.cos(2.0 * time + 0.3), -1.5 * np.sin(5.0 * time), 2.0 * time], axis=1)
    expected = [1.0, 0.3, 0.5 * 3.1**2]
    assert position_amplitude(time, position, rate) == pytest.approx(expected, abs=2e-6)
    assert (0.5 * np.ptp(position, axis=0))[0] < 1.0 - 1e-5
    assert position_amplitude(time[:1], position[:1], rate[:1]).tolist() == [0.0, 0.0, 0.0]


def test_the_amplitude_is_that_of_dense_samples():
    coarse, dense = (
        simulate(
            Model("linearized", a=0.0475), "plus", transient=100.0, window=60.0, batches=2, trajectory_sampling=interval
        )
        for interval in (0.1, 1e-3)
    )
    found = position_amplitude(coarse.trajectory_time, coarse.position, coarse.velocity - 0.1)
    assert found == pytest.approx(0.5 * np.ptp(dense.position, axis=0), abs=2e-7)


def test_a_stick_between_two_samples_has_velocity_zero():
    run = {"trajectory_time": np.linspace(10.0, 11.0, 11), "velocity": np.full((11, 3), 0.2)}
    run["velocity"][3, 2] = -0.1
    least = least_velocity(run, np.array([9.99, 10.31, 10.97]), np.array([2, 1, 3]))
    assert least.tolist() == [0.0, 0.2, -0.1]


SETTINGS = {"transient": 1500.0, "window": 400.0, "batches": 4}


def points(folder, initial, a, alter=lambda trajectory: trajectory, **settings):
    """Write the points of one initial state at one a, altered if asked, and return their study and its folder."""
    return write_points(*grid_of(folder, [initial], {f"{a:.4f}": a}, **{**SETTINGS, **settings}), alter)


def test_the_synchronized_orbit(tmp_path):
    """Its period and slip time come from Newton's method, without an event list or a window."""
    dataset = summarize(*points(tmp_path, "minus", 0.05))
    for law in ("linearized", "nonlinear"):
        orbit = synchronized_orbits(Model(law, a=0.0)).at(0.05)
        run = dataset.sel(law=law, initial="minus", a=0.05)
        assert run["cycle_time"].values == pytest.approx([orbit.period] * 3, rel=1e-9)
        assert (run["cycle_time_error"] < 1e-9).all()
        # Whole periods, except at the ends of the window.
        share = [orbit.stick_time(block) / orbit.period for block in range(3)]
        assert run["stick_fraction"].values == pytest.approx(share, abs=orbit.period / 400.0)
        assert run["stop_rate"].values == pytest.approx([1.0 / orbit.period] * 3, abs=1.01 / 400.0)
        assert run["velocity_frequency"].values == pytest.approx([1.0 / orbit.period] * 3, abs=1e-5)
        # The events with states fill the window, except for part of a period at each end.
        assert run["velocity_frequency_error"].values == pytest.approx(0.5 / 400.0, rel=0.02)
        assert run["velocity_correlation"].item() == pytest.approx(1.0, abs=1e-12)
        assert run["least_velocity"].values.tolist() == [0.0, 0.0, 0.0]
        # The end blocks have the same amplitude; the middle block, coupled on both sides, has a smaller one.
        amplitude = run["position_amplitude"].values
        assert amplitude[0] == pytest.approx(amplitude[2], rel=1e-6)
        assert 0.07 < amplitude[1] < amplitude[0] < 0.12


def test_events_stored_without_states_count_too(tmp_path):
    """The stops are the same, whichever events are stored with states."""
    kept = [
        summarize(*points(tmp_path / events, "plus", 0.08, events=events, event_window=width))
        for events, width in (("window", 50.0), ("window", 400.0), ("all", 1.0))
    ]
    # Frequencies are more accurate for longer series of velocities; the smallest jump is among more events.
    same = [name for name in kept[0] if not name.startswith(("velocity_", "stop_jump", "start_jump"))]
    assert kept[0][same].identical(kept[1][same])
    assert kept[0][same].identical(kept[2][same])
    errors = [float(item["velocity_frequency_error"].max()) for item in kept]
    assert errors[0] > errors[1] == errors[2]
    # Blocks 1 and 3 slip alternately, while block 2 stops more than twice as often.
    run = kept[0].sel(law="linearized", initial="plus", a=0.08)
    assert run["velocity_correlation"] < -0.5
    assert run["stop_rate"].values[1] > 2.0 * run["stop_rate"].values[0]


def test_a_block_that_never_moves_and_one_that_never_stops(tmp_path):
    """The first block is pulled back and sticks; the second slips for half its natural period, π/√2."""
    held = InitialState("held", (3.0, -1.0), (0.0, 0.1))
    grid = points(tmp_path, held, 0.05, transient=0.5, window=1.0, batches=2, start="tested", trajectory=1.0)
    run = summarize(*grid).sel(law="linearized", a=0.05, initial="held")
    assert run["stick_fraction"].values.tolist() == [1.0, 0.0]
    assert run["stop_rate"].values.tolist() == [0.0, 0.0]
    assert run["least_velocity"].values[0] == 0.0 < run["least_velocity"].values[1]
    assert np.isnan(run["velocity_correlation"])
    assert np.isnan(run["velocity_frequency"].values[0])
    assert np.isnan(run["cycle_time"]).all()


def test_a_run_that_did_not_complete_has_no_values(tmp_path):
    def change(run):
        return dataclasses.replace(run, status="diverged") if run.model.law.name == "linearized" else run

    dataset = summarize(*points(tmp_path, "minus", 0.05, change))
    for variable in dataset.data_vars.values():
        assert np.isnan(variable.sel(law="linearized")).all()
        assert np.isfinite(variable.sel(law="nonlinear")).all()


def velocities(law, a, initial, **settings):
    """Return a run with all samples stored, and the same run as a study stores it."""
    settings = {"transient": 500.0, "window": 600.0, "batches": 2, "trajectory_sampling": 0.1, **settings}
    model = Model(law, a=a, blocks=5 if initial is FIVE else 3)
    run = simulate(model, initial, trajectory=settings["window"], **settings)
    kept = {**vars(run), "trajectory_time": run.trajectory_time[:100], "velocity": run.velocity[:100]}
    return run, kept, model


@pytest.mark.parametrize(
    ("law", "a", "initial"),
    # The second, third and fourth have shapes whose second harmonic is the highest peak.
    [
        ("linearized", 0.08, "plus"),
        ("nonlinear", 0.15, "plus"),
        ("nonlinear", 0.1675, "plus"),
        ("linearized", 0.02, FIVE),
    ],
)
def test_frequencies_are_those_of_the_motion(law, a, initial):
    """Compare with samples of the whole motion, 0.1 apart."""
    run, kept, model = velocities(law, a, initial)
    velocity, _, duration = long_velocity(kept, model, 500.0)
    assert duration == pytest.approx(600.0, rel=0.02)
    for block in range(run.velocity.shape[1]):
        expected = leading_frequency(run.velocity[:, block], np.ptp(run.trajectory_time))
        assert leading_frequency(velocity[:, block], duration) == pytest.approx(expected, abs=1e-4)
    assert correlation(velocity[:, 0], velocity[:, -1]) == pytest.approx(
        correlation(*run.velocity.T[[0, -1]]), abs=0.02
    )
    # If the samples last longer than the events, even slightly, they are returned.
    assert long_velocity(vars(run), model, 500.0)[0] is run.velocity
    for excess, taken in ((1e-3, True), (-1e-3, False)):
        samples = {**kept, "trajectory_time": np.array([0.0, duration + excess])}
        assert (long_velocity(samples, model, 500.0)[0] is kept["velocity"]) == taken
    none = {
        name: np.zeros((0, *kept[name].shape[1:]))
        for name in kept
        if name.startswith("event_") and name != "event_count"
    }
    assert long_velocity({**kept, **none}, model, 500.0)[0] is kept["velocity"]


def test_frequencies_are_those_of_the_same_motion_in_other_units():
    """With springs 400 times as stiff all times are divided by 20, and a spacing of 0.1 would be too coarse."""
    chain, state = Chain(3), InitialState("plus", [0.989, -0.993, -0.991], [0.099, 0.1012, 0.1023])
    stiff = Chain(3, coupling=400.0 * chain.coupling, pulling=tuple(400.0 * chain.driving))
    fast = {"transient": 25.0, "window": 30.0, "batches": 2, "trajectory_sampling": 0.005}
    moved = InitialState("moved", np.array(state.position) / 400.0, np.array(state.velocity) / 20.0)
    frequencies, along_attractors = [], []
    for model, initial, scale, settings in (
        (Model("linearized", a=0.08, chain=chain), state, 1.0, {"transient": 500.0, "window": 600.0, "batches": 2}),
        (Model("linearized", a=1.6, chain=stiff, v=0.005), moved, 20.0, fast),
    ):
        run = vars(simulate(model, initial=initial, settings=Settings(trajectory=0.5 / scale, **settings)))
        velocity, _, duration = long_velocity(run, model, settings["transient"])
        frequencies.append([leading_frequency(velocity[:, block], duration) / scale for block in range(3)])
        along_attractors.append(follow_attractor(model, run["final"]).velocity_frequency / scale)
    assert frequencies[1] == pytest.approx(frequencies[0], rel=1e-3)
    for found in along_attractors:
        assert found == pytest.approx(frequencies[0], rel=2e-3)


def test_events_before_the_window_do_not_affect_frequencies():
    _, kept, model = velocities("linearized", 0.0475, "plus", transient=300.0, window=200.0, events="all")
    assert kept["event_time"][0] < 10.0
    velocity, _, duration = long_velocity(kept, model, 300.0)
    assert 190.0 < duration <= 200.0
    later = {name: kept[name][kept["event_time"] >= 300.0] for name in kept if name in EVENT_STATES}
    assert (long_velocity({**kept, **later}, model, 300.0)[0] == velocity).all()


def test_a_block_at_rest_has_no_frequency():
    """The other block stops and starts."""
    model = Model("linearized", a=0.1, blocks=2, coupling=0.01, threshold=(1.0, 20.0), v=0.1)
    run = simulate(
        model,
        initial={"position": [0.0, 0.0], "velocity": [0.1, 0.0]},
        transient=20.0,
        window=60.0,
        start="tested",
        trajectory=5.0,
    )
    record, _, duration = long_velocity(vars(run), model, 20.0)
    assert duration > 30.0
    assert (record[:, 1] == 0.0).all()
    assert np.isnan(leading_frequency(record[:, 1], duration))
    assert leading_frequency(record[:, 0], duration) > 0.0
