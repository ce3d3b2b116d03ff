"""Settings of a run: refused values, and limits on what a run may store."""

import numpy as np
import pytest

from burridge_knopoff import Chain, InitialState, Model, Settings, simulate
from tests.refused import refused


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"colour": "blue"}, "colour"),
        ({"model": Model("linearized", a=2.0), "solver": "map"}, "solver: 'map'"),
        ({"initial": "middle"}, "initial: 'middle'"),
        ({"model": Model("nonlinear", a=0.08), "solver": "map"}, "solver: 'map'"),
        ({"model": Model("linearized", a=0.08, blocks=4)}, "blocks: 4"),
        ({"initial": InitialState("back", 0.0, (0.1, 0.1, -0.1))}, "velocity: -0.1"),
    ],
)
def test_bad_input_is_refused_in_one_line(options, words):
    with refused(words):
        simulate(**{"model": Model("linearized", a=0.08), **options})


@pytest.mark.parametrize(
    ("key", "options"),
    [
        ("trajectory_sampling", {"trajectory": 1e5, "trajectory_sampling": 0.02, "events": "none"}),
    ],
)
def test_a_run_that_would_store_too_much_is_refused_by_the_responsible_key(key, options):
    """A sample of a trajectory has 2N + 1 numbers; the limit corresponds to a few GB."""
    run_settings = Settings(**{"transient": 0.0, "window": 1e5, **options})
    run_settings.check_chain(Chain(3))
    with refused(key, "numbers to store"):
        run_settings.check_chain(Chain(60))


def test_steps_of_rk4_that_are_too_long_for_the_chain_are_refused():
    """With a step of 1 both of the paper's states would synchronize, although one of them does not."""
    stiff = Chain(3, coupling=100.0)
    assert max(np.linalg.eigvalsh(stiff.stiffness)) ** 0.5 <= stiff.highest_frequency
    Settings(solver="rk4", step=0.1).check_chain(Chain(3))
    Settings(solver="series", step=1.0).check_chain(Chain(3))
    for chain, step in ((Chain(3), 0.11), (stiff, 0.04)):
        with refused(f"step: {step}"):
            Settings(solver="rk4", step=step).check_chain(chain)


@pytest.mark.parametrize(
    ("key", "options"),
    [
        ("sampling", {"transient": 400.0, "window": 600.0, "sampling": 1e-4}),
        ("trajectory_sampling", {"trajectory": 1000.0, "trajectory_sampling": 1e-4}),
    ],
)
def test_a_run_has_at_most_ten_million_samples(key, options):
    Settings(**options)
    longer = {name: value * (1.001 if value > 1.0 else 1.0) for name, value in options.items()}
    with refused(f"{key}: 0.0001", "0.00011"):
        Settings(**longer)
    # What the message names is allowed.
    Settings(**{**longer, key: 0.00011})


def test_a_chain_has_two_exponents_per_block():
    Settings(lyapunov_exponents=6).check_chain(Chain(3))
    with refused("lyapunov_exponents: 7", "6"):
        Settings(lyapunov_exponents=7).check_chain(Chain(3))


def test_a_run_of_rk4_has_at_most_ten_billion_block_steps():
    """With three blocks it has at most a third as many steps; steps of `series` do not count."""
    options = {"transient": 1e5, "events": "none", "sampling": 1000.0}
    Settings(solver="rk4", step=1e-3, window=3.2e6, **options).check_chain(Chain(3))
    Settings(solver="series", step=1e-3, window=3.4e6, **options).check_chain(Chain(3))
    with refused("step: 0.001", "0.0011"):
        Settings(solver="rk4", step=1e-3, window=3.3e6, **options).check_chain(Chain(3))
    Settings(solver="rk4", step=1.1e-3, window=3.3e6, **options).check_chain(Chain(3))


@pytest.mark.parametrize(
    ("key", "fits", "too_long"),
    [
        # A sample of a trajectory has 81 numbers, in the last part of the run or in the whole run.
        (
            "trajectory_sampling",
            {"trajectory": 1.23e6, "trajectory_sampling": 1.0, "window": 2e6, "events": "none"},
            {"trajectory": 1.24e6, "trajectory_sampling": 1.0, "window": 2e6, "events": "none"},
        ),
        (
            "trajectory_sampling",
            {"trajectory": 9e6, "trajectory_sampling": 1.0, "window": 1.23e6, "events": "none"},
            {"trajectory": 9e6, "trajectory_sampling": 1.0, "window": 1.24e6, "events": "none"},
        ),
    ],
)
def test_a_run_stores_at_most_a_hundred_million_numbers_of_a_kind(key, fits, too_long):
    """The chain has 40 blocks."""
    usual = {"transient": 0.0, "window": 1e3, "sampling": 1e3, "event_window": 1e3}
    Settings(**{**usual, **fits}).check_chain(Chain(40))
    with refused(key, "1e+08 numbers"):
        Settings(**{**usual, **too_long}).check_chain(Chain(40))


@pytest.mark.parametrize(
    ("chain", "options"),
    [
        # A slowly driven chain has few events with states, even a long chain or in a long time.
        (Chain(1000), {"transient": 0.0, "window": 5e3, "event_window": 5e3}),
        (Chain(2), {"transient": 0.0, "window": 1e9, "sampling": 1e6, "events": "all"}),
    ],
)
def test_the_number_of_events_is_not_predicted(chain, options):
    Settings(**options).check_chain(chain)
