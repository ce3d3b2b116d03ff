"""The list of bifurcations: every beginning, end and change of a branch has an entry, on any grid of a."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff import (
    BifurcationKind,
    ChainState,
    Model,
    MotionKind,
    OrbitError,
    limit_cycle,
    multipliers,
    synchronized_orbit,
)
from burridge_knopoff.continuation.bifurcations import entries
from burridge_knopoff.continuation.branch_changes import Change, branch_changes
from burridge_knopoff.continuation.followed_orbits import FollowedOrbits, _periodic_orbit
from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status
from burridge_knopoff.summaries import bifurcations
from burridge_knopoff.summaries.bifurcations import _branches_of_segments, _round_digits, listing, merge, one_law

# Not evenly spaced. Synchrony is lost between the second and third value; its successor becomes chaotic.
A = [0.05, 0.08, 0.0875, 0.1, 0.13]
#: Properties of the attractor at each a.
FEATURES = {
    "branch": [0, 0, 1, 1, 1],
    "side": [0] * 5,
    "kind": [MotionKind[kind] for kind in ("SYNCHRONIZED", "SYNCHRONIZED", "PERIODIC", "PERIODIC", "CHAOTIC")],
    "symmetry": [0, 0, 2, 2, 2],
    "section_period": [1, 1, 1, 1, 0],
    "period": [5.7, 5.7, 5.7, 5.7, np.nan],
    "upward_branch": [0, 1, 1, 1, -1],
    "downward_branch": [-1, 0, 0, 1, 1],
}
MODEL = Model("linearized", a=0.1)


@pytest.fixture(scope="module")
def grid():
    """Attractors of one law: one at each a, whose state is that of a long run from the paper's `minus`."""
    states = []
    for model in [MODEL.at(a=a) for a in A]:
        runner = Runner(model)
        runner.begin(model.begin(PAPER_STATES["minus"]))
        runner.run(8000.0)
        assert runner.run(9000.0, halting_block=0) == Status.HALTED
        states.append((runner.state().position + model.sliding_offset, runner.state().velocity))
    attractors = xr.Dataset({name: ("a", values) for name, values in FEATURES.items()}, {"a": A, "block": [1, 2, 3]})
    for name, values in zip(("position", "velocity"), zip(*states, strict=True), strict=True):
        attractors[name] = ("a", "block"), np.array(values)
    return attractors.expand_dims("attractor", 1).assign_coords(law="linearized")


def at_all_values(attractors):
    """Return attractors of the grid as those at all values of a, chaos with a lifetime, and one value missing."""
    values = attractors.rename(a="value").drop_vars(["upward_branch", "downward_branch", "value"])
    missing = xr.zeros_like(values.isel(value=[0]))
    missing["branch"] -= 1
    values = xr.concat([values, missing], "value")
    values["a"] = "value", [*A, np.nan]
    values["in_grid"] = "value", [1] * len(A) + [-1]
    for name, low in (("lifetime_low", 1e5), ("lifetime_high", np.inf)):
        values[name] = xr.where(values["kind"] == MotionKind.CHAOTIC, low, np.nan)
    return values.assign_attrs(refine_longest_period=500.0, refine_resolution=1e-4)


@pytest.fixture(scope="module")
def dataset(grid):
    return one_law(MODEL, grid, at_all_values(grid))


def test_beginnings_ends_and_changes_of_branches(grid):
    expected = [(1, 2, 0, 1, Change.END), (1, 2, 0, 1, Change.BEGINNING), (3, 4, 1, 1, Change.CHANGE)]
    assert fields_of(branch_changes(grid, at_all_values(grid))) == expected


def fields_of(changes):
    names = ("low", "high", "from_branch", "to_branch", "change")
    return [tuple(getattr(change, name) for name in names) for change in changes]


def attractors_of(rows, in_grid):
    """Return the attractors at all values of a of one law, and at those of the grid: for each value {branch: kind}."""
    filled = np.array([[*row.items(), (-1, -1), (-1, -1)][:2] for row in rows])
    slots = {"branch": filled[..., 0], "kind": filled[..., 1]}
    slots |= dict.fromkeys(("side", "symmetry", "section_period"), np.zeros((len(rows), 2), int))
    slots["period"] = np.full((len(rows), 2), np.nan)
    values = xr.Dataset({name: (("value", "attractor"), item) for name, item in slots.items()})
    values.attrs["refine_longest_period"] = 500.0
    values = values.assign(a=("value", np.arange(float(len(rows)))), in_grid=("value", in_grid))
    reached = [[10 * k, 10 * k + 1] for k in range(1, sum(in_grid) + 1)]
    sweeps = xr.Dataset(dict.fromkeys(("upward_branch", "downward_branch"), (("a", "attractor"), reached)))
    return sweeps, values


@pytest.mark.parametrize(
    ("rows", "in_grid", "expected"),
    [
        # Between values of the grid, unchanged attractors are not searched for.
        ([{1: 1}, {}, {1: 1}], [1, 0, 1], []),
        ([{1: 1}, {}, {1: 1}], [1, 1, 1], [(0, 1, 1, 10, Change.END), (1, 2, 30, 1, Change.BEGINNING)]),
        # A change between two nearby values, regardless of how many values lie in between.
        ([{1: 1}, {1: 1}, {2: 3}, {1: 3}, {1: 3}], [1, 0, 0, 0, 1], [
            (1, 2, -1, 2, Change.BEGINNING), (1, 3, 1, 1, Change.CHANGE), (2, 3, 2, -1, Change.END),
        ]),
        # An attractor that ends within a step is continued from the value of the grid below.
        ([{2: 1, 1: 1}, {1: 1}, {2: 1}], [1, 0, 1], [(1, 2, 1, 11, Change.END)]),
        ([{2: 1}, {1: 1}, {2: 1, 1: 1}], [1, 0, 1], [(0, 1, 21, 1, Change.BEGINNING)]),
    ],
)  # fmt: skip
def test_changes_of_branches_between_values_of_the_grid(rows, in_grid, expected):
    assert fields_of(branch_changes(*attractors_of(rows, in_grid))) == expected


def test_every_change_has_an_entry(grid, dataset):
    for change in branch_changes(grid, at_all_values(grid)):
        same = (dataset["change"] == change.change) & (dataset["from_branch"] == change.from_branch)
        same &= (dataset["grid_low"] == A[change.low]) & (dataset["grid_high"] == A[change.high])
        assert (same & (dataset["to_branch"] == change.to_branch)).any()


def test_bifurcations_have_the_lifetime_of_chaos(dataset):
    chaotic = (dataset["motion_before"] == MotionKind.CHAOTIC) | (dataset["motion_after"] == MotionKind.CHAOTIC)
    assert 0 < int(chaotic.sum()) < dataset.sizes["bifurcation"]
    assert (dataset["lifetime_low"].values[chaotic] == 1e5).all()
    assert (dataset["lifetime_high"].values[chaotic] == np.inf).all()
    assert np.isnan(dataset["lifetime_low"].values[~chaotic]).all()


def test_bifurcations_are_those_of_the_orbits(dataset):
    kind, a = dataset["kind"].values, dataset["a"].values
    assert a[kind == BifurcationKind.PITCHFORK] == pytest.approx([0.0869729046661] * 2, abs=1e-10)
    assert dataset["multiplier"].values[kind == BifurcationKind.PITCHFORK].tolist() == [[1.0, 0.0]] * 2
    grazing = dataset.isel(
        bifurcation=np.flatnonzero((kind == BifurcationKind.GRAZING) & (dataset["change"].values == Change.CHANGE))
    )
    assert grazing["a"].values == pytest.approx([0.1122215462], abs=1e-9)
    assert grazing["stops"].values.tolist() == [[1, 1, 1]]
    assert grazing["stick_time"].item() == 0.0
    assert np.hypot(*grazing["multiplier"].values[0]) < 1.0 < np.hypot(*grazing["multiplier_beyond"].values[0])
    assert (dataset["a_error"].values <= 1e-9).all()


def test_a_bifurcation_lies_near_the_values_that_bracket_it(dataset):
    """A bifurcation belongs to a change within a step of the grid, or is passed between values on the branch."""
    low, high, a = (dataset[name].values for name in ("grid_low", "grid_high", "a"))
    passed = dataset["change"].values == Change.PASSED
    step = max(np.diff(A))
    assert ((low - step <= a) & (a <= high + step))[~passed].all()
    assert not ((a < low) | (a > high))[passed].any()
    # The grazing at which the middle block begins to stick lies below the grid.
    (first,) = np.flatnonzero(passed & (a < A[0]))
    assert a[first] == pytest.approx(0.0355, abs=1e-4)
    assert np.isnan(low[first])
    assert high[first] == A[0]
    assert (dataset["motion_before"].values == dataset["motion_after"].values)[passed].all()
    assert dataset["motion_before"].values[first] == MotionKind.SYNCHRONIZED


def test_a_stable_motion_lies_on_a_stable_orbit():
    """Near unstable synchrony no orbit is found at first; in the end the blocks desynchronize."""
    model = MODEL.at(a=0.09)
    start = synchronized_orbit(model).reference
    position = start.position + np.array([1e-5, 0.0, -1e-5])
    with pytest.raises(OrbitError, match="no periodic orbit"):
        limit_cycle(model, ChainState(position, start.velocity, start.stuck))
    orbit = _periodic_orbit(model, position + model.sliding_offset, start.velocity)
    assert multipliers(orbit).unstable_count == 0
    assert orbit.mean_distance == pytest.approx(0.0154, abs=1e-4)


def test_an_unstable_orbit_is_not_one_on_which_a_motion_has_settled():
    """Exact synchrony persists, however long the settling time."""
    model = MODEL.at(a=0.09)
    start = synchronized_orbit(model).reference
    error = _periodic_orbit(model, start.position + model.sliding_offset, start.velocity)
    assert str(error) == "a = 0.09: the periodic orbit next to the motion is unstable"


def test_the_values_next_to_a_bifurcation_are_those_of_the_attractors(dataset, grid):
    """They agree to the last bit, so that they can be looked up."""
    for name in ("grid_low", "grid_high"):
        values = dataset[name].values
        assert np.isin(values[np.isfinite(values)], A).all()
    shifted = at_all_values(grid)
    shifted["a"] = shifted["a"] * (1.0 + 1e-15)
    assert np.isin(shifted["a"].values[2], one_law(MODEL, grid, shifted)["grid_high"].values)


@pytest.mark.parametrize("change", [-1e-13, 1e-13])
def test_rows_are_ordered_by_the_written_digits(grid, dataset, monkeypatch, change):
    """Further digits differ between linear-algebra libraries; several bifurcations have the same a."""
    a = dataset["a"].values
    assert (np.diff(a) >= 0.0).all()
    assert (np.diff(a) == 0.0).any()

    def otherwise(*arguments):
        listed = list(enumerate(entries(*arguments)))[::-1]
        for number, entry in listed:
            moved = entry.bifurcation and replace(entry.bifurcation, value=entry.bifurcation.value + change * number)
            yield replace(entry, bifurcation=moved)

    monkeypatch.setattr(bifurcations, "entries", otherwise)
    xr.testing.assert_identical(one_law(MODEL, grid, at_all_values(grid)), dataset)


def test_numbers_are_rounded(dataset):
    for name in ("a", "period", "orbit_a", "orbit_mean_distance"):
        values = dataset[name].values
        assert [float(f"{value:.9e}") for value in values] == values.tolist()
        assert [float(f"{value:.8e}") for value in values] != values.tolist()


@pytest.mark.parametrize(("name", "digits"), [("multiplier", 5), ("multiplier_beyond", 5), ("stick_time", 5)])
def test_less_accurate_values_have_fewer_digits(dataset, name, digits):
    values = dataset[name].values
    values = values[np.abs(values) > 1e-5]
    assert [float(f"{value:.{digits - 1}e}") for value in values] == values.tolist()
    assert [float(f"{value:.{digits - 2}e}") for value in values] != values.tolist()


def test_a_negative_rounding_of_0_is_0():
    assert not np.signbit(_round_digits(np.array([-1e-13]), 10)).any()


def test_near_0_eleven_decimal_places_are_kept():
    values = _round_digits(np.array([1.23456789e-7, 1.23456789e-2, 4e-12]), 5)
    assert values.tolist() == [1.2346e-7, 1.2346e-2, 0.0]
    assert _round_digits(np.array([1.23456789e-8]), 10).tolist() == [1.235e-8]


def test_orbits_are_stable_on_one_side_of_the_bifurcation(dataset):
    stable = dataset["orbit_stable"].values == 1
    assert stable.any()
    assert (~stable).any()
    assert (dataset["orbit_period"].values > 0.0).all()


def test_a_bifurcation_without_an_orbit_has_no_values_of_an_orbit(grid, tmp_path):
    """With chaos on both sides of every bifurcation none is located; each is only bracketed by two values of a."""
    chaotic = grid.assign(kind=xr.full_like(grid["kind"], MotionKind.CHAOTIC))
    dataset = one_law(MODEL, chaotic, at_all_values(chaotic))
    assert dataset.sizes["orbit"] == 0
    assert dataset["a"].values == pytest.approx([0.08375] * 2)
    assert dataset["a_error"].values == pytest.approx([0.00375] * 2)
    for name in ("stops", "stops_beyond", "turns"):
        assert (dataset[name].values == -1).all()
    for name in ("period", "mean_distance", "stick_time", "multiplier", "multiplier_beyond"):
        assert np.isnan(dataset[name].values).all()
    # Empty text variables are still text when the file is read.
    write_summary(dataset, tmp_path / "none.nc")
    again = merge([open_summary(tmp_path / "none.nc")] * 2)
    assert again["law"].values.tolist() == ["linearized"] * 4
    assert again["orbit_law"].dtype.kind in "UO"


def test_bifurcations_are_listed_law_by_law(dataset):
    other = dataset.isel(bifurcation=[1], orbit=[0, 2]).assign_attrs(laws="mine")
    other = other.assign(law=other["law"].copy(data=["mine"]), orbit_law=other["orbit_law"].copy(data=["mine"] * 2))
    both = merge([dataset, other])
    assert both.attrs["laws"] == "linearized mine"
    assert both["law"].values.tolist() == ["linearized"] * dataset.sizes["bifurcation"] + ["mine"]
    assert both["orbit_law"].values.tolist() == ["linearized"] * dataset.sizes["orbit"] + ["mine"] * 2
    np.testing.assert_array_equal(both["a"].values, [*dataset["a"].values, other["a"].item()])
    np.testing.assert_array_equal(both["orbit_stops"].values[-2:], other["orbit_stops"].values)


def test_bifurcations_in_words(dataset):
    """Each bifurcation has a line."""
    rows = xr.concat([dataset.isel(bifurcation=[0], orbit=[])] * 5, "bifurcation", data_vars="minimal").load()
    values = {
        "law": ["linearized"] * 2 + ["mine"] * 3,
        "a": [0.0869729047, 0.1, 0.12345678912, 0.2, 0.20125],
        "a_error": [1e-10, 1e-9, 1e-10, 5e-5, 0.00125],
        "kind": [
            BifurcationKind.PITCHFORK,
            BifurcationKind.NEIMARK_SACKER,
            BifurcationKind.GRAZING,
            BifurcationKind.CRISIS,
            BifurcationKind.UNDETERMINED,
        ],
        "change": [Change.END, Change.CHANGE, Change.PASSED, Change.BEGINNING, Change.CHANGE],
        "from_branch": [0, 3, 3, -1, 4],
        "to_branch": [3, 3, 3, 4, 4],
        "motion_before": [MotionKind.SYNCHRONIZED, MotionKind.PERIODIC, MotionKind.PERIODIC, -1, MotionKind.PERIODIC],
        "motion_after": [MotionKind.PERIODIC, MotionKind.QUASIPERIODIC, MotionKind.PERIODIC, 3, MotionKind.PERIODIC],
        "turns": [0, 0, 1, -1, -1],
        "period": [5.6912345678, 5.7, 34.4, np.nan, np.nan],
        "stops": [[1, 1, 1], [1, 1, 1], [6, 6, 3], [-1] * 3, [-1] * 3],
        "stops_beyond": [[1, 1, 1], [-1] * 3, [6, 6, 2], [-1] * 3, [-1] * 3],
        "lifetime_low": [np.nan, np.nan, np.nan, 1240.0, np.nan],
        "lifetime_high": [np.nan, np.nan, np.nan, np.inf, np.nan],
    }
    for name, value in values.items():
        rows[name] = dataset[name].dims, np.array(value)
    assert listing(rows.assign_attrs(laws="linearized mine")).splitlines() == [
        "linearized, a = 0.0869729047 +/- 1e-10: pitchfork; branch 0 ends, synchronized; at larger a it leads to "
        "branch 3; period 5.69123, stops 1 1 1, beyond it 1 1 1",
        "linearized, a = 0.1 +/- 1e-09: Neimark–Sacker; branch 3 changes from periodic to quasiperiodic; period 5.7, "
        "stops 1 1 1",
        "mine, a = 0.1234567891 +/- 1e-10: grazing (turning point); branch 3 continues, periodic; period 34.4, "
        "stops 6 6 3, beyond it 6 6 2",
        "mine, a = 0.2 +/- 5e-05: crisis; branch 4 begins, chaotic; mean lifetime of chaos above 1240",
        "mine, a = 0.20125 +/- 0.0013: undetermined; branch 4 changes to another periodic motion",
    ]


def test_no_bifurcation_in_words(dataset):
    """An empty text could not be distinguished from a truncated one."""
    assert listing(dataset.isel(bifurcation=[])) == "No bifurcation was found between the values of a.\n"


def test_a_segment_belongs_to_the_branch_of_most_of_its_attractors():
    """The first attractor, from which the segment was continued, does not decide."""
    places = {(0, 0): 0, (1, 0): 0, (2, 1): 0, (3, 0): 1}
    orbits = FollowedOrbits([None, None], [(0, 0), (3, 0)], places)
    assert _branches_of_segments(orbits, np.array([[10, -1], [3, -1], [4, 3], [7, -1]])) == [3, 7]
