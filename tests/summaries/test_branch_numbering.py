"""The attractors of all laws in one file: each branch has one number and one name."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from burridge_knopoff import Model
from burridge_knopoff.attractors.lookup import side_name
from burridge_knopoff.report.tables import branch_table
from burridge_knopoff.summaries import branch_numbering
from burridge_knopoff.summaries.branch_numbering import common_branch_names, number_intermediate_branches
from burridge_knopoff.summaries.branch_rows import branch_rows
from burridge_knopoff.summaries.branch_table import ABOUT, branch_lines
from tests.summaries.continued import SETTINGS


def test_laws_are_merged_with_common_branch_numbers(one_law):
    first, second, third = (one_law(law) for law in ("linearized", "nonlinear", "exponential"))
    numbers = [{0: 0, 1: 1}, {0: 0, 1: 1}, {0: 0, 1: 2}]
    dataset = branch_numbering.merge([first.isel(attractor=slice(1, 2)), second, third], numbers)
    assert dataset["law"].values.tolist() == ["linearized", "nonlinear", "exponential"]
    assert dataset["branch"].values.tolist() == [
        [[1, -1], [1, -1], [-1, -1]],
        [[0, 1], [1, 1], [-1, -1]],
        [[0, 2], [2, 2], [-1, -1]],
    ]
    assert dataset["upward_branch"].values[2].tolist() == [[-1, 2], [-1, -1], [-1, -1]]
    assert dataset["sweep_branch"].values[2, 0].tolist() == [[0, -1, -1], [2, 2, -1]]
    np.testing.assert_array_equal(dataset["mean_distance"].values[0], [[0.14, np.nan], [0.15, np.nan], [np.nan] * 2])
    assert dataset["close_returns"].values[0].tolist() == [[8, -1], [8, -1], [-1, -1]]
    assert dataset["basin_count"].values[0].tolist() == [[2, 0], [1, 0], [0, 0]]
    assert "law" not in dataset.attrs
    assert dataset["sample_count"].values[0].tolist() == [4, 4, 4]
    assert dataset["branch_number"].values.tolist() == [0, 1, 2]


def test_branches_that_turn_into_each_other_share_a_number(monkeypatch, one_law):
    """All other branches have a unique number over all laws."""
    parts = [one_law(law) for law in ("linearized", "nonlinear", "exponential")]
    models = [Model(part.attrs["law"], a=0.0, v=0.2) for part in parts]
    answers = [{0: 0, 1: 1}, {0: 0}]

    def match_branches(firsts, seconds, first, second, settings, **_):
        assert (
            [model.parameter("a") for model in firsts]
            == [model.parameter("a") for model in seconds]
            == [0.05, 0.1, 0.2]
        )
        assert {model.law.name for model in firsts} == {"linearized"}
        assert sorted(first) == sorted(second) == [0, 1]
        # For a mirror pair, the first side.
        assert sorted(second[1]) == [0, 1]
        assert first[1][1].position[0] == pytest.approx(2.0)
        assert first[1][1].stuck.tolist() == [True, False, False]
        assert settings is SETTINGS
        return answers.pop(0)

    monkeypatch.setattr(branch_numbering, "match_branches", match_branches)
    assert branch_numbering.branch_numbers(parts, models, SETTINGS) == [{0: 0, 1: 1}, {0: 0, 1: 1}, {0: 0, 1: 2}]


def ranges(*branches, values=12):
    """Return the attractors of one law: of each branch its number, its first value of a, how many values, and <J>."""
    branch = np.full((values, len(branches)), -1)
    for slot, (number, first, count, _) in enumerate(branches):
        branch[first : first + count, slot] = number
    distance = np.where(branch >= 0, [float(item[-1]) for item in branches], np.nan)
    return xr.Dataset({"branch": (("a", "attractor"), branch), "mean_distance": (("a", "attractor"), distance)})


def test_numbers_follow_the_order_in_which_branches_appear_under_the_first_law():
    first = ranges((0, 1, 5, 0.0), (1, 1, 9, 0.3), (2, 1, 9, 0.2), (3, 8, 3, 0.1), (4, 5, 2, 0.4))
    second = ranges((0, 0, 5, 0.0), (1, 0, 9, 0.3), (5, 0, 3, 0.1))
    numbers = [{n: n for n in range(5)}, {0: 0, 1: 1, 5: 5}]
    # Synchrony; 2 before 1, since its <J> is smaller; 3; the branch of the second law alone; the short branch.
    assert branch_numbering.number_in_order([first, second], numbers) == {0: 0, 2: 1, 1: 2, 3: 3, 5: 4, 4: 5}
    # Without synchrony no other branch is 0.
    assert branch_numbering.number_in_order([ranges((3, 0, 4, 0.2), (7, 0, 4, 0.1))], [{3: 3, 7: 7}]) == {7: 1, 3: 2}


def test_without_synchrony_on_the_grid_its_number_remains_free(one_law):
    part = one_law("linearized")
    part["branch"][...] = np.where(part["branch"] == 0, -1, part["branch"])
    model = Model("linearized", a=0.0, v=0.2)
    assert branch_numbering.branch_numbers([part], [model], SETTINGS) == [{1: 1}]


@given(st.lists(st.tuples(st.integers(0, 8), st.integers(1, 2)), max_size=4))
def test_branches_found_by_a_deeper_search_do_not_renumber_long_branches(short):
    lasting = (0, 0, 5, 0.0), (1, 3, 4, 0.2), (2, 1, 9, 0.3), (3, 6, 3, 0.4)
    extra = [(10 + k, first, count, 0.05 * k) for k, (first, count) in enumerate(short)]
    numbers = [{number: number for number, *_ in (*lasting, *extra)}]
    order = branch_numbering.number_in_order([ranges(*lasting, *extra)], numbers)
    assert [order[number] for number, *_ in lasting] == [0, 2, 1, 3]
    assert sorted(order.values()) == list(range(4 + len(extra)))


@pytest.mark.parametrize(
    ("name", "side", "expected"),
    [
        ("synchronized", 0, "synchronized"),
        ("alternating (7)", 0, "alternating (7)"),
        ("alternating (7)", 1, "alternating, symmetry broken (7+)"),
        ("mirror pair, block 2 never sticks (12)", -1, "mirror pair, block 2 never sticks (12−)"),
    ],
)
def test_the_name_of_a_motion_on_one_side_is_mirror_pair(name, side, expected):
    assert side_name(name, side) == expected


def test_the_digest_describes_each_branch(one_law):
    dataset = branch_numbering.merge([one_law("linearized")], [{0: 0, 1: 1}])
    head = "linearized law: 2 branches at 3 values of a; 5 of 12 sampled states are undetermined"
    rows = [
        "branch           a         count  <J>            motion                          basin",
        "synchronized     0.05      1      0.0000         synchronized                    0.250",
        "mirror pair (1)  0.05-0.1  2      0.1400-0.1500  quasiperiodic, transient chaos  1.000",
    ]
    assert branch_numbering.digest(dataset).splitlines() == [ABOUT, "", f"{head}; no attractor at a = 0.2", *rows]
    dataset["sliding_attracts"][0, 2] = 1
    sliding = "no attractor at a = 0.2; uniform sliding attracts at a = 0.2"
    assert branch_numbering.digest(dataset).splitlines()[2:] == [f"{head}; {sliding}", *rows]
    assert max(map(len, branch_lines(dataset, 80))) <= 80


def test_the_digest_of_a_law_without_attractors(one_law):
    dataset = branch_numbering.merge([one_law("linearized")], [{0: 0, 1: 1}])
    dataset["branch"][...] = -1
    lines = branch_numbering.digest(dataset).splitlines()
    assert lines[2].startswith("linearized law: 0 branches at 3 values of a; ")
    assert lines[2].endswith("no attractor at a = 0.05, 0.1, 0.2")
    assert len(lines) == 3


def test_the_largest_basin_fraction_is_taken_where_the_branch_exists(one_law):
    dataset = branch_numbering.merge([one_law("linearized")], [{0: 0, 1: 1}])
    dataset["basin_fraction"][...] = dataset["basin_fraction"] * 0.0
    assert list(branch_rows(dataset))[1].fraction == (0.0, 0.05)
    dataset["branch"][0, 0] = [0, -1]
    assert list(branch_rows(dataset))[1].fraction == (0.0, 0.1)


def test_text_and_report_name_the_first_of_equal_basin_fractions(one_law):
    """0.1 + 0.2 is more than 0.3 in floating point."""
    dataset = branch_numbering.merge([one_law("linearized")], [{0: 0, 1: 1}])
    dataset["basin_fraction"][0] = np.array([[0.6, 0.3], [0.1, 0.2], [np.nan, np.nan]])
    dataset["basin_count"][0] = np.array([[6, 3], [1, 2], [-1, -1]])
    dataset["sample_count"][0] = 10
    assert [f"{row.fraction[0]:.3f}" for row in branch_rows(dataset)] == ["0.600", "0.300"]
    assert [row["fraction"] for row in branch_table(dataset)] == ["0.600 (a = 0.05)", "0.300 (a = 0.05)"]


def test_a_branch_at_inserted_values_has_its_own_number():
    numbers = [{0: 0, 1: 1, 4: 4}, {0: 0, 2: 1, 3: 5}]
    branches = [[0, 1], [3, -1], [4, 2]], [[0, 2], [3, 1], [-1, 9]]
    parts = [xr.Dataset({"branch": (("value", "attractor"), np.array(part))}) for part in branches]
    assert number_intermediate_branches(numbers, parts) == [
        {0: 0, 1: 1, 4: 4, 2: 6, 3: 7},
        {0: 0, 2: 1, 3: 5, 1: 8, 9: 9},
    ]
    assert numbers == [{0: 0, 1: 1, 4: 4}, {0: 0, 2: 1, 3: 5}]


def named_branches(names):
    names_variable = np.array(list(names.values()), dtype=object), {"long_name": "what it is called"}
    return xr.Dataset({"branch_number": ("number", list(names)), "branch_name": ("number", *names_variable)})


def test_names_are_determined_at_the_values_of_the_grid():
    dataset = common_branch_names(
        named_branches({0: "synchronized", 3: "alternating (3)", 7: "mirror pair (7)"}), named_branches({3: "pair (3)"})
    )
    assert dataset["branch_name"].values.tolist() == ["synchronized", "pair (3)", "mirror pair (7)"]
    assert dataset["branch_name"].attrs == {"long_name": "what it is called"}
