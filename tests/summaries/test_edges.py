"""The list of edges: every beginning, end and change of a branch has an entry, on any grid of a."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff import Chain, Model, law_of
from burridge_knopoff.stability.edge_kind import EdgeKind
from burridge_knopoff.stability.motion import MotionKind
from burridge_knopoff.summaries.branch_changes import Change, branch_changes
from burridge_knopoff.summaries.edges import VARIABLES, _rounded, merge, one_law

# Not evenly spaced. Synchrony is lost between the second and the third, and what follows becomes chaotic.
A = [0.05, 0.08, 0.0875, 0.1, 0.13]
SLOT = ("law", "a", "attractor")
#: Branch, kind, symmetry and section period at each a, and U − vτ and U' of a state on the closed orbits.
ROWS = [
    (0, MotionKind.SYNCHRONIZED, 0, 1),
    (0, MotionKind.SYNCHRONIZED, 0, 1),
    (1, MotionKind.PERIODIC, 2, 1),
    (1, MotionKind.PERIODIC, 2, 1),
    (1, MotionKind.CHAOTIC, 2, 0),
]


def attractors():
    """Return the attractors of one law: one at each a, whose state is that of a long run from the paper's `minus`."""
    from burridge_knopoff import InitialState
    from burridge_knopoff.running.runner import Runner
    from burridge_knopoff.running.status import Status

    position, velocity = [], []
    minus = InitialState("minus", (-0.989, -0.993, -0.991), (0.099, 0.1012, 0.1023))
    for a in A:
        model = Model(Chain(3), law_of("linearized", a))
        runner = Runner(model)
        runner.begin(model.begin(minus))
        runner.run(8000.0)
        assert runner.run(9000.0, halting_block=0) == Status.HALTED
        position.append(runner.instant().position + model.sliding_offset)
        velocity.append(runner.instant().velocity)
    branch, kind, symmetry, period = (np.array(column).reshape(1, -1, 1) for column in zip(*ROWS, strict=True))
    reached = np.array([0, 1, 1, 1, -1]).reshape(1, -1, 1), np.array([-1, 0, 0, 1, 1]).reshape(1, -1, 1)
    return xr.Dataset(
        {
            "branch": (SLOT, branch),
            "side": (SLOT, np.zeros_like(branch)),
            "kind": (SLOT, kind),
            "symmetry": (SLOT, symmetry),
            "section_period": (SLOT, period),
            "upward_branch": (SLOT, reached[0]),
            "downward_branch": (SLOT, reached[1]),
            "position": ((*SLOT, "block"), np.array(position)[None, :, None, :]),
            "velocity": ((*SLOT, "block"), np.array(velocity)[None, :, None, :]),
        },
        {"law": ["linearized"], "a": A, "block": [1, 2, 3]},
    )


def at_all_values(found):
    """Return attractors of the grid as those at all values of a, chaos with a lifetime, and one value missing."""
    values = found.rename(a="value").drop_vars(["upward_branch", "downward_branch", "value"])
    missing = xr.zeros_like(values.isel(value=[0]))
    missing["branch"] -= 1
    values = xr.concat([values, missing], "value")
    values["a"] = ("law", "value"), [[*A, np.nan]]
    values["in_grid"] = ("law", "value"), [[1] * len(A) + [-1]]
    for name, low in (("lifetime_low", 1e5), ("lifetime_high", np.inf)):
        values[name] = xr.where(values["kind"] == MotionKind.CHAOTIC, low, np.nan)
    return values


@pytest.fixture(scope="module")
def grid():
    return attractors()


@pytest.fixture(scope="module")
def found(grid):
    return one_law(
        Model(Chain(3), law_of("linearized", 0.1)), *(one.isel(law=0) for one in (grid, at_all_values(grid)))
    )


def test_what_branches_do(grid):
    changes = branch_changes(grid.isel(law=0), at_all_values(grid).isel(law=0))
    assert [(change.low, change.high, change.change, change.from_branch, change.to_branch) for change in changes] == [
        (1, 2, Change.END, 0, 1),
        (1, 2, Change.BEGINNING, 0, 1),
        (3, 4, Change.CHANGE, 1, 1),
    ]


def told(rows, in_grid):
    """Return the attractors at all values of a of one law, and at those of the grid: for each value {branch: kind}."""
    kind = np.full((len(rows), 2), -1)
    branch = np.full((len(rows), 2), -1)
    for k, row in enumerate(rows):
        for slot, number in enumerate(row):
            branch[k, slot], kind[k, slot] = number, row[number]
    zero = ("value", "attractor"), np.zeros_like(kind)
    values = xr.Dataset(
        {
            "a": ("value", np.arange(float(len(rows)))),
            "in_grid": ("value", np.array(in_grid)),
            "branch": (zero[0], branch),
            "kind": (zero[0], kind),
            **dict.fromkeys(("side", "symmetry", "section_period"), zero),
        }
    )
    count = sum(in_grid)
    reached = [[10 * (k + 1), 10 * (k + 1) + 1] for k in range(count)]
    there = xr.Dataset(dict.fromkeys(("upward_branch", "downward_branch"), (("a", "attractor"), reached)))
    return there, values


@pytest.mark.parametrize(
    ("rows", "in_grid", "expected"),
    [
        # Between values of the grid what does not change is not looked for.
        ([{1: 1}, {}, {1: 1}], [1, 0, 1], []),
        ([{1: 1}, {}, {1: 1}], [1, 1, 1], [(0, 1, 1, 10, Change.END), (1, 2, 30, 1, Change.BEGINNING)]),
        # A change between two that are near, however many values lie between.
        ([{1: 1}, {1: 1}, {2: 3}, {1: 3}, {1: 3}], [1, 0, 0, 0, 1], [
            (1, 2, -1, 2, Change.BEGINNING), (1, 3, 1, 1, Change.CHANGE), (2, 3, 2, -1, Change.END),
        ]),
        # What ends within a step is reached from the value of the grid below.
        ([{2: 1, 1: 1}, {1: 1}, {2: 1}], [1, 0, 1], [(1, 2, 1, 11, Change.END)]),
        ([{2: 1}, {1: 1}, {2: 1, 1: 1}], [1, 0, 1], [(0, 1, 21, 1, Change.BEGINNING)]),
    ],
)  # fmt: skip
def test_what_branches_do_between_values_of_the_grid(rows, in_grid, expected):
    changes = branch_changes(*told(rows, in_grid))
    assert [
        (change.low, change.high, change.from_branch, change.to_branch, change.change) for change in changes
    ] == expected


def test_every_change_has_an_entry(grid, found):
    for change in branch_changes(grid.isel(law=0), at_all_values(grid).isel(law=0)):
        same = (found["change"] == change.change) & (found["from_branch"] == change.from_branch)
        same &= (found["grid_low"] == A[change.low]) & (found["grid_high"] == A[change.high])
        assert (same & (found["to_branch"] == change.to_branch)).any()


def test_the_lifetime_of_chaos_is_told_beside_its_edges(found):
    chaotic = (found["motion_before"] == MotionKind.CHAOTIC) | (found["motion_after"] == MotionKind.CHAOTIC)
    assert 0 < int(chaotic.sum()) < found.sizes["edge"]
    assert (found["lifetime_low"].values[chaotic] == 1e5).all()
    assert (found["lifetime_high"].values[chaotic] == np.inf).all()
    assert np.isnan(found["lifetime_low"].values[~chaotic]).all()


def test_edges_are_those_of_the_orbits(found):
    kind, a = found["kind"].values, found["a"].values
    assert a[kind == EdgeKind.PITCHFORK] == pytest.approx([0.0869729046661] * 2, abs=1e-10)
    assert found["multiplier"].values[kind == EdgeKind.PITCHFORK].tolist() == [[1.0, 0.0]] * 2
    grazing = found.isel(edge=np.flatnonzero((kind == EdgeKind.GRAZING) & (found["change"].values == Change.CHANGE)))
    assert grazing["a"].values == pytest.approx([0.1122215462], abs=1e-9)
    assert grazing["stops"].values.tolist() in ([[1, 1, 1]],)
    assert grazing["stick_time"].item() == 0.0
    assert np.hypot(*grazing["multiplier"].values[0]) < 1.0 < np.hypot(*grazing["multiplier_beyond"].values[0])
    assert (found["a_error"].values <= 1e-9).all()


def test_numbers_are_rounded(found):
    for name in ("a", "period", "orbit_a", "orbit_mean_distance"):
        values = found[name].values
        assert [float(f"{value:.9e}") for value in values] == values.tolist()
        assert [float(f"{value:.8e}") for value in values] != values.tolist()


def test_next_to_0_eleven_digits_behind_the_point_are_kept():
    values = _rounded(VARIABLES["stick_time"], [1.23456789e-7, 1.23456789e-2, 4e-12], 5)
    assert values.tolist() == [1.2346e-7, 1.2346e-2, 0.0]
    assert _rounded(VARIABLES["a"], [1.23456789e-8], 10).tolist() == [1.235e-8]


def test_orbits_are_stable_on_one_side_of_the_edge(found):
    stable = found["orbit_stable"].values == 1
    assert stable.any()
    assert (~stable).any()
    assert (found["orbit_period"].values > 0.0).all()


def test_an_edge_without_an_orbit_has_no_numbers_of_one(grid):
    """Chaos on both sides of every edge: none is located, and each lies anywhere between two values of a."""
    chaotic = grid.assign(kind=xr.full_like(grid["kind"], MotionKind.CHAOTIC))
    model = Model(Chain(3), law_of("linearized", 0.1))
    found = one_law(model, *(one.isel(law=0) for one in (chaotic, at_all_values(chaotic))))
    assert found.sizes["orbit"] == 0
    assert found["a"].values == pytest.approx([0.08375] * 2)
    assert found["a_error"].values == pytest.approx([0.00375] * 2)
    for name in ("stops", "stops_beyond"):
        assert (found[name].values == -1).all()
    assert (found["turns"].values == -1).all()
    for name in ("period", "mean_distance", "stick_time", "multiplier", "multiplier_beyond"):
        assert np.isnan(found[name].values).all()


def test_edges_of_laws_come_one_after_the_other(found):
    other = found.isel(edge=[1], orbit=[0, 2]).assign_attrs(laws="mine")
    both = merge([found, other])
    assert both.attrs["laws"] == "linearized mine"
    assert both["law"].values.tolist() == [0] * found.sizes["edge"] + [1]
    assert both["orbit_law"].values.tolist() == [0] * found.sizes["orbit"] + [1, 1]
    assert both["law"].attrs["flag_meanings"] == both["orbit_law"].attrs["flag_meanings"] == "linearized mine"
    np.testing.assert_array_equal(both["a"].values, [*found["a"].values, other["a"].item()])
    np.testing.assert_array_equal(both["orbit_stops"].values[-2:], other["orbit_stops"].values)
