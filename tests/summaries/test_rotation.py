"""The summary of branches without synchrony, from states of both branches at one a."""

import numpy as np
import pytest
import xarray

from burridge_knopoff import ChainState, Model, MotionKind
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.summaries.rotation import summarize

MODEL = Model("linearized", a=0.05)


@pytest.fixture(scope="module")
def dataset():
    """Branch 2 in the first slot, branch 1 in the second, and at a second a between the values of the grid."""
    runner = Runner(MODEL)
    antiphase = ChainState(np.array([0.07, 0.0, -0.07]), np.full(3, MODEL.v), np.zeros(3, bool))
    one, two = (
        runner.state_after(state, 6000.0)
        for state in (MODEL.begin(PAPER_STATES["plus"]), antiphase)
    )  # fmt: skip
    slots = ("law", "value", "attractor")
    states = [[two, one], [two, one]]
    data = {
        "a": (slots[:2], [[0.05, 0.0501]]),
        "in_grid": (slots[:2], np.array([[1, 0]], "i1")),
        "branch": (slots, np.array([[[2, 1], [2, 1]]], "i2")),
        "side": (slots, np.zeros((1, 2, 2), "i1")),
        "kind": (slots, np.array([[[MotionKind.PERIODIC, MotionKind.QUASIPERIODIC]] * 2], "i1")),
        "position": ((*slots, "block"), [[[s.position + MODEL.sliding_offset for s in row] for row in states]]),
        "velocity": ((*slots, "block"), [[[s.velocity for s in row] for row in states]]),
    }
    refined = xarray.Dataset(data, {"law": ["linearized"], "block": [1, 2, 3]})
    return summarize(refined, [MODEL]).sel(law="linearized")


def test_branches_are_detuned_at_values_of_the_grid(dataset):
    assert dataset["branch"].values.tolist() == [1, 2]
    one, two = (dataset.sel(branch=branch).isel(value=0) for branch in (1, 2))
    # The middle block oscillates in the fast mode on branch 1, and as the end blocks do on branch 2.
    assert (one["detuned_frequency"][:2, 1] > 0.33).all()
    assert two["detuned_frequency"].values[:2] == pytest.approx(
        one["detuned_frequency"].values[:2, [0, 0, 0]], abs=2e-4
    )
    for branch in (one, two):
        assert branch["detuned_end_ratio"].values[:2] == pytest.approx([0.86, 0.59], abs=0.01)
        assert branch["detuned_end_phase"].values[:2] == pytest.approx([173.0, 173.0], abs=4.0)
        assert (branch["detuned_mode_share"].values[:2, 1] > 0.99).all()
        assert (branch["detuned_exponent"].values[:2, 2] < -0.01).all()
    assert np.isnan(dataset["detuned_frequency"].isel(value=1)).all()


def test_the_rotation_number_is_that_of_branch_1(dataset):
    assert dataset["rotation_number"].values == pytest.approx([0.649, 0.649], abs=1e-3)
    assert dataset["locked"].values.tolist() == [0, 0]


def test_the_modes_are_those_of_the_unequal_masses(dataset):
    """Frequencies of the middle mode, to the digits that an independent eigenvalue problem gives."""
    assert dataset["mode_frequency"].values[:, 1] == pytest.approx([0.22017, 0.21375, 0.20711], abs=5e-6)
    assert dataset["mode_end_ratio"].values[:, 1] == pytest.approx([-0.820, -0.569, -0.293], abs=5e-4)
