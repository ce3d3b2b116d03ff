"""Every claim, on altered data: no verdict is written by hand."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray

from burridge_knopoff.claims.conventions import judge_shares, reached, under_conventions
from burridge_knopoff.claims.ledger import judge, ledger
from burridge_knopoff.claims.verdict import CONVENTION, FAILS, HOLDS, LOOSELY, NOT_TESTABLE, Measured, Verdict
from tests.claims import alterations
from tests.claims.alterations import CASES, ONE_OF_MANY, Alteration, at
from tests.claims.said import CLAIMS, FILE, altered, said
from tests.claims.worlds import evidence, paper_world

# What no study can judge as yet.
UNJUDGED = {"phases_decide": "the states of this study differ in positions, not in the phase of an oscillation about"}
JUDGED = [name for name in CLAIMS if name not in UNJUDGED]
SAID = json.loads(FILE.read_text(encoding="utf-8"))
#: (claim, its number there, verdict, alteration): first no alteration, for each claim.
TOLD = [(name, 0, HOLDS, lambda world: None) for name in JUDGED]
TOLD += [(case[0], [one[0] for one in CASES[: k + 1]].count(case[0]), *case[1:]) for k, case in enumerate(CASES)]


@pytest.mark.parametrize(("name", "number", "expected", "alteration"), TOLD, ids=[f"{c[0]}-{c[2]}" for c in TOLD])
def test_altered_data_alter_the_verdict(name: str, number: int, expected: str, alteration: Alteration) -> None:
    """Every claim holds where the paper is right; what is said, and the numbers that it rests on, lie in said.json."""
    verdict = altered(name, alteration)
    assert verdict.verdict == expected, verdict.reason
    assert said(verdict) == SAID[name][number]
    assert len(SAID[name]) == 1 + [case[0] for case in CASES].count(name)
    if expected == CONVENTION:
        judged = set(verdict.conventions.values())
        assert FAILS in judged
        assert judged & {HOLDS, LOOSELY}


@pytest.mark.parametrize(
    ("own", "others", "expected", "changes"),
    [
        (HOLDS, (HOLDS, HOLDS, HOLDS), HOLDS, "but"),
        (HOLDS, (HOLDS, FAILS, HOLDS), CONVENTION, "but; symmetric, moving: fails (2)"),
        (
            FAILS,
            (FAILS, "", LOOSELY),
            CONVENTION,
            "but; symmetric, tested: holds loosely (3); not judged under symmetric, moving",
        ),
        (FAILS, (FAILS, FAILS, FAILS), FAILS, "but"),
        (
            LOOSELY,
            (HOLDS, "", ""),
            LOOSELY,
            "but; one_sided, tested: holds (1); not judged under symmetric, moving and symmetric, tested",
        ),
        (
            FAILS,
            ("", "", ""),
            FAILS,
            "but; not judged under one_sided, tested and symmetric, moving and symmetric, tested",
        ),
    ],
)
def test_a_claim_depends_on_convention_where_it_holds_and_fails(
    own: str, others: tuple[str, ...], expected: str, changes: str
) -> None:
    names = ["one_sided, tested", "symmetric, moving", "symmetric, tested"]
    figures = [Measured("number", 1.0)]

    def judged(attractors: xarray.Dataset) -> tuple[str, str]:
        number = names.index(f"{attractors['contact'].item()}, {attractors['start'].item()}")
        return others[number], str(number + 1)

    found = under_conventions(evidence(paper_world()), own, "why", figures, ["but"], judged)
    told = {"one_sided, moving": own, **{name: one for name, one in zip(names, others, strict=True) if one}}
    assert found == Verdict(expected, "why", figures, changes, told, own)
    alone = under_conventions(evidence({}), own, "why", figures, [], judged)
    assert alone == Verdict(own, "why", figures, "", {"one_sided, moving": own}, own)


def test_the_attractor_that_is_reached_is_known_by_branch_and_side() -> None:
    slots = ("law", "a", "attractor")
    found = xarray.Dataset(
        {
            "branch": (slots, [[[0, 2, 2], [0, 2, 2], [0, -1, -1], [0, 1, -1]]]),
            "side": (slots, [[[0, 1, -1], [0, 1, -1], [0, 0, 0], [0, 0, 0]]]),
            "value": (slots, np.arange(12.0).reshape(1, 4, 3)),
            "initial_branch": (("law", "initial", "a"), [[[2, 0, -1, 2]]]),
            "initial_side": (("law", "initial", "a"), [[[-1, 0, 0, 0]]]),
        },
        {"law": ["linearized"], "initial": ["plus"]},
    )
    known, values = reached(found, "plus", "linearized", "value")
    assert known.tolist() == [True, True, False, False]
    assert values[known].tolist() == [2.0, 3.0]
    assert judge_shares({}, 0.9) == ("", "")
    assert judge_shares({"one": 1.0, "other": 0.9}, 0.9) == (LOOSELY, "100.0 % (one), 90.0 % (other)")
    assert judge_shares({"one": 1.0, "other": 0.89}, 0.9)[0] == FAILS


def test_every_claim_is_seen_to_fail() -> None:
    assert {name for name, verdict, _ in CASES if verdict in (FAILS, CONVENTION)} == set(JUDGED)


@pytest.mark.parametrize("name", UNJUDGED)
def test_what_cannot_be_judged_says_why(name: str) -> None:
    for world in (paper_world(), {}):
        verdict = judge(CLAIMS[name], evidence(world))
        assert verdict.verdict == NOT_TESTABLE
        assert UNJUDGED[name] in verdict.reason


@pytest.mark.parametrize("name", JUDGED)
def test_nothing_is_judged_without_its_data(name: str) -> None:
    verdict = judge(CLAIMS[name], evidence({}))
    assert verdict.verdict == NOT_TESTABLE
    assert "the study has no summary" in verdict.reason


@pytest.mark.parametrize("name", CLAIMS)
def test_nothing_is_judged_at_another_driver_velocity(name: str) -> None:
    assert judge(CLAIMS[name], evidence(paper_world(), v=0.2)).verdict == NOT_TESTABLE


@pytest.mark.parametrize("name", CLAIMS)
@pytest.mark.parametrize(
    ("laws", "reason"),
    [
        ({"stribeck": {}}, "the study has no linearized law"),
        ({"linearized": {"law": "exponential"}, "nonlinear": {}}, "the study's linearized law is not the paper's"),
    ],
)
def test_nothing_is_judged_under_other_laws(name: str, laws: dict[str, dict], reason: str) -> None:
    world = {key: _under(item, list(laws)) for key, item in paper_world().items()}
    verdict = judge(CLAIMS[name], evidence(world, laws=laws))
    assert (verdict.verdict, verdict.reason) == (NOT_TESTABLE, f"Not testable here: {reason}.")


def _under(dataset: xarray.Dataset, laws: list[str]) -> xarray.Dataset:
    """Return a summary with other names of the laws; those that are too many are left out."""
    for name in ("law", "other_law"):
        if name in dataset.dims:
            names = laws if name == "law" else laws[1:]
            dataset = dataset.isel({name: slice(len(names))}).assign_coords({name: names})
    return dataset


@pytest.mark.parametrize("name", CLAIMS)
def test_what_one_law_tells_is_judged_without_the_other(name: str) -> None:
    """No claim fails for want of a law: it is judged by the law that it is about, or not testable."""
    world = {key: _under(item, ["linearized"]) for key, item in paper_world().items()}
    verdict = judge(CLAIMS[name], evidence(world, laws={"linearized": {}}))
    needed = CLAIMS[name].parameters.get("laws", [CLAIMS[name].parameters.get("law", "nonlinear")])
    if "nonlinear" in needed:
        assert (verdict.verdict, verdict.reason) == (NOT_TESTABLE, "Not testable here: the study has no nonlinear law.")
    else:
        assert verdict.verdict == HOLDS, verdict.reason


@pytest.mark.parametrize("name", JUDGED)
def test_a_further_law_changes_no_verdict(name: str) -> None:
    """Its numbers would contradict every claim."""
    world = {key: _with_another_law(item) for key, item in paper_world().items()}
    laws = {"linearized": {}, "nonlinear": {}, "stribeck": {}}
    assert judge(CLAIMS[name], evidence(world, laws=laws)).verdict == HOLDS
    first = judge(CLAIMS[name], evidence(world, laws={"stribeck": {}, **laws}))
    compared = name in ("laws_agree", "two_blocks_agree")
    assert first.verdict == (NOT_TESTABLE if compared else HOLDS)
    if compared:
        assert "compared with its first one, the stribeck law" in first.reason


def _with_another_law(dataset: xarray.Dataset) -> xarray.Dataset:
    names = [name for name in ("law", "other_law") if name in dataset.dims]
    return dataset.reindex({name: [*dataset[name].values, "stribeck"] for name in names}, fill_value=-1)


CHAINS = [{"ends": "ring"}, {"coupling": 2.0}, {"pulling": 1.0}, {"threshold": [1.0, 1.1, 1.0]}]


@pytest.mark.parametrize("chain", CHAINS)
def test_nothing_is_judged_of_another_chain(chain: dict[str, object]) -> None:
    for claim in CLAIMS.values():
        verdict = judge(claim, evidence(paper_world(), chain=chain))
        assert verdict.verdict == NOT_TESTABLE
        assert "other springs or static friction" in verdict.reason
    same = {"coupling": [1.0, 1.0], "pulling": [1.0, 2.0, 1.0], "threshold": [1.0, 1.0, 1.0]}
    assert judge(CLAIMS["equilibrium"], evidence(paper_world(), chain=same)).verdict == HOLDS


def test_runs_shorter_than_the_papers_judge_nothing() -> None:
    # What rests on runs alone: on their kinds, their distances, their cycles, or their solvers.
    for name in (
        "minus_synchronizes",
        "chaotic_above",
        "antiphase",
        "laws_agree",
        "two_blocks_agree",
        "solutions_agree",
    ):
        for short in ({"transient": 100}, {"window": 200}):
            verdict = judge(CLAIMS[name], evidence(paper_world(), **short))
            assert (verdict.verdict, "the paper's runs" in verdict.reason) == (NOT_TESTABLE, True), name
        assert judge(CLAIMS[name], evidence(paper_world(), window=20_000)).verdict == HOLDS
    assert judge(CLAIMS["equilibrium"], evidence(paper_world(), window=200)).verdict == HOLDS


def test_other_states_under_the_names_of_the_paper_are_not_judged() -> None:
    world = paper_world()
    states = {"plus": {"position": [0.98, -0.993, -0.991], "velocity": [0.099, 0.1012, 0.1023]}}
    verdict = judge(CLAIMS["plus_mean_distance"], evidence(world, initial=states))
    assert (verdict.verdict, verdict.reason) == (
        NOT_TESTABLE,
        "Not testable here: the study's initial state plus is not the paper's.",
    )
    assert "no initial state minus" in judge(CLAIMS["minus_synchronizes"], evidence(world, initial=states)).reason


@pytest.mark.parametrize("name", ["plus_mean_distance", "plus_aperiodic", "velocities_touch_zero"])
def test_a_value_that_is_not_in_the_grid_is_not_replaced_by_its_neighbour(name: str) -> None:
    world = {
        key: item.isel(a=item["a"].values != 0.08) if "a" in item.dims else item for key, item in paper_world().items()
    }
    verdict = judge(CLAIMS[name], evidence(world))
    assert (verdict.verdict, "a = 0.08 is not in the grid" in verdict.reason) == (NOT_TESTABLE, True)


def test_a_statement_on_a_range_takes_ten_values_of_a() -> None:
    few = {key: item.isel(a=slice(None, None, 8)) if "a" in item.dims else item for key, item in paper_world().items()}
    verdict = judge(CLAIMS["minus_synchronizes"], evidence(few))
    assert verdict.verdict == NOT_TESTABLE
    assert "takes 10 values of a; the grid has 2" in verdict.reason


def test_runs_that_did_not_complete_are_no_evidence() -> None:
    world = paper_world()
    at(world["mean_distance"], "status", 1, a=ONE_OF_MANY)
    at(world["mean_distance"], "synchronized", 0, a=ONE_OF_MANY)
    at(world["mean_distance"], "mean_distance", np.nan, a=ONE_OF_MANY)
    assert judge(CLAIMS["minus_synchronizes"], evidence(world)).verdict == HOLDS
    at(world["mean_distance"], "status", 1)
    assert judge(CLAIMS["minus_synchronizes"], evidence(world)).verdict == NOT_TESTABLE


def test_conventions_are_those_of_the_study() -> None:
    world = paper_world()
    alterations.reached(0, initial="plus", contact="symmetric", start="moving")(world)
    own = judge(CLAIMS["plus_does_not_synchronize"], evidence(world, contact="symmetric"))
    # Under its own convention a study is judged by its runs, in which plus does not synchronize here.
    assert own.verdict == HOLDS
    assert own.conventions["symmetric, moving"] == HOLDS
    assert len(own.conventions) == 4


def test_counts_are_those_of_the_verdicts() -> None:
    content = ledger("test", list(CLAIMS.values()), evidence(paper_world()), ["mean_distance"])
    assert content["counts"][HOLDS] == len(JUDGED)
    assert content["counts"][NOT_TESTABLE] == len(UNJUDGED)
    assert len(content["claims"]) == len(CLAIMS)
    assert {claim["figure"] for claim in content["claims"]} == {"mean_distance", ""}
