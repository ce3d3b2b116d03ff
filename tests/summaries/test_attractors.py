"""Attractors along a: the summary and the text of a hand-made continuation of two laws."""

from dataclasses import replace

import numpy as np
import pytest

from burridge_knopoff import InitialState, Model, MotionKind, SearchSettings, Symmetry
from burridge_knopoff.attractors.lifetime import Lifetime
from burridge_knopoff.attractors.table import name_branches, slot_values
from burridge_knopoff.continuation.attractor_continuation import continue_attractors
from burridge_knopoff.continuation.settings import RefinementSettings
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.model.sampling import fraction_interval
from burridge_knopoff.motion.settings import MOTION
from burridge_knopoff.summaries import attractors, branch_numbering, refined
from tests.summaries.continued import SETTINGS, STATES, continuation


def test_features_are_sorted_by_branch_and_side(one_law):
    dataset = one_law("linearized")
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
        # Only the four sampled states count.
        "basin_count": [[1, 2], [3, 1], [0, 0]],
        "basin_fraction": [[0.25, 0.5], [0.75, 0.25], [nan, nan]],
        "basin_fraction_low": [[fraction_interval(n, 4)[1] for n in row] for row in ([1, 2], [3, 1])] + [[nan, nan]],
        "basin_fraction_high": [[fraction_interval(n, 4)[2] for n in row] for row in ([1, 2], [3, 1])] + [[nan, nan]],
    }
    for name, values in expected.items():
        np.testing.assert_array_equal(dataset[name].values, values, name)
    assert dataset["undetermined_count"].values.tolist() == [1, 0, 4]
    assert dataset["stop_rate"].values[0].tolist() == [[0.1, 0.2, 0.1], [0.1, 0.0, 0.3]]
    np.testing.assert_array_equal(dataset["lyapunov_exponent"].values[1], [[0.03, 0.0, nan]] * 2)
    # U of the last return: its x plus uniform sliding, −5/6, −2/3, −5/6 times the friction 1 − av.
    assert dataset["position"].values[1, 0] == pytest.approx([2.0 - 0.98 * 5 / 6, -0.98 * 2 / 3, -0.98 * 5 / 6])
    assert dataset["velocity"].values[0, 0].tolist() == [0.0, 0.5, 0.25]
    assert dataset["block"].values.tolist() == [1, 2, 3]
    header = {"law": "linearized", "v": 0.2, "contact": "one_sided", "start": "tested", "seed": 1}
    assert {key: dataset.attrs[key] for key in header} == header


def test_there_are_as_many_slots_as_attractors_at_one_a():
    """There is one slot if there is never more than one attractor, and also if there is none."""
    both = continuation("linearized")
    for count in (1, 0):
        names = ("attractors", "lifetimes", "branch", "side")
        few = {name: [row[:count] for row in getattr(both, name)] for name in names}
        few["upward"] = few["downward"] = [np.full(len(both.attractors[k][:count]), -1) for k in both.grid]
        dataset = attractors.one_law(replace(both, **few), STATES, SETTINGS, MOTION, "tested")
        assert dataset.sizes["attractor"] == 1
        for name in ("branch", "upward_branch", "downward_branch", "basin_count", "mean_distance"):
            assert dataset[name].shape == (3, 1)


def test_what_initial_states_and_sweeps_reach(one_law):
    dataset = one_law("linearized")
    reached, side = dataset["initial_branch"], dataset["initial_side"]
    for contact in ("one_sided", "symmetric"):
        for start, branches in (("moving", [0, 1, -1]), ("tested", [-1, -1, -1])):
            where = {"contact": contact, "start": start}
            assert reached.sel(initial="here", **where).values.tolist() == branches
            # A block that moves backward is allowed under a symmetric contact only.
            back = [0, 1, -1] if contact == "symmetric" else [-1, -1, -1]
            assert reached.sel(initial="back", **where).values.tolist() == back
            assert side.sel(initial="here", **where).values.tolist() == [0, int(start == "moving"), 0]
    # Upward from a = 0.05 in the order of the branches; downward from a = 0.1, the largest a with attractors.
    assert dataset["sweep_branch"].sel(direction="upward").values.tolist() == [[0, -1, -1], [1, 1, -1]]
    assert dataset["sweep_branch"].sel(direction="downward").values.tolist() == [[1, 1, -1], [1, 1, -1]]
    mean = dataset["sweep_mean_distance"]
    np.testing.assert_array_equal(mean.sel(direction="upward"), [[0.0, np.nan, np.nan], [0.14, 0.15, np.nan]])
    np.testing.assert_array_equal(mean.sel(direction="downward"), [[0.14, 0.15, np.nan]] * 2)


def test_rounded_states_are_the_corners_of_a_box_around_an_initial_state():
    state = PAPER_STATES["plus"]
    numbers = np.array([*state.position, *state.velocity])
    states = attractors.corners(state, "one_sided", 3)
    shifts = np.array([[*corner.position, *corner.velocity] for corner in states]) - numbers
    assert np.abs(shifts) == pytest.approx(5e-4)
    assert len({tuple(row) for row in np.sign(shifts)}) == 64
    # With one-sided contact no block starts with a backward velocity.
    rest = InitialState("rest", (0.0, 0.0, 0.0), (0.0, 0.0, 0.1))
    assert min(velocity for corner in attractors.corners(rest, "one_sided", 3) for velocity in corner.velocity) == 0.0
    assert min(velocity for corner in attractors.corners(rest, "symmetric", 3) for velocity in corner.velocity) == -5e-4
    four = InitialState("four", (0.0,) * 4, (0.1,) * 4)
    assert len({corner.position + corner.velocity for corner in attractors.corners(four, "one_sided", 4)}) == 64


def test_plus_lies_next_to_a_boundary_at_0_05_and_not_at_0_08():
    """Linearized: at 0.05 some states that round to plus synchronize, which plus does not."""
    search = SearchSettings(samples=12, fraction_width=0.5, transient=1000, window=1000, seed=3)
    models = [Model("linearized", a=a) for a in (0.05, 0.08)]
    states = [PAPER_STATES["minus"], PAPER_STATES["plus"]]
    along_a = continue_attractors(models, search, refine=RefinementSettings(1.0), starts=states)
    dataset = attractors.one_law(along_a, states, search, MOTION, "moving")
    exact = dataset["initial_branch"].sel(contact="one_sided", start="moving").values
    rounded = dataset["rounded_branch"].values
    assert (rounded[0] == exact[0][:, None]).all()
    assert (rounded[1, 1] == exact[1, 1]).all()
    differing = rounded[1, 0][rounded[1, 0] != exact[1, 0]]
    assert 10 < len(differing) < 30
    assert set(differing) == {0}


def test_chaos_that_is_shown_to_last_is_chaos():
    lasting = replace(continuation("linearized"), lifetimes=[[None] * 2, [None], [Lifetime(0, 1e5)] * 2, []])
    dataset = attractors.one_law(lasting, STATES, SETTINGS, MOTION, "tested")
    assert dataset["kind"].values[1].tolist() == [MotionKind.CHAOTIC] * 2
    assert np.isinf(dataset["lifetime"].values[1]).all()


def test_all_values_of_a_are_in_the_refined_file():
    arguments = (SETTINGS, MOTION, RefinementSettings(1e-3), "tested")
    parts = [refined.one_law(continuation(law), *arguments) for law in ("linearized", "nonlinear")]
    parts[1] = parts[1].isel(value=slice(0, 2))
    dataset = branch_numbering.merge(parts, [{0: 0, 1: 1}, {0: 0, 1: 5}], refined.VARIABLES, "Refined")
    np.testing.assert_array_equal(dataset["a"].values, [[0.05, 0.07, 0.1, 0.2], [0.05, 0.07, np.nan, np.nan]])
    assert dataset["in_grid"].values.tolist() == [[1, 0, 1, 1], [1, 0, 0, 0]]
    assert dataset["branch"].values.tolist() == [
        [[0, 1], [1, -1], [1, 1], [-1, -1]],
        [[0, 5], [5, -1], [-1, -1], [-1, -1]],
    ]
    assert dataset["kind"].values[0, 2].tolist() == [MotionKind.TRANSIENT_CHAOS] * 2
    assert dataset.attrs["refine_resolution"] == 1e-3
    assert dataset["branch_number"].values.tolist() == [0, 1, 5]


def test_branches_are_named_by_symmetry_and_sticks():
    branch = np.array([[[0, 1], [2, 2]], [[3, 3], [4, -1]]])
    none, symmetric, pair = Symmetry.SYNCHRONIZED, Symmetry.SYMMETRIC, Symmetry.ASYMMETRIC
    symmetry = np.array([[[none, symmetric], [pair, pair]], [[pair, pair], [pair, -1]]])
    rate = np.ones((2, 2, 2, 3))
    rate[branch == 1] = [0.2, 0.0, 0.2]
    rate[branch == 3] = [0.0, 0.1, 0.0]
    names = name_branches(branch, symmetry, rate, np.ones_like(branch))
    assert names["branch_number"].tolist() == [0, 1, 2, 3, 4]
    assert names["branch_name"].tolist() == [
        "synchronized",
        "alternating, block 2 never sticks (1)",
        "mirror pair (2)",
        "mirror pair, blocks 1, 3 never stick (3)",
        "motion (4)",
    ]


def test_a_single_value_of_a_has_slots_too():
    branches = continuation("linearized")
    values = slot_values(branches.models[:1], [branches.rows(0)], 1e5, "a")
    assert values["stop_rate"].shape == (1, 2, 3)
    assert values["branch"].tolist() == [[0, 1]]
