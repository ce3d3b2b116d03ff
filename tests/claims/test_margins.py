"""Choices that would change a verdict, for judges whose verdict changes at a known value."""

from __future__ import annotations

from functools import partial

import pytest
import xarray

from burridge_knopoff.claims import choice
from burridge_knopoff.claims.claim import Claim
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.ledger import judge as judge_claim
from burridge_knopoff.claims.margins import changing_choices
from burridge_knopoff.claims.paper import CLAIMS
from burridge_knopoff.claims.verdict import CONVENTION, FAILS, HOLDS, LOOSELY, NOT_TESTABLE, READING, Verdict
from tests.claims.alterations import alter, both
from tests.claims.worlds import evidence, paper_world

NOTHING = Evidence({}, {})
KINDS = {
    "tolerance": choice.Tolerance,
    "share": choice.StateShare,
    "near": choice.Near,
    "points": choice.Points,
    "samples": choice.Samples,
    "close": choice.Close,
    "opposite": choice.Opposite,
    "inner_share": choice.InnerShare,
    "level": choice.Level,
    "part": choice.RunPart,
}


def changes(judge, evidence, parameters, verdict, reads=()):
    """Return the choices that would change the verdict of a claim with these parameters."""
    choices = {name: KINDS[name].__metadata__[0] for name in parameters if name in KINDS}
    claim = Claim("name", "topic", "statement", "rule", "place", "figure", reads, judge, parameters, choices)
    return changing_choices(claim, judge, evidence, verdict)


def judge_with_change(name, place, below, above):
    """Return a judge whose verdict changes where a parameter does."""

    def judge(_evidence, parameters):
        return Verdict(below if parameters[name] < place else above, "")

    return judge


def test_a_number_of_a_claim_is_a_choice_or_what_the_statement_says():
    """What is not a choice is a named thing, a range of a or one value of it, or a number that the paper gives."""
    given = {"at", "by", "claimed", "coefficients", "low", "high", "shown", "steps"}
    for claim in CLAIMS.values():
        for name in claim.parameters.keys() - claim.choices.keys() - given:
            assert name in {"initial", "law", "laws", "a", "above", "synchrony", "claims"}, f"{claim.name}: {name}"
        assert claim.choices.keys() <= claim.parameters.keys()


@pytest.mark.parametrize(("below", "above"), [(FAILS, HOLDS), (HOLDS, FAILS)])
@pytest.mark.parametrize(("place", "relation"), [(0.8, "most"), (1.3, "least"), (1.9, "least"), (0.51, "most")])
def test_the_tolerance_at_which_a_verdict_changes_is_given_to_one_per_cent(below, above, place, relation):
    judge = judge_with_change("tolerance", place, below, above)
    parameters = {"tolerance": 1.0}
    now = judge(NOTHING, parameters)
    (text,) = changes(judge, NOTHING, parameters, now)
    other = {below: above, above: below}[now.verdict]
    head, value = text.removesuffix(" (it is 1)").rsplit(" ", 1)
    assert head == f"{other} if the tolerance were at {relation}"
    assert judge(NOTHING, {"tolerance": float(value)}).verdict == other
    assert float(value) == pytest.approx(place, rel=0.01)


def test_a_share_changes_by_its_distance_from_one():
    judge = judge_with_change("share", 0.85, FAILS, HOLDS)
    (text,) = changes(judge, NOTHING, {"share": 0.9}, Verdict(HOLDS, ""))
    assert text.startswith("fails if the required share of states were at most 8")
    # The distance of 0.75 from 1 is more than twice 0.1.
    assert changes(judge_with_change("share", 0.75, FAILS, HOLDS), NOTHING, {"share": 0.9}, Verdict(HOLDS, "")) == []


@pytest.mark.parametrize("other", [NOT_TESTABLE, FAILS])
def test_a_choice_that_leaves_too_little_data_is_given(other):
    """There are too few states for a larger share, and only one value at which the claim can be judged."""
    judge = judge_with_change("share", 0.93, HOLDS, NOT_TESTABLE)
    (text,) = changes(judge, NOTHING, {"share": 0.9}, Verdict(HOLDS, ""))
    head, value = text.removesuffix(" % (it is 90 %)").rsplit(" ", 1)
    assert head == "not testable if the required share of states were at least"
    assert 93.0 <= float(value) < 93.5

    def only(_evidence, parameters):
        return Verdict(HOLDS if parameters["near"] == 1.0 else other, "")

    assert changes(only, NOTHING, {"near": 1.0}, Verdict(HOLDS, "")) == [
        f"{other} if the distance that counts as near were not exactly 1"
    ]


def test_the_nearest_of_several_changes_is_given():
    """The claim fails beyond 1.2 and cannot be judged beyond 1.5."""

    def judge(_evidence, parameters):
        where = parameters["tolerance"]
        return Verdict(HOLDS if where < 1.2 else FAILS if where < 1.5 else NOT_TESTABLE, "")

    (text,) = changes(judge, NOTHING, {"tolerance": 1.0}, Verdict(HOLDS, ""))
    assert text.startswith("fails if the tolerance were at least 1.2")
    assert float(text.removesuffix(" (it is 1)").rsplit(" ", 1)[1]) == pytest.approx(1.2, rel=0.01)


def test_both_halves_of_the_grid_are_one_choice():
    world = Evidence({"mean_distance": xarray.Dataset(coords={"a": [0.1, 0.2, 0.3]})}, {})

    def judge(evidence, _parameters):
        return Verdict(HOLDS if evidence.summaries["mean_distance"].sizes["a"] == 3 else NOT_TESTABLE, "")

    assert changes(judge, world, {}, judge(world, {})) == ["not testable if only every second value of a were used"]
    # This is obvious for a claim on one value of a.
    assert changes(judge, world, {"at": 0.2}, judge(world, {})) == []


@pytest.mark.parametrize("name", ["inner_share", "level"])
def test_other_values_with_data_are_tried(name):
    """Amplitudes of the inner blocks and levels of J: no value between them can be judged."""
    words, summary = {
        "inner_share": ("the amplitude of the middle block over A", "phases"),
        "level": ("the level below which J counts as 0", "mean_distance"),
    }[name]
    world = Evidence({summary: xarray.Dataset(coords={name: [0.0, 0.3, 1.0]})}, {})

    def judge(_evidence, parameters):
        return Verdict(HOLDS if parameters[name] < 0.5 else FAILS, "")

    assert changes(judge, world, {name: 0.0}, Verdict(HOLDS, "")) == [f"fails if {words} were 1 (it is 0)"]
    assert changes(judge, NOTHING, {name: 0.0}, Verdict(HOLDS, "")) == []


@pytest.mark.parametrize(
    ("own", "place", "expected"),
    [
        # The verdict changes below `place`; the coordinate has 15, 30, 60, 90, 120, 150 and 180.
        (180.0, 121.0, "at most 120"),
        (180.0, 91.0, "at most 90"),
        (180.0, 90.0, None),
        (30.0, 31.0, "at least 60"),
        (30.0, 61.0, None),
        (30.0, 16.0, "at most 15"),
        (120.0, 151.0, "at least 180"),
    ],
)
@pytest.mark.parametrize("name", ["close", "opposite"])
def test_bounds_are_tried_at_the_values_with_data(name, own, place, expected):
    words = f"the phase difference {'up to' if name == 'close' else 'from'} which phases are {name}"
    world = Evidence(
        {"phases": xarray.Dataset(coords={"phase_difference": [15.0, 30.0, 60.0, 90.0, 120.0, 150.0, 180.0]})}, {}
    )
    judge = judge_with_change(name, place, FAILS, HOLDS)
    now = judge(world, {name: own})
    other = {FAILS: HOLDS, HOLDS: FAILS}[now.verdict]
    texts = [f"{other} if {words} were {expected} (it is {own:g})"] if expected else []
    assert changes(judge, world, {name: own}, now) == texts
    assert changes(judge, NOTHING, {name: own}, now) == []


@pytest.mark.parametrize(("place", "expected"), [(10, "at least 10"), (6, "at most 5"), (17, None), (4, None)])
@pytest.mark.parametrize("name", ["points", "samples"])
def test_counts_are_whole_numbers(name, place, expected):
    def judge(_evidence, parameters):
        assert isinstance(parameters[name], int)
        return Verdict(HOLDS if (parameters[name] < place) == (place > 8) else FAILS, "")

    words = KINDS[name].__metadata__[0].words
    texts = [f"fails if {words} were {expected} (it is 8)"] if expected else []
    assert changes(judge, NOTHING, {name: 8}, judge(NOTHING, {name: 8})) == texts


def test_other_bounds_of_close_and_opposite_phases_change_a_verdict():
    """The claim is ambiguous with the bounds of the claim and fails with another."""
    world, claim = paper_world(), CLAIMS["phases_decide"]
    not_opposed = alter("phases", "velocity_correlation", 1.0, phase_difference=150.0)
    both(not_opposed, alter("phases", "branch", 2, phase_difference=30.0, inner_share=1.0))(world)
    known = evidence(world)
    verdict = judge_claim(claim, known)
    assert verdict.verdict == READING
    found = changing_choices(claim, partial(judge_claim, claim), known, verdict)
    assert "fails if the phase difference from which phases are opposite were at most 150 (it is 180)" in found
    assert "holds if the phase difference up to which phases are close were at most 15 (it is 30)" in found


def test_for_solver_comparisons_single_values_are_left_out_but_the_grid_is_not_halved():
    """Half of the grid of the runs may lack the values at which solvers are compared."""
    data = {
        name: xarray.Dataset(coords={"a": a}) for name, a in [("lyapunov", [0.1, 0.2, 0.3]), ("solvers", [0.1, 0.3])]
    }
    world = Evidence(data, {})

    def judge(evidence, _parameters):
        known = evidence.summaries["lyapunov"].sizes["a"] == 3
        return Verdict(NOT_TESTABLE if not known else HOLDS if 0.3 in evidence.summaries["solvers"]["a"] else FAILS, "")

    assert changes(judge, world, {}, judge(world, {}), reads=("solvers",)) == ["fails if a = 0.3 were left out"]


@pytest.mark.parametrize(
    ("a", "expected"),
    [
        ([0.1, 0.2, 0.3], ["fails if only every second value of a were used, starting with the second"]),
        ([0.2, 0.1, 0.2], ["fails if only every second value of a were used, starting with the first"]),
        ([0.1], []),  # neither half is judged
    ],
)
def test_the_half_of_the_grid_that_changes_a_verdict_is_given(a, expected):
    """One half contains the first and third of three values, the other the second; without 0.1 the claim fails."""
    world = Evidence({"mean_distance": xarray.Dataset(coords={"a": a})}, {})

    def judge(evidence, _parameters):
        return Verdict(HOLDS if 0.1 in evidence.summaries["mean_distance"]["a"].values else FAILS, "")

    assert changes(judge, world, {}, judge(world, {})) == expected


def test_a_change_under_one_convention_is_given():
    """The verdict «depends on convention» may stay while the verdict under one convention changes."""

    def judge(_evidence, parameters):
        under = {"own": FAILS, "other": HOLDS if parameters["tolerance"] < 1.5 else LOOSELY}
        return Verdict(CONVENTION, "", conventions=under, own=FAILS)

    parameters = {"tolerance": 1.0}
    (text,) = changes(judge, NOTHING, parameters, judge(NOTHING, parameters))
    assert text.startswith("still depends on convention, but other: holds loosely, if the tolerance were at least 1.5")

    def fewer(_evidence, parameters):
        under = {"own": FAILS, "other": HOLDS, **({} if parameters["tolerance"] > 1.5 else {"third": HOLDS})}
        return Verdict(CONVENTION, "", conventions=under, own=FAILS)

    (text,) = changes(fewer, NOTHING, parameters, fewer(NOTHING, parameters))
    assert text.startswith(
        "still depends on convention, but third: cannot be judged, if the tolerance were at least 1.5"
    )


def test_the_neighbours_of_the_value_of_a_claim_are_tried():
    grids = {"runs": [0.0775, 0.08, 0.0825], "solvers": [0.079, 0.08]}
    world = Evidence({name: xarray.Dataset(coords={"a": a}) for name, a in grids.items()}, {})

    def judge(_evidence, parameters):
        return Verdict(FAILS if parameters["at"] > 0.08 else HOLDS, "")

    assert changes(judge, world, {"at": 0.08}, judge(world, {"at": 0.08})) == ["fails at a = 0.0825"]
    assert changes(judge, world, {"at": 0.5}, Verdict(FAILS, "")) == []


def test_window_and_whole_run_are_tried():
    def judge(_evidence, parameters):
        return Verdict(HOLDS if parameters["part"] == "window" else FAILS, "")

    assert changes(judge, NOTHING, {"part": "window"}, Verdict(HOLDS, "")) == [
        "fails if the whole run were used instead of the window"
    ]
    assert changes(judge, NOTHING, {"part": "run"}, Verdict(FAILS, "")) == [
        "holds if the window were used instead of the whole run"
    ]


def test_nothing_changes_a_claim_that_cannot_be_tested():
    judge = judge_with_change("tolerance", 0.9, FAILS, HOLDS)
    assert changes(judge, NOTHING, {"tolerance": 1.0}, Verdict(NOT_TESTABLE, "")) == []
    beyond = judge_with_change("tolerance", 2.1, HOLDS, FAILS)
    assert changes(beyond, NOTHING, {"tolerance": 1.0}, Verdict(HOLDS, "")) == []
