"""The velocity v of the driver as the parameter, under a law without a; compared with SciPy and published numbers."""

import warnings

import numpy as np
import pytest

from burridge_knopoff import (
    ContinuationSettings,
    InitialState,
    Model,
    SearchSettings,
    basin_map,
    continue_attractors,
    find_attractors,
    follow,
    limit_cycle,
    plot,
    simulate,
    sweep,
    synchronized_orbit,
)
from tests.friction_oscillator import BOX, CHAIN, FORMULA, NUMBERS, QUICK, SLIDING, oscillator
from tests.refused import refused
from tests.scipy_flow import model_events

STUCK = {"name": "stuck", "position": -1.5, "velocity": 0.0}


def stops(model, position, velocity, end):
    """Return the times at which the block stops, by SciPy."""
    start = model.begin(InitialState("own", (position,), (velocity,)))
    return [time for time, _, kind in model_events(model, start, end)[0] if not kind]


def test_fractions_along_v_are_published():
    """Of states whose velocities lie in [v - 2, v]; within the interval of each fraction."""
    data = continue_attractors(oscillator(1.4), v=[1.4, 1.775], **BOX, **QUICK, fraction_width=0.03, cores=1)
    assert "a" not in data.coords
    assert data.attrs["velocity_box"] == "v - 2, v"
    for v in (1.4, 1.775):
        here = data.sel(v=v)
        sticks = here["stop_rate"].values[:, 0] > 0.0
        assert here["basin_fraction"].values[sticks].sum() == pytest.approx(1.0 - SLIDING[v], abs=0.04)


def test_the_branch_of_an_orbit_along_v_is_that_of_scipy():
    """And that of orbits on which motion settles at each v, whose sweep has the same periods."""
    branch = follow(oscillator(1.4), (1.2, 1.4), parameter="v", upward=False, initial=([-1.5], [0.0]))
    v = [0.5, 1.0]
    runs = sweep(oscillator(1.4), initial=STUCK, v=v, transient=100, window=200, lyapunov_exponents=0)
    assert "a" not in runs.coords
    for point in (branch[0], branch[-1]):
        times = stops(oscillator(point.value), -1.5, 0.0, 60.0)
        assert times[-1] - times[-2] == pytest.approx(point.orbit.period, abs=1e-6)
    for speed, period in zip(v, runs["period"].values, strict=True):
        orbit = limit_cycle(oscillator(speed), InitialState("own", -1.5, 0.0), settling=100.0)
        assert period == pytest.approx(orbit.period, abs=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("parameter", ["mus", "mud", "v0", "pulling_damping", "mass[1]"])
def test_branches_along_other_parameters(parameter):
    """The last orbit has the period of SciPy at its value."""
    model = oscillator(1.4)
    value = model.parameter(parameter)
    steps = ContinuationSettings(largest_step=0.05 * value)
    ends = (0.95 * value, value)
    branch = follow(model, ends, steps, parameter=parameter, upward=False, initial=([-1.5], [0.0]))
    at = model.at(**{parameter: branch[-1].value})
    times = stops(at, -1.5, 0.0, 60.0)
    assert times[-1] - times[-2] == pytest.approx(branch[-1].orbit.period, abs=1e-6)
    assert branch[-1].value < value


@pytest.mark.slow
def test_the_map_of_one_block_is_over_its_position_and_velocity():
    """Where the block sticks in the end by SciPy, the branch is that of sticking."""
    model = oscillator(1.4)
    basins, attractors = basin_map(model, pixels=3, first_position=(-2.0, 2.0), first_velocity=("v - 2", 1.4), **QUICK)
    plane, slots = basins.isel(map=0), attractors.isel(law=0, a=0)
    assert plane["branch"].dims == ("first_velocity", "first_position")
    assert basins.attrs["velocity_range"].tolist() == pytest.approx([-0.6, 1.4])
    (sticking,) = np.unique(slots["branch"].values[slots["stop_rate"].values[:, 0] > 0.0])
    reached = plane["branch"].values == sticking
    assert 0 < reached.sum() < reached.size
    for j, velocity in enumerate(plane["first_velocity"].values):
        for i, position in enumerate(plane["first_position"].values):
            last = [time for time in stops(model, position, velocity, 30.0) if time > 20.0]
            assert reached[j, i] == bool(last)
    panel = plot((basins, attractors)).axes[0]
    assert panel.get_ylabel() == "$U_1'(0)$"
    assert "a=" not in panel.get_title()


def test_a_law_without_a_needs_none():
    law = {"formula": FORMULA, **NUMBERS}
    run = simulate(Model(law, chain=CHAIN, v=1.4, contact="symmetric"), STUCK, transient=10, window=20)
    same = simulate(oscillator(1.4), STUCK, transient=10, window=20)
    np.testing.assert_array_equal(run.event_time, same.event_time)
    assert "--a " not in run.to_dataset().attrs["history"]
    assert "a = " not in repr(run)
    with refused("a"):
        oscillator(1.4).at(a=0.1)
    with refused("a: missing"):
        find_attractors(Model({"formula": "1 - a*u"}), samples=1)
    with refused("w: missing"):
        simulate(Model({"formula": "1/(1 + w*u)"}), initial="minus")


def test_the_synchronized_orbit_of_a_law_without_a():
    """It is that of the same law at its a."""
    orbit = synchronized_orbit(Model({"formula": "1/(1 + 0.08*u)"}))
    assert orbit.period == pytest.approx(synchronized_orbit(Model("nonlinear", a=0.08)).period, abs=1e-9)


def test_velocities_that_a_tested_start_drops_are_told():
    """Not those of the paper's states, which are not given, nor those of blocks that slip."""
    given = {"name": "given", "position": [-0.9, -1.1, -1.0], "velocity": [0.1, 0.1, 0.1]}
    short = {"start": "tested", "transient": 1, "window": 2, "lyapunov_exponents": 0}
    with pytest.warns(UserWarning, match="start tested: .* given 2 blocks stick") as told:
        simulate(Model("linearized", a=0.08), given, **short)
    assert told[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        simulate(Model("linearized", a=0.08), "minus", **short)
        simulate(Model("linearized", a=0.08), {**given, "velocity": [0.0, 0.1, 0.0]}, **short)


def test_velocities_below_0_need_symmetric_contact():
    model = oscillator(1.4)
    assert SearchSettings(velocity=(-0.5, 1.5)).box(model)[1] == (-0.5, 1.5)
    assert SearchSettings(**BOX).box(model)[1] == pytest.approx((-0.6, 1.4))
    find_attractors(model, samples=2, velocity=(-0.5, 1.5), transient=50, window=50, time_limit=50)
    for wrong in ((-0.5, 1.5), ("v - 1", "v"), ("v", "0.5*v"), (0.0, "w"), ("1", "0"), "v"):
        with refused("velocity"):
            find_attractors(Model("linearized", a=0.08), samples=2, velocity=wrong)
        with refused("first_velocity"):
            basin_map(Model("linearized", a=0.08, blocks=1), first_velocity=wrong)


def test_a_quoted_constant_is_its_number():
    assert SearchSettings(velocity=("0", "1/2")).velocity == (0.0, 0.5)
    assert SearchSettings(velocity=("0", "2*v")).box(oscillator(1.4))[1] == (0.0, 2.8)


def test_a_range_that_is_not_that_of_an_axis_is_refused():
    for blocks, name in ((1, "last_position"), (3, "first_velocity")):
        with refused(f"{name}: (0.0, 0.5)", "in its place"):
            basin_map(
                Model("linearized", a=0.08, blocks=blocks), ([0.0] * blocks, [0.1] * blocks), **{name: (0.0, 0.5)}
            )
