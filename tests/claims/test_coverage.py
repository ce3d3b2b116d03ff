"""A verdict is given only where the study looked: ranges of a, conventions, attractors, and what may turn a verdict."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from burridge_knopoff.claims.claim import Claim
from burridge_knopoff.claims.evidence import check_covered
from burridge_knopoff.claims.ledger import judge, ledger
from burridge_knopoff.claims.paper import CLAIMS
from burridge_knopoff.claims.range import ABOVE, BELOW, POSITIVE, SYNCHRONY, TWO_BLOCKS, WEAKENING, Range
from burridge_knopoff.claims.verdict import HOLDS, NOT_TESTABLE, NotTestableError
from burridge_knopoff.study.config import CONFIG
from burridge_knopoff.study.paper import PAPER_PHASES
from burridge_knopoff.study.yaml_file import read_config
from tests.claims.alterations import judge_claim
from tests.claims.cases import THEORY
from tests.claims.worlds import Summaries, evidence, paper_world

GRID = np.arange(121) * 0.0025
#: Claims on one value of a, 0.08, and those that need none.
AT_ONE_A = {name for name, claim in CLAIMS.items() if "at" in claim.parameters}
WITHOUT_A = {*THEORY, "equilibrium", "dimensionless_equations", "velocities_near_driver"}
#: Claims on values of a that other keys of the config set.
OF_OTHER_GRIDS = {"two_blocks_agree", "map_is_cheaper"}
SEARCHED = ("attractors", "refined", "rotation", "bifurcations", "phases")


def at(chosen: Callable[[np.ndarray], np.ndarray]) -> Summaries:
    """Return the world of a study with some values of a only."""
    world = paper_world()
    for name, dataset in world.items():
        if name in ("refined", "rotation"):
            world[name] = dataset.isel(value=chosen(dataset["a"].values[1]))
        elif "a" in dataset.dims and name != "two_blocks":
            world[name] = dataset.isel(a=chosen(dataset["a"].values))
    return world


def judged(world: Summaries) -> set[str]:
    return {name for name in CLAIMS if judge_claim(name, evidence(world)).verdict != NOT_TESTABLE}


@pytest.mark.parametrize("a", [SYNCHRONY, BELOW, ABOVE, POSITIVE])
def test_the_default_grid_covers_each_range(a: Range) -> None:
    assert a.missing(GRID) == []
    # So do both halves of it, by which the margins judge.
    assert a.missing(GRID[::2]) == a.missing(GRID[1::2]) == []


def test_the_default_grids_of_phases_and_of_two_blocks_cover_their_ranges() -> None:
    assert SYNCHRONY.missing(np.array(PAPER_PHASES)) == []
    config = CONFIG.form(read_config("config/paper.yaml"), "")
    ((start, stop, step),) = [item.values() for item in config["chains"]["two_blocks"]["a"]]
    assert TWO_BLOCKS.missing(np.arange(start, stop, step)) == []


def test_each_tenth_of_a_range_needs_a_value() -> None:
    a = Range(above=0.0, below=1.0)
    tenths = np.arange(10) / 10 + 0.05
    assert a.missing(tenths) == []
    for k in range(10):
        (gap,) = a.missing(np.delete(tenths, k))
        assert (gap.first, gap.last) == pytest.approx((k / 10, (k + 1) / 10))
    # A value at a border counts on both sides, up to rounding; the ends of an open range do not count.
    assert a.missing(np.array([0.1, 0.2, 0.1 + 0.2, 0.5, 0.7, 0.9])) == []
    assert [str(gap) for gap in a.missing(np.array([0.0, 0.15, 0.3, 0.5, 0.7, 0.9, 1.0]))] == ["0 ≤ a ≤ 0.1"]
    assert [str(gap) for gap in Range(first=0.0, last=1.0).missing(np.array([0.0, 1.0]))] == ["0.1 ≤ a ≤ 0.9"]
    assert [str(gap) for gap in a.missing(np.array([0.35, 0.45, 5.0]))] == ["0 ≤ a ≤ 0.3", "0.5 ≤ a ≤ 1"]
    assert WEAKENING.missing(np.array([0.0])) == [WEAKENING]
    assert WEAKENING.missing(np.array([0.0, 7.0])) == []


def test_what_is_missing_is_said_in_words() -> None:
    with pytest.raises(NotTestableError, match=r"\b0\.005 to 0\.065\b.*the study"):
        check_covered(np.linspace(0.07, 0.1, 13), SYNCHRONY, "the study")
    with pytest.raises(NotTestableError, match=r"\ba > 0\b.*chains\.a"):
        check_covered(np.zeros(1), WEAKENING, "chains.a")
    with pytest.raises(NotTestableError, match=r"\b10 values\b.*\b9\b"):
        check_covered(np.linspace(0.01, 0.09, 9), BELOW, "the study")


@pytest.mark.parametrize("claim", CLAIMS.values(), ids=CLAIMS)
def test_a_range_in_a_statement_is_that_of_its_judge(claim: Claim) -> None:
    """A statement that names a range has it as a parameter, with both ends unless it is of theory."""
    a = claim.parameters.get("a")
    if a is None:
        assert claim.name in AT_ONE_A | WITHOUT_A | OF_OTHER_GRIDS | {"transition", "plus_under_one_convention"}
    else:
        assert a.is_bounded or claim.name in THEORY
    if "a < 0.1" in claim.statement:
        assert a == BELOW
    if "between 0.005 and 0.08" in claim.statement:
        assert a == SYNCHRONY


@pytest.mark.parametrize(
    ("chosen", "expected"),
    [
        (lambda a: (a >= 0.07) & (a <= 0.1), AT_ONE_A),
        (lambda a: a == 0.08, AT_ONE_A),
        (lambda a: a > 0.1, {"chaotic_above"}),
        (lambda a: np.isin(a, [0.02, 0.08, 0.14]), AT_ONE_A),
    ],
)
def test_part_of_a_range_is_no_evidence_of_all_of_it(chosen, expected) -> None:
    found = judged(at(chosen))
    assert found - OF_OTHER_GRIDS == expected | WITHOUT_A


def test_a_range_of_which_a_third_is_missing_is_not_judged() -> None:
    for name in ("minus_synchronizes", "laws_agree", "history_decides", "branch_locked", "upper_edge", "transition"):
        verdict = judge_claim(name, evidence(at(lambda a: (a < 0.03) | (a > 0.06))))
        assert verdict.verdict == NOT_TESTABLE
        assert "needs values of a from 0.0" in verdict.reason, name


def test_the_range_that_is_judged_is_the_range_that_is_printed() -> None:
    """Values beyond the range do not count, and the range has the end up to which values count."""
    reason = judge_claim("chaotic_above", evidence(paper_world())).reason
    assert "with 0.1 < a ≤ 0.3" in reason
    world = at(lambda a: a < 0.2)
    assert "needs values of a from 0.2 to 0.3" in judge_claim("chaotic_above", evidence(world)).reason


def test_without_attractors_no_state_is_judged() -> None:
    """Another start, or a state that rounds to the paper's, may lead to another attractor."""
    world = {name: dataset for name, dataset in paper_world().items() if name not in SEARCHED}
    others = {"periodic_for_one_block", "not_differentiable_at_events"}
    assert judged(world) == WITHOUT_A | OF_OTHER_GRIDS | others
    reason = judge(CLAIMS["laws_agree"], evidence(world)).reason
    assert "no summary attractors.nc, by which another start, or states that round to the paper's, could" in reason


def test_phases_need_what_may_change_their_verdict() -> None:
    """Another motion of the middle block, and amplitudes at which some block slips backward."""
    for key, value, word in (("inner_share", [0.0], "inner_share"), ("amplitude", [0.01, 0.05], "amplitude")):
        world = paper_world()
        world["phases"] = world["phases"].sel({key: value})
        verdict = judge_claim("phases_decide", evidence(world))
        assert (verdict.verdict, f"phases.{word} needs a" in verdict.reason) == (NOT_TESTABLE, True)


def test_other_starts_are_counted_where_only_the_runs_decide() -> None:
    world = paper_world()
    # The start changes the attractor of plus at two values of a, and one more above the range.
    for a in (0.03, 0.05, 0.2):
        place = {"contact": "one_sided", "start": "tested", "initial": "plus", "law": "linearized", "a": a}
        world["attractors"]["initial_branch"].loc[place] = 0
    names = ["laws_agree", "plus_does_not_synchronize"]
    by_runs, by_attractors = ledger("test", [CLAIMS[name] for name in names], evidence(world), [])["claims"]
    assert by_runs["changes"] == "with the other start plus reaches another attractor at 2 values of a (linearized)"
    assert by_runs["verdict"] == HOLDS
    # Here the attractors are judged under each start.
    assert "with the other start" not in by_attractors["changes"]


def test_a_number_of_the_paper_needs_no_results() -> None:
    claim = CLAIMS["velocities_near_driver"]
    verdict = judge(claim, evidence({}))
    assert (verdict.verdict, [item.value for item in verdict.measured]) == (HOLDS, pytest.approx([0.99, 1.023]))
    for tolerance, loose, expected in ((0.024, 0.03, HOLDS), (0.022, 0.024, "holds loosely"), (0.01, 0.022, "fails")):
        parameters = {**claim.parameters, "tolerance": tolerance, "loose": loose}
        assert judge(claim, evidence({}), parameters).verdict == expected
