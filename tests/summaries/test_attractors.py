"""Attractors along a: what a hand-made continuation of two laws becomes in the summary and in its lines."""

from dataclasses import replace

import numpy as np
import pytest

from burridge_knopoff import Chain, InitialState, Model, law_of
from burridge_knopoff.stability.attractor import Symmetry
from burridge_knopoff.stability.continuation import Continuation
from burridge_knopoff.stability.lifetime import Lifetime
from burridge_knopoff.stability.motion import MotionKind
from burridge_knopoff.stability.sampling import fraction_interval
from burridge_knopoff.stability.settings import MOTION, Refine, SearchSettings
from burridge_knopoff.summaries import attractors, refined
from burridge_knopoff.summaries.slots import branch_names
from tests.stability.stand_in import stand_in

STATES = [InitialState("here", (0.0,) * 3, (0.1,) * 3), InitialState("back", (0.0,) * 3, (0.1, -0.1, 0.1))]
SETTINGS = SearchSettings(samples=9, fraction_samples=4, time_limit=123.0, lifetime=500.0)


def continuation(law):
    """Return synchrony and a torus, then a mirror pair that the torus turns into, then nothing.

    Between the first two values of the grid one was put in, at which the torus alone was followed.
    """
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
    between = [stand_in(Symmetry.SYMMETRIC, 0.145, 0, 0.5, **torus)]
    pair = {"kind": MotionKind.CHAOTIC, "exponent": np.array([0.03, 0.0])}
    second = [stand_in(Symmetry.ASYMMETRIC, 0.15, 1, -2.0, **pair), stand_in(Symmetry.ASYMMETRIC, 0.15, 0, 2.0, **pair)]
    numbers = [([1, 0], [0, 0]), ([1], [0]), ([1, 1], [-1, 1]), ([], [])]
    dying = Lifetime(4, 1200.0)
    return Continuation(
        [Model(Chain(3), law_of(law, a), 0.2) for a in (0.05, 0.07, 0.1, 0.2)],
        [0, 2, 3],
        [first, between, second, []],
        lifetimes=[[None, None], [None], [dying, dying], []],
        branch=[np.array(branch) for branch, _ in numbers],
        side=[np.array(side) for _, side in numbers],
        upward=[np.array([1, -1]), np.array([-1, -1]), np.zeros(0, int)],
        downward=[np.array([-1, -1]), np.array([0, 0]), np.zeros(0, int)],
        samples=[np.array([0, 0, 1, -1]), np.array([1, 1, 1, 0]), np.full(4, -1)],
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

    monkeypatch.setattr(attractors, "label", label)
    return lambda law: attractors.one_law(continuation(law), STATES, SETTINGS, MOTION, "tested")


def test_features_are_sorted_by_branch_and_side(one_law):
    found = one_law("linearized")
    nan, none = np.nan, [-1, -1]
    expected = {
        "branch": [[0, 1], [1, 1], none],
        "side": [[0, 0], [1, -1], [0, 0]],
        "symmetry": [[Symmetry.SYNCHRONIZED, Symmetry.SYMMETRIC], [Symmetry.ASYMMETRIC, Symmetry.ASYMMETRIC], none],
        "mean_distance": [[0.0, 0.14], [0.15, 0.15], [nan, nan]],
        "mean_distance_error": [[0.0, 1e-3], [0.0, 0.0], [nan, nan]],
        "kind": [[MotionKind.SYNCHRONIZED, MotionKind.QUASIPERIODIC], [MotionKind.TRANSIENT_CHAOS] * 2, none],
        "lifetime": [[nan, nan], [300.0, 300.0], [nan, nan]],
        "lifetime_low": [[nan, nan], [Lifetime(4, 1200.0).interval[0]] * 2, [nan, nan]],
        "lifetime_high": [[nan, nan], [Lifetime(4, 1200.0).interval[1]] * 2, [nan, nan]],
        "section_period": [[1, 0], [1, 1], [0, 0]],
        "radius": [[0.02, 0.01], [0.01, 0.01], [nan, nan]],
        "close_returns": [[20, 8], [8, 8], none],
        "patience": [[0.0, 0.0], [0.0, 0.0], [np.nan, np.nan]],
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


def test_chaos_that_is_shown_to_last_is_chaos(one_law):
    lasting = replace(continuation("linearized"), lifetimes=[[None] * 2, [None], [Lifetime(0, 1e5)] * 2, []])
    found = attractors.one_law(lasting, STATES, SETTINGS, MOTION, "tested")
    assert found["kind"].values[1].tolist() == [MotionKind.CHAOTIC] * 2
    assert np.isinf(found["lifetime"].values[1]).all()


def test_laws_are_put_together_under_common_numbers(one_law):
    first, second, third = (one_law(law) for law in ("linearized", "nonlinear", "exponential"))
    numbers = [{0: 0, 1: 1}, {0: 0, 1: 1}, {0: 0, 1: 2}]
    found = attractors.merge([first.isel(attractor=slice(1, 2)), second, third], numbers)
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
    assert found.attrs["fraction_samples"] == 4
    assert found["branch_number"].values.tolist() == [0, 1, 2]


def test_branches_that_turn_into_each_other_share_a_number(monkeypatch, one_law):
    """All others have one of their own, over all laws."""
    parts = [one_law(law) for law in ("linearized", "nonlinear", "exponential")]
    models = [Model(Chain(3), law_of(part.attrs["law"], 0.0), 0.2) for part in parts]
    answers = [{0: 0, 1: 1}, {0: 0}]

    def joined(firsts, seconds, first, second, settings):
        assert [model.a for model in firsts] == [model.a for model in seconds] == [0.05, 0.1, 0.2]
        assert {model.law.name for model in firsts} == {"linearized"}
        assert sorted(first) == sorted(second) == [0, 1]
        # Of a mirror pair the side that counts as the first.
        assert sorted(second[1]) == [0, 1]
        assert first[1][1].position[0] == pytest.approx(2.0)
        assert first[1][1].stuck.tolist() == [True, False, False]
        assert settings is SETTINGS
        return answers.pop(0)

    monkeypatch.setattr(attractors, "joined", joined)
    assert attractors.branch_numbers(parts, models, SETTINGS) == [{0: 0, 1: 1}, {0: 0, 1: 1}, {0: 0, 1: 2}]


def test_the_digest_tells_each_branch(one_law):
    found = attractors.merge([one_law("linearized")], [{0: 0, 1: 1}])
    assert attractors.digest(found) == (
        "linearized, synchronized: at 1 of 3 values of a, 0.05 to 0.05; <J> 0.0000 to 0.0000; synchronized; basin "
        "fraction at most 0.250 (a = 0.05)\n"
        "linearized, mirror pair (1): at 2 of 3 values of a, 0.05 to 0.1; <J> 0.1400 to 0.1500; quasiperiodic, "
        "transient chaos; basin fraction at most 1.000 (a = 0.1)\n"
        "linearized: 5 of 12 sampled states are undetermined; no attractor at a = 0.2\n"
    )


def test_the_values_put_in_between_have_a_file_of_their_own():
    parts = [
        refined.one_law(continuation(law), SETTINGS, MOTION, Refine(1e-3), "tested")
        for law in ("linearized", "nonlinear")
    ]
    found = refined.merge([parts[0], parts[1].isel(value=slice(0, 2))], [{0: 0, 1: 1}, {0: 0, 1: 5}])
    np.testing.assert_array_equal(found["a"].values, [[0.05, 0.07, 0.1, 0.2], [0.05, 0.07, np.nan, np.nan]])
    assert found["in_grid"].values.tolist() == [[1, 0, 1, 1], [1, 0, 0, 0]]
    assert found["branch"].values.tolist() == [
        [[0, 1], [1, -1], [1, 1], [-1, -1]],
        [[0, 5], [5, -1], [-1, -1], [-1, -1]],
    ]
    assert found["kind"].values[0, 2].tolist() == [MotionKind.TRANSIENT_CHAOS] * 2
    assert found.attrs["refine_resolution"] == 1e-3
    assert found["branch_number"].values.tolist() == [0, 1, 5]


def test_branches_have_names_that_say_what_they_are():
    branch = np.array([[[0, 1], [2, 2]], [[3, 3], [4, -1]]])
    none, symmetric, pair = Symmetry.SYNCHRONIZED, Symmetry.SYMMETRIC, Symmetry.ASYMMETRIC
    symmetry = np.array([[[none, symmetric], [pair, pair]], [[pair, pair], [pair, -1]]])
    rate = np.ones((2, 2, 2, 3))
    rate[branch == 1] = [0.2, 0.0, 0.2]
    rate[branch == 3] = [0.0, 0.1, 0.0]
    names = branch_names(branch, symmetry, rate)
    assert names["branch_number"].tolist() == [0, 1, 2, 3, 4]
    assert names["branch_name"].tolist() == [
        "synchronized",
        "alternating, block 2 never sticks (1)",
        "mirror pair (2)",
        "mirror pair, block 1, 3 never sticks (3)",
        "motion (4)",
    ]
