"""What would turn a verdict, told of judges whose verdict turns at a known place."""

from __future__ import annotations

import pytest
import xarray

from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.margins import turns
from burridge_knopoff.claims.verdict import CONVENTION, FAILS, HOLDS, LOOSELY, NOT_TESTABLE, Verdict

NOTHING = Evidence({}, {})


def turning(name, place, below, above):
    """Return a judge whose verdict turns where a parameter does."""

    def judge(_evidence, parameters):
        return Verdict(below if parameters[name] < place else above, "")

    return judge


@pytest.mark.parametrize(("below", "above"), [(FAILS, HOLDS), (HOLDS, FAILS)])
@pytest.mark.parametrize(("place", "relation"), [(0.8, "below"), (1.3, "above"), (1.9, "above"), (0.51, "below")])
def test_the_tolerance_at_which_a_verdict_turns_is_told_to_two_per_cent(below, above, place, relation):
    judge = turning("tolerance", place, below, above)
    parameters = {"tolerance": 1.0}
    now = judge(NOTHING, parameters)
    (text,) = turns(judge, NOTHING, parameters, now)
    other = {below: above, above: below}[now.verdict]
    head, value = text.removesuffix(" (1)").rsplit(" ", 1)
    assert head == f"{other}: tolerance {relation}"
    # On the side of the verdict as it is, but for three digits, and next to where it turns.
    assert (float(value) - place) * (1.0 - place) >= -0.005 * place
    assert float(value) == pytest.approx(place, rel=0.025)


def test_a_share_changes_by_its_distance_from_one():
    judge = turning("share", 0.85, FAILS, HOLDS)
    (text,) = turns(judge, NOTHING, {"share": 0.9}, Verdict(HOLDS, ""))
    assert text.startswith("fails: share below 0.85")
    # 0.75 is farther off than twice 0.1 from 1.
    assert turns(turning("share", 0.75, FAILS, HOLDS), NOTHING, {"share": 0.9}, Verdict(HOLDS, "")) == []


@pytest.mark.parametrize("other", [NOT_TESTABLE, FAILS])
def test_what_leaves_too_little_to_judge_is_told_as_well(other):
    """As states that are too few for a greater share, and a value at which alone there is something to judge."""
    judge = turning("share", 0.93, HOLDS, NOT_TESTABLE)
    (text,) = turns(judge, NOTHING, {"share": 0.9}, Verdict(HOLDS, ""))
    head, value = text.removesuffix(" (0.9)").rsplit(" ", 1)
    assert head == "not testable: share above"
    assert 0.92 < float(value) <= 0.93

    def only(_evidence, parameters):
        return Verdict(HOLDS if parameters["near"] == 1.0 else other, "")

    assert turns(only, NOTHING, {"near": 1.0}, Verdict(HOLDS, "")) == [f"{other}: any other near (1)"]


def test_the_nearest_of_several_turns_is_told():
    """It fails beyond 1.2, and beyond 1.5 there is nothing to judge."""

    def judge(_evidence, parameters):
        where = parameters["tolerance"]
        return Verdict(HOLDS if where < 1.2 else FAILS if where < 1.5 else NOT_TESTABLE, "")

    (text,) = turns(judge, NOTHING, {"tolerance": 1.0}, Verdict(HOLDS, ""))
    assert text.startswith("fails: tolerance above 1.")
    assert float(text.removesuffix(" (1)").rsplit(" ", 1)[1]) == pytest.approx(1.2, rel=0.025)


def test_both_halves_of_the_grid_are_told_as_one():
    world = Evidence({"mean_distance": xarray.Dataset(coords={"a": [0.1, 0.2, 0.3]})}, {})

    def judge(evidence, _parameters):
        return Verdict(HOLDS if evidence.summaries["mean_distance"].sizes["a"] == 3 else NOT_TESTABLE, "")

    assert turns(judge, world, {}, judge(world, {})) == ["not testable: every second value of a"]
    # Of a claim on one value of a this goes without saying.
    assert turns(judge, world, {"at": 0.2}, judge(world, {})) == []


@pytest.mark.parametrize(("name", "summary"), [("inner_share", "phases"), ("level", "mean_distance")])
def test_other_values_for_which_there_are_data_are_told(name, summary):
    """As amplitudes of the inner blocks, and levels of J: no value between them can be judged."""
    world = Evidence({summary: xarray.Dataset(coords={name: [0.0, 0.3, 1.0]})}, {})

    def judge(_evidence, parameters):
        return Verdict(HOLDS if parameters[name] < 0.5 else FAILS, "")

    assert turns(judge, world, {name: 0.0}, Verdict(HOLDS, "")) == [f"fails: {name} = 1 (0)"]
    assert turns(judge, NOTHING, {name: 0.0}, Verdict(HOLDS, "")) == []


def test_where_solvers_are_compared_single_values_are_left_out_and_no_grid_halved():
    """A half of the grid of the runs would lack values at which solvers are compared, which is no other choice."""
    data = {
        name: xarray.Dataset(coords={"a": a}) for name, a in [("lyapunov", [0.1, 0.2, 0.3]), ("solvers", [0.1, 0.3])]
    }
    world = Evidence(data, {})

    def judge(evidence, _parameters):
        known = evidence.summaries["lyapunov"].sizes["a"] == 3
        return Verdict(NOT_TESTABLE if not known else HOLDS if 0.3 in evidence.summaries["solvers"]["a"] else FAILS, "")

    assert turns(judge, world, {"relative": 0.1}, judge(world, {})) == ["fails: without a = 0.3"]


@pytest.mark.parametrize(
    ("a", "told"),
    [
        ([0.1, 0.2, 0.3], ["fails: every second value of a, from the second on"]),
        ([0.2, 0.1, 0.2], ["fails: every second value of a, from the first on"]),
        ([0.1], []),  # no half of it is judged
    ],
)
def test_the_half_of_the_grid_that_turns_a_verdict_is_told(a, told):
    """Of three values one half has the first and the third, the other the second; without 0.1 it fails."""
    world = Evidence({"mean_distance": xarray.Dataset(coords={"a": a})}, {})

    def judge(evidence, _parameters):
        return Verdict(HOLDS if 0.1 in evidence.summaries["mean_distance"]["a"].values else FAILS, "")

    assert turns(judge, world, {}, judge(world, {})) == told


def test_a_verdict_that_turns_beneath_another_is_told():
    """Of what depends on convention the verdict stays, and that under a convention may not."""

    def judge(_evidence, parameters):
        under = {"own": FAILS, "other": HOLDS if parameters["tolerance"] < 1.5 else LOOSELY}
        return Verdict(CONVENTION, "", conventions=under, own=FAILS)

    parameters = {"tolerance": 1.0}
    (text,) = turns(judge, NOTHING, parameters, judge(NOTHING, parameters))
    assert text.startswith("depends on convention (other holds loosely): tolerance above 1.4")

    def fewer(_evidence, parameters):
        under = {"own": FAILS, "other": HOLDS, **({} if parameters["tolerance"] > 1.5 else {"third": HOLDS})}
        return Verdict(CONVENTION, "", conventions=under, own=FAILS)

    (text,) = turns(fewer, NOTHING, parameters, fewer(NOTHING, parameters))
    assert text.startswith("depends on convention (third not testable): tolerance above ")


def test_the_values_beside_the_one_that_a_claim_is_on_are_tried():
    grids = {"runs": [0.0775, 0.08, 0.0825], "solvers": [0.079, 0.08]}
    world = Evidence({name: xarray.Dataset(coords={"a": a}) for name, a in grids.items()}, {})

    def judge(_evidence, parameters):
        return Verdict(FAILS if parameters["at"] > 0.08 else HOLDS, "")

    assert turns(judge, world, {"at": 0.08}, judge(world, {"at": 0.08})) == ["fails: at a = 0.0825 (0.08)"]
    assert turns(judge, world, {"at": 0.5}, Verdict(FAILS, "")) == []


def test_window_and_whole_run_are_tried():
    def judge(_evidence, parameters):
        return Verdict(HOLDS if parameters["part"] == "window" else FAILS, "")

    assert turns(judge, NOTHING, {"part": "window"}, Verdict(HOLDS, "")) == ["fails: by the whole run"]
    assert turns(judge, NOTHING, {"part": "run"}, Verdict(FAILS, "")) == ["holds: by the window"]


def test_other_evidence_is_tried_by_its_name():
    other = Evidence({}, {"motion": {}})

    def judge(evidence, _parameters):
        return Verdict(FAILS if evidence is other else HOLDS, "")

    found = turns(judge, NOTHING, {}, Verdict(HOLDS, ""), [("zero = 2 (1)", other), ("zero = 0.5 (1)", NOTHING)])
    assert found == ["fails: zero = 2 (1)"]


def test_nothing_turns_what_cannot_be_tested():
    judge = turning("tolerance", 0.9, FAILS, HOLDS)
    assert turns(judge, NOTHING, {"tolerance": 1.0}, Verdict(NOT_TESTABLE, "")) == []
    beyond = turning("tolerance", 2.1, HOLDS, FAILS)
    assert turns(beyond, NOTHING, {"tolerance": 1.0}, Verdict(HOLDS, "")) == []
