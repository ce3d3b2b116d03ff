"""Summaries over several parameters, compared with scalings of the equations of motion."""

from dataclasses import replace

import numpy as np
import pytest

from burridge_knopoff import MotionKind, simulate
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import Model
from tests.grids import grid_of
from tests.summaries.points import kinds, write_points

RUN = {"transient": 2000.0, "window": 2000.0, "batches": 4}
PAIR = InitialState("pair", (-0.9, -1.1), (0.1, 0.1))
THRESHOLD = 1e-6

MASSES = {"mass[2]": [0.999999999, 1.0]}


def summary(folder, law, state=PAIR, **parameters):
    named = {name: {f"{value:.9f}": value for value in values} for name, values in parameters.items()}
    study, _ = grid_of(folder, [state], {}, {"laws": {law: {}}}, **RUN)
    return kinds(*write_points(replace(study, parameters=named), folder)).squeeze(("law", "initial"))


def per_velocity(dataset):
    """Return <J> in units of v."""
    return (dataset["mean_distance"] / dataset["v"]).values


def test_each_point_has_the_run_of_its_parameters(tmp_path):
    dataset = summary(tmp_path, "nonlinear", coupling=[0.5, 2.0], a=[0.1, 0.4])
    assert dataset["lyapunov_exponent"].dims == ("coupling", "a", "exponent")
    for coupling in (0.5, 2.0):
        for a in (0.1, 0.4):
            trajectory = simulate(Model("nonlinear", a=a, chain=Chain(2, coupling=coupling)), PAIR, **RUN)
            point = dataset.sel(a=a, coupling=coupling)
            assert point["mean_distance"].item() == trajectory.mean_distance
            assert np.array_equal(point["lyapunov_exponent"], trajectory.lyapunov_exponent)


def test_only_end_blocks_of_one_mass_synchronize(tmp_path):
    """The chain is its own mirror image only at one of the masses, in either order."""
    dataset = summary(tmp_path, "linearized", InitialState("same", (-0.9, -0.9), (0.1, 0.1)), a=[0.01], **MASSES)
    assert dataset["mean_distance"].dims == ("a", "mass_2")
    assert dataset["mass_2"].values.tolist() == [0.999999999, 1.0]
    assert dataset["run_kind"].values[0].tolist() == [MotionKind.PERIODIC, MotionKind.SYNCHRONIZED]
    assert (dataset["mean_distance"].values < THRESHOLD).all()


def test_v_is_a_scale_of_the_linearized_law(tmp_path):
    """In units of v the equations of motion contain only these positions and velocities."""
    datasets = {}
    for v in (0.05, 0.1, 0.2):
        offset = Model("linearized", a=0.1, blocks=2, v=v).chain.sliding_offset(1.0)
        state = InitialState("pair", tuple(offset + v * np.array([1.0, -1.5])), (1.2 * v, 0.7 * v))
        datasets[v] = summary(tmp_path / f"{v}", "linearized", state, a=[0.05, 0.3], v=[v]).squeeze("v")
    for v in (0.05, 0.2):
        # Rounding differs after a single step, and chaos would amplify the difference.
        regular = datasets[0.1]["run_kind"].values != MotionKind.CHAOTIC
        assert regular.any()
        assert per_velocity(datasets[v])[regular] == pytest.approx(per_velocity(datasets[0.1])[regular], rel=1e-9)
        assert (datasets[v]["run_kind"] == datasets[0.1]["run_kind"]).all()


def test_the_nonlinear_law_has_two_products_of_its_parameters(tmp_path):
    """In units of v the friction f/(1 + au) leaves fa and av in the equations of motion, f the threshold."""
    usual = summary(tmp_path / "usual", "nonlinear", a=[0.1, 0.4], v=[0.1, 0.2], threshold=[1.0])
    half = InitialState("pair", (-0.45, -0.55), (0.05, 0.05))
    other = summary(tmp_path / "other", "nonlinear", half, a=[0.2, 0.8], v=[0.05, 0.1], threshold=[0.5])
    assert (other["run_kind"].values == usual["run_kind"].values).all()
    regular = usual["run_kind"].values != MotionKind.CHAOTIC
    assert regular.any()
    assert per_velocity(other)[regular] == pytest.approx(per_velocity(usual)[regular], rel=1e-9)
    # Unlike under the linearized law, v does not only set the scale.
    assert per_velocity(usual)[0, 0] != pytest.approx(per_velocity(usual)[0, 1], rel=1e-3)
