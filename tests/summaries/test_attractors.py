"""Attractors along a: what a hand-made continuation of two laws becomes in the summary and in its lines."""

import numpy as np
import pytest

from burridge_knopoff import Chain, InitialState, Model, law_of
from burridge_knopoff.stability.attractor import Symmetry
from burridge_knopoff.stability.continuation import Continuation
from burridge_knopoff.stability.motion import MotionKind
from burridge_knopoff.stability.sampling import fraction_interval
from burridge_knopoff.stability.settings import MOTION, SearchSettings
from burridge_knopoff.summaries import attractors
from tests.stability.stand_in import stand_in

GRID = [0.05, 0.1, 0.2]
STATES = [InitialState("here", (0.0,) * 3, (0.1,) * 3), InitialState("back", (0.0,) * 3, (0.1, -0.1, 0.1))]
SETTINGS = SearchSettings(samples=4, time_limit=123.0)


def continuation():
    """Return synchrony and a torus, then a mirror pair that the torus turns into, then nothing."""
    torus = {
        "kind": MotionKind.QUASIPERIODIC,
        "section_period": 0,
        "stop_rate": np.array([0.1, 0.0, 0.3]),
        "slow": True,
    }
    first = [
        stand_in(Symmetry.SYMMETRIC, 0.14, 0, 0.5, mean_distance_error=1e-3, **torus),
        stand_in(Symmetry.SYNCHRONIZED, 0.0, 1, 0.0, kind=MotionKind.SYNCHRONIZED, close_returns=20, radius=0.02),
    ]
    pair = {"kind": MotionKind.CHAOTIC, "exponent": np.array([0.03, 0.0])}
    second = [stand_in(Symmetry.ASYMMETRIC, 0.15, 1, -2.0, **pair), stand_in(Symmetry.ASYMMETRIC, 0.15, 0, 2.0, **pair)]
    numbers = [([1, 0], [0, 0]), ([1, 1], [-1, 1]), ([], [])]
    return Continuation(
        [first, second, []],
        upward=[np.array([1, -1]), np.array([-1, -1]), np.zeros(0, int)],
        downward=[np.array([-1, -1]), np.array([0, 0]), np.zeros(0, int)],
        branch=[np.array(branch) for branch, _ in numbers],
        side=[np.array(side) for _, side in numbers],
        samples=[np.array([0, 0, 1, -1, 1, 1]), np.array([1, 1, 1, 0, 0, 0]), np.full(6, -1)],
    )


@pytest.fixture
def one_law(monkeypatch):
    """The summary of a law; of the initial states, under a symmetric contact, the second attractor is reached, or none.

    With blocks that are tested at the start nothing is reached by the first state.
    """

    def label(model, found, starts, time_limit):
        assert time_limit == 123.0
        reached = [1 if len(found) else -1] * len(starts)
        if starts and starts[0].stuck.any():
            reached[0] = -1
        return np.array(reached, int), np.zeros(len(starts))

    monkeypatch.setattr(attractors, "continue_attractors", lambda *args, **options: continuation())
    monkeypatch.setattr(attractors, "label", label)

    def summarized(law):
        model = Model(Chain(3), law_of(law, 0.0), 0.2)
        return attractors.one_law(model, GRID, STATES, SETTINGS, MOTION, "tested")

    return summarized


def test_features_are_sorted_by_branch_and_side(one_law):
    found = one_law("linearized")
    nan, none = np.nan, [-1, -1]
    expected = {
        "branch": [[0, 1], [1, 1], none],
        "side": [[0, 0], [1, -1], [0, 0]],
        "symmetry": [[Symmetry.SYNCHRONIZED, Symmetry.SYMMETRIC], [Symmetry.ASYMMETRIC, Symmetry.ASYMMETRIC], none],
        "mean_distance": [[0.0, 0.14], [0.15, 0.15], [nan, nan]],
        "mean_distance_error": [[0.0, 1e-3], [0.0, 0.0], [nan, nan]],
        "kind": [[MotionKind.SYNCHRONIZED, MotionKind.QUASIPERIODIC], [MotionKind.CHAOTIC, MotionKind.CHAOTIC], none],
        "section_period": [[1, 0], [1, 1], [0, 0]],
        "radius": [[0.02, 0.01], [0.01, 0.01], [nan, nan]],
        "close_returns": [[20, 8], [8, 8], none],
        "slow": [[0, 1], [0, 0], none],
        "upward_branch": [[-1, 1], none, none],
        "downward_branch": [none, [1, 1], none],
        # Of the four drawn states only.
        "basin_count": [[1, 2], [3, 1], [0, 0]],
        "basin_fraction": [[0.25, 0.5], [0.75, 0.25], [nan, nan]],
        "basin_fraction_low": [[fraction_interval(n, 4)[1] for n in row] for row in ([1, 2], [3, 1])] + [[nan, nan]],
        "basin_fraction_high": [[fraction_interval(n, 4)[2] for n in row] for row in ([1, 2], [3, 1])] + [[nan, nan]],
    }
    for name, values in expected.items():
        np.testing.assert_array_equal(found[name].values, values, name)
    assert found["undetermined_count"].values.tolist() == [1, 0, 4]
    assert found["stop_rate"].values[0].tolist() == [[0.1, 0.2, 0.1], [0.1, 0.0, 0.3]]
    np.testing.assert_array_equal(found["lyapunov_exponent"].values[1], [[0.03, 0.0, nan]] * 2)
    # U of the last return: its x beside uniform sliding, −5/6, −2/3, −5/6 times the friction 1 − av.
    assert found["position"].values[1, 0] == pytest.approx([2.0 - 0.98 * 5 / 6, -0.98 * 2 / 3, -0.98 * 5 / 6])
    assert found["velocity"].values[0, 0].tolist() == [0.0, 0.5, 0.25]
    assert found["block"].values.tolist() == [1, 2, 3]
    told = {"law": "linearized", "v": 0.2, "contact_convention": "one_sided", "start_convention": "tested", "seed": 1}
    assert {key: found.attrs[key] for key in told} == told


def test_what_initial_states_and_sweeps_reach(one_law):
    found = one_law("linearized")
    reached, side = found["initial_branch"], found["initial_side"]
    for contact in ("one_sided", "symmetric"):
        for start, here in (("moving", [0, 1, -1]), ("tested", [-1, -1, -1])):
            where = {"contact": contact, "start": start}
            assert reached.sel(initial="here", **where).values.tolist() == here
            # A block that moves backward is allowed under a symmetric contact only.
            back = [0, 1, -1] if contact == "symmetric" else [-1, -1, -1]
            assert reached.sel(initial="back", **where).values.tolist() == back
            assert side.sel(initial="here", **where).values.tolist() == [0, int(start == "moving"), 0]
    # Upward from a = 0.05 in the order of the branches; downward from a = 0.1, where there is something to begin with.
    assert found["sweep_branch"].sel(direction="upward").values.tolist() == [[0, -1, -1], [1, 1, -1]]
    assert found["sweep_branch"].sel(direction="downward").values.tolist() == [[1, 1, -1], [1, 1, -1]]
    mean = found["sweep_mean_distance"]
    np.testing.assert_array_equal(mean.sel(direction="upward"), [[0.0, np.nan, np.nan], [0.14, 0.15, np.nan]])
    np.testing.assert_array_equal(mean.sel(direction="downward"), [[0.14, 0.15, np.nan]] * 2)


def test_laws_are_put_together_under_common_numbers(one_law):
    first, second, third = (one_law(law) for law in ("linearized", "nonlinear", "exponential"))
    # Another ⟨J⟩ at one of two a is the same branch still; at both it is a branch of its own.
    second["mean_distance"].values[1] += 0.02
    third["mean_distance"].values[:, 1] += 0.02
    third["mean_distance"].values[1] += 0.02
    found = attractors.merge([first.isel(attractor=slice(1, 2)), second, third])
    assert found["law"].values.tolist() == ["linearized", "nonlinear", "exponential"]
    assert found["branch"].values.tolist() == [
        [[1, -1], [1, -1], [-1, -1]],
        [[0, 1], [1, 1], [-1, -1]],
        [[0, 2], [2, 2], [-1, -1]],
    ]
    assert found["upward_branch"].values[2].tolist() == [[-1, 2], [-1, -1], [-1, -1]]
    assert found["sweep_branch"].values[2, 0].tolist() == [[0, -1, -1], [2, 2, -1]]
    np.testing.assert_array_equal(found["mean_distance"].values[0], [[0.14, np.nan], [0.15, np.nan], [np.nan] * 2])
    assert found["close_returns"].values[0].tolist() == [[8, -1], [8, -1], [-1, -1]]
    assert found["basin_count"].values[0].tolist() == [[2, 0], [1, 0], [0, 0]]
    assert "law" not in found.attrs
    assert found.attrs["samples"] == 4


def test_the_digest_tells_each_branch(one_law):
    assert attractors.digest(attractors.merge([one_law("linearized")])) == (
        "linearized, synchronized: at 1 of 3 values of a, 0.05 to 0.05; <J> 0.0000 to 0.0000; synchronized; basin "
        "fraction at most 0.250 (a = 0.05)\n"
        "linearized, branch 1: at 2 of 3 values of a, 0.05 to 0.1; <J> 0.1400 to 0.1500; quasiperiodic, chaotic; basin "
        "fraction at most 1.000 (a = 0.1)\n"
        "linearized: 5 of 12 sampled states are undetermined; no attractor at a = 0.2\n"
    )
    silent = one_law("linearized")
    silent["stop_rate"].values[..., 1:] = 0.0
    assert "(a = 0.1); block 2, 3 never sticks\n" in attractors.digest(attractors.merge([silent]))
