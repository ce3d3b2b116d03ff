"""The verdict on every claim from altered data; no verdict is written by hand."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np
import pytest
import xarray
from scipy.integrate import solve_ivp

from burridge_knopoff import Chain, InitialState, Model, law_of
from burridge_knopoff.attractors.lookup import reached_slots
from burridge_knopoff.claims.conventions import combine_readings, judge_conventions
from burridge_knopoff.claims.equations import equation_difference
from burridge_knopoff.claims.ledger import judge
from burridge_knopoff.claims.paper import CLAIMS
from burridge_knopoff.claims.verdict import (
    CONVENTION,
    FAILS,
    HOLDS,
    LOOSELY,
    NOT_TESTABLE,
    READING,
    SILENT,
    UNDECIDED,
    Measured,
    NotTestableError,
    Share,
    UndecidedError,
    Verdict,
    at_values,
    judge_share,
    judge_shares,
    judge_worst_share,
)
from burridge_knopoff.running.runner import Runner
from tests.claims import alterations
from tests.claims.alterations import CASES, ONE_OF_MANY, Alteration, at, judge_altered, judge_claim
from tests.claims.worlds import Summaries, evidence, paper_world

JUDGED = [*((name, HOLDS, lambda world: None) for name in CLAIMS), *CASES]


@pytest.mark.parametrize(("name", "expected", "alteration"), JUDGED, ids=[f"{case[0]}-{case[1]}" for case in JUDGED])
def test_altered_data_alter_the_verdict(name: str, expected: str, alteration: Alteration) -> None:
    """Every claim holds where the paper is right."""
    verdict = judge_altered(name, alteration)
    assert verdict.verdict == expected, verdict.reason
    assert expected != HOLDS or verdict.measured
    shares = [item.value for item in verdict.measured if item.quantity.startswith("share of")]
    assert not any(share < 0.0 or share > 1.0 for share in shares)
    if expected in (HOLDS, LOOSELY) and verdict.own == expected and not verdict.conventions:
        assert "(fails)" not in verdict.reason
    if expected in (CONVENTION, READING):
        verdicts = set(verdict.conventions.values())
        assert FAILS in verdicts
        assert verdicts & {HOLDS, LOOSELY}


@pytest.mark.parametrize(
    ("own", "others", "expected", "changes"),
    [
        (HOLDS, (HOLDS, HOLDS, HOLDS), HOLDS, ""),
        (HOLDS, (FAILS, HOLDS, HOLDS), CONVENTION, "; under (A) it fails: 1"),
        (FAILS, (LOOSELY, "", FAILS), CONVENTION, "; under (A) it holds loosely: 1; it cannot be judged under (B)"),
        # Another contact than the paper's does not decide.
        (HOLDS, (HOLDS, FAILS, HOLDS), HOLDS, "; under (B) it fails: 2"),
        (FAILS, (FAILS, "", LOOSELY), FAILS, "; under (C) it holds loosely: 3; it cannot be judged under (B)"),
        (FAILS, (FAILS, FAILS, FAILS), FAILS, ""),
        (LOOSELY, (HOLDS, "", ""), LOOSELY, "; under (A) it holds: 1; it cannot be judged under (B) and (C)"),
        # A statement that is about nothing under the other start is not false there.
        (FAILS, (SILENT, "", HOLDS), FAILS, "; under (C) it holds: 3; it is about nothing under (A); it cannot be "),
    ],
)
def test_a_claim_depends_on_convention_where_it_holds_and_fails(
    own: str, others: tuple[str, ...], expected: str, changes: str
) -> None:
    names = ["one_sided, tested", "symmetric, moving", "symmetric, tested"]
    for letter, name in zip("ABC", names, strict=True):
        changes = changes.replace(f"({letter})", f"({name})")
    figures = [Measured("number", 1.0)]

    def judge_attractors(attractors: xarray.Dataset) -> tuple[str, str]:
        number = names.index(f"{attractors['contact'].item()}, {attractors['start'].item()}")
        return others[number], str(number + 1)

    found = judge_conventions(evidence(paper_world()), own, "why", figures, ["but"], judge_attractors)
    judged = {name: verdict for name, verdict in zip(names, others, strict=True) if verdict not in ("", SILENT)}
    changes += "judged under (symmetric, moving)" * changes.endswith("it cannot be ")
    assert found == Verdict(expected, "why", figures, f"but{changes}", {"one_sided, moving": own, **judged}, own)


@pytest.mark.parametrize(
    ("own", "under", "expected"),
    [
        (HOLDS, ("one_sided, tested",), UNDECIDED),
        (FAILS, ("one_sided, tested", "symmetric, moving"), UNDECIDED),
        # Another contact than the paper's does not decide.
        (LOOSELY, ("symmetric, moving", "symmetric, tested"), LOOSELY),
    ],
)
def test_too_few_values_under_a_convention_leave_the_claim_undecided(own: str, under: tuple[str, ...], expected: str):
    def judge_attractors(attractors: xarray.Dataset) -> tuple[str, str]:
        name = f"{attractors['contact'].item()}, {attractors['start'].item()}"
        return (UNDECIDED, "8 of 9") if name in under else (own, "")

    figures = [Measured("number", 1.0)]
    found = judge_conventions(evidence(paper_world()), own, "Why.", figures, [], judge_attractors)
    assert (found.verdict, found.own, found.measured) == (expected, own, figures)
    assert found.changes == "; ".join(f"under ({name}) it is undecided: 8 of 9" for name in under)
    assert set(found.conventions.values()) == {own}
    start = "Undecided: there are too few values under (one_sided, tested). " if expected == UNDECIDED else ""
    assert found.reason == f"{start}Why."


@pytest.mark.parametrize("own", [HOLDS, LOOSELY, FAILS])
def test_a_convention_that_could_change_the_verdict_is_not_left_out(own: str) -> None:
    def judge_contact(attractors: xarray.Dataset) -> tuple[str, str]:
        return (own, "") if attractors["contact"].item() == "symmetric" else ("", "")

    with pytest.raises(NotTestableError, match=r"\(one_sided, tested\)"):
        judge_conventions(evidence(paper_world()), own, "why", [], [], judge_contact)
    # Under another contact than the paper's each convention counts.
    with pytest.raises(NotTestableError, match=r"\(one_sided, moving\).*\(one_sided, tested\)"):
        judge_conventions(evidence(paper_world(), contact="symmetric"), own, "why", [], [], judge_contact)
    with pytest.raises(NotTestableError, match=r"attractors\.nc"):
        judge_conventions(evidence({}), own, "why", [], [], judge_contact)


def test_under_another_contact_than_the_papers_every_convention_counts() -> None:
    def judge_attractors(attractors: xarray.Dataset) -> tuple[str, str]:
        return FAILS if attractors["contact"].item() == "one_sided" else HOLDS, ""

    found = judge_conventions(evidence(paper_world(), contact="symmetric"), HOLDS, "why", [], [], judge_attractors)
    assert (found.verdict, found.own) == (CONVENTION, HOLDS)


def test_the_attractor_that_is_reached_is_known_by_branch_and_side() -> None:
    slots = ("law", "a", "attractor")
    attractors = xarray.Dataset(
        {
            "branch": (slots, [[[0, 2, 2], [0, 2, 2], [0, -1, -1], [0, 1, -1]]]),
            "side": (slots, [[[0, 1, -1], [0, 1, -1], [0, 0, 0], [0, 0, 0]]]),
            "value": (slots, np.arange(12.0).reshape(1, 4, 3)),
            "initial_branch": (("law", "initial", "a"), [[[2, 0, -1, 2]]]),
            "initial_side": (("law", "initial", "a"), [[[-1, 0, 0, 0]]]),
        },
        {"law": ["linearized"], "initial": ["plus"]},
    )
    is_known, slot = reached_slots(attractors)
    assert is_known.sel(law="linearized", initial="plus").values.tolist() == [True, True, False, False]
    assert attractors["value"].isel(attractor=slot).values[is_known.values].tolist() == [2.0, 3.0]
    assert judge_shares({}, 0.9) == ("", "")


@pytest.mark.parametrize(
    ("hits", "count", "expected"),
    [
        (40, 40, HOLDS),
        (1, 1, HOLDS),
        (36, 40, LOOSELY),
        (9, 10, LOOSELY),
        # 95 % intervals that reach nine of ten, and those that do not.
        (7, 8, UNDECIDED),
        (22, 26, UNDECIDED),
        (32, 39, UNDECIDED),
        (31, 39, FAILS),
        (5, 8, FAILS),
        (0, 1, FAILS),
    ],
)
def test_one_rule_judges_all_shares(hits: int, count: int, expected: str) -> None:
    """Too few values are not a reason for a statement to fail, whatever the claim."""
    share = Share(hits, count)
    assert judge_share(share, 0.9) == expected
    texts = f"9 of 9 (one) and {share} (other)"
    one, open_one = {"one": Share(9, 9), "other": share}, expected == UNDECIDED
    assert judge_shares(one, 0.9) == (expected, texts)
    if open_one:
        with pytest.raises(UndecidedError, match=rf"{hits} of {count}\b.*\(other\)"):
            judge_worst_share(one, 0.9)
    else:
        assert judge_worst_share(one, 0.9) == expected
    # A failure is not left open by another share.
    assert judge_worst_share({**one, "third": Share(0, 9)}, 0.9) == FAILS


@pytest.mark.parametrize(
    ("readings", "expected"),
    [
        ([HOLDS, HOLDS], HOLDS),
        ([HOLDS, LOOSELY], LOOSELY),
        ([FAILS, FAILS], FAILS),
        ([LOOSELY, FAILS], READING),
        # An open share does not matter if the others differ; if they agree, it may differ from them.
        ([HOLDS, NOT_TESTABLE, FAILS], READING),
        ([NOT_TESTABLE, HOLDS], UNDECIDED),
        ([FAILS, NOT_TESTABLE], UNDECIDED),
    ],
)
def test_a_reading_that_is_open_is_not_left_out(readings: list[str], expected: str) -> None:
    verdicts = {f"reading {number}": verdict for number, verdict in enumerate(readings)}
    reason = "why"
    if expected == UNDECIDED:
        of_reading = f"«reading {readings.index(NOT_TESTABLE)}»"
        reason = f"Undecided: there are too few values for the reading {of_reading}. why"
    found = Verdict(expected, reason, [], "but; and", verdicts, readings[0])
    assert combine_readings(verdicts, "why", [], ["but", "and"]) == found


def test_every_claim_that_reads_data_fails_in_some_case() -> None:
    reading = {name for name, claim in CLAIMS.items() if claim.reads or claim.depends_on}
    assert {name for name, verdict, _ in CASES if verdict in (FAILS, CONVENTION, READING)} == reading


def _under(laws: list[str]) -> Summaries:
    """Return the world with other names of the laws; surplus laws are left out."""
    world = paper_world()
    for key, dataset in world.items():
        for name, names in (("law", laws), ("other_law", laws[1:])):
            if name in dataset.dims:
                dataset = dataset.isel({name: slice(len(names))}).assign_coords({name: names})
        world[key] = dataset
    return world


def _at(chosen: Callable[[np.ndarray], object]) -> Summaries:
    """Return the world with only some values of a."""
    world = paper_world()
    return world | {key: item.isel(a=chosen(item["a"].values)) for key, item in world.items() if "a" in item.dims}


WITH_DATA = [name for name in CLAIMS if name not in ("dimensionless_equations", "velocities_near_driver")]
# Claims that depend on runs alone: on their kinds, distances, cycles or solvers.
OF_RUNS = ["minus_synchronizes", "chaotic_above", "antiphase", "laws_agree", "solutions_agree"]
AT_ONE = ["plus_mean_distance", "plus_aperiodic", "velocities_touch_zero"]
REPLACED = {"linearized": {"law": "exponential"}, "nonlinear": {}}
MOVED = {"plus": {"position": [0.98, -0.993, -0.991], "velocity": [0.099, 0.1012, 0.1023]}}
FASTER = {"plus": {"position": [0.989, -0.993, -0.991], "velocity": [0.099, 0.1012, 0.1024]}}
LONGER = "the paper's runs have a transient of 3000 and a window of 7000, those of the study "
CHAINS = [{"ends": "ring"}, {"coupling": 2.0}, {"pulling": 1.0}, {"threshold": [1.0, 1.1, 1.0]}]
FEW = (
    "a statement on all 0.005 ≤ a ≤ 0.08 needs values of a from 0.005 to 0.0275, from 0.035 to 0.065 and from 0.0725 "
    "to 0.08, where the study has none"
)
SPRINGS = "the study's chain has other springs, masses or static friction than the paper's"


@pytest.mark.parametrize(
    ("names", "world", "config", "reason"),
    [
        (WITH_DATA, dict, {}, "the study has no summary …"),
        (CLAIMS, paper_world, {"v": 0.2}, "the paper's driver has v = 0.1, that of the study v = 0.2"),
        (WITH_DATA, lambda: _under(["stribeck"]), {"laws": {"stribeck": {}}}, "the study has no linearized law"),
        (WITH_DATA, paper_world, {"laws": REPLACED}, "the study's linearized law is not the paper's"),
        *((CLAIMS, paper_world, {"chain": chain}, SPRINGS) for chain in CHAINS),
        (OF_RUNS, paper_world, {"transient": 2999}, LONGER + "2999 and 7000"),
        (OF_RUNS, paper_world, {"window": 6999}, LONGER + "3000 and 6999"),
        (["plus_mean_distance"], paper_world, {"initial": MOVED}, "the study's initial state plus is not the paper's"),
        (["plus_mean_distance"], paper_world, {"initial": FASTER}, "the study's initial state plus is not the paper's"),
        (["minus_synchronizes"], paper_world, {"initial": MOVED}, "the study has no initial state minus"),
        (["equilibrium"], paper_world, {"chain": {"blocks": 4}}, "the paper's chain has 3 blocks, that of the study 4"),
        (AT_ONE, lambda: _at(lambda a: a != 0.08), {}, "a = 0.08 is not in the grid"),
        (["minus_synchronizes"], lambda: _at(lambda a: slice(None, None, 8)), {}, FEW),
    ],
)
def test_no_claim_is_judged_from_a_setting_that_is_not_the_papers(
    names: Iterable[str], world: Callable[[], Summaries], config: dict[str, object], reason: str
) -> None:
    """The same holds without the data, and for values that are not in the grid."""
    start, _, end = f"Not testable here: {reason}.".partition("…")
    summaries = world()
    for name in names:
        verdict = judge_claim(name, evidence(summaries, **config))
        assert verdict.verdict == NOT_TESTABLE, name
        assert verdict.reason.startswith(start)
        assert verdict.reason.endswith(end)


def test_equivalent_configs_are_judged() -> None:
    same = {"coupling": [1.0, 1.0], "pulling": [1.0, 2.0, 1.0], "threshold": [1.0, 1.0, 1.0]}
    cases = [("equilibrium", {"chain": same}), ("equilibrium", {"window": 200})]
    for name, config in [*cases, *((name, {"window": 20_000}) for name in OF_RUNS)]:
        assert judge_claim(name, evidence(paper_world(), **config)).verdict == HOLDS
    # Ten values of a are enough, if they cover the range.
    few = _at(lambda a: np.isin(a, [0.005, 0.015, 0.025, 0.03, 0.04, 0.05, 0.055, 0.065, 0.07, 0.08]))
    assert judge(CLAIMS["minus_synchronizes"], evidence(few)).verdict == HOLDS


@pytest.mark.parametrize("name", CLAIMS)
def test_claims_about_one_law_are_judged_without_the_other(name: str) -> None:
    """No claim fails because a law is missing: it is judged from the law that it concerns, or not testable."""
    verdict = judge_claim(name, evidence(_under(["linearized"]), laws={"linearized": {}}))
    needed = CLAIMS[name].parameters.get("laws", [CLAIMS[name].parameters.get("law", "nonlinear")])
    if "nonlinear" in needed:
        assert (verdict.verdict, verdict.reason) == (NOT_TESTABLE, "Not testable here: the study has no nonlinear law.")
    else:
        assert verdict.verdict == HOLDS, verdict.reason


@pytest.fixture(scope="module")
def three_laws() -> Summaries:
    """The world with a third law, whose numbers would contradict every claim."""
    world = {}
    for key, item in paper_world().items():
        dimensions = [dimension for dimension in ("law", "other_law") if dimension in item.dims]
        names = {dimension: [*item[dimension].values, "stribeck"] for dimension in dimensions}
        world[key] = item.reindex(names, fill_value=-1)
    return world


@pytest.mark.parametrize("name", CLAIMS)
def test_an_additional_law_changes_no_verdict(three_laws: Summaries, name: str) -> None:
    laws = {"linearized": {}, "nonlinear": {}, "stribeck": {}}
    assert judge_claim(name, evidence(three_laws, laws=laws)) == judge_claim(name, evidence(paper_world()))
    first = judge_claim(name, evidence(three_laws, laws={"stribeck": {}, **laws}))
    compared = name in ("laws_agree", "laws_agree_in_kind", "stick_slip_alone", "two_blocks_agree")
    assert first.verdict == (NOT_TESTABLE if compared else HOLDS)
    assert ("compared with its first one, the stribeck law" in first.reason) == compared


@pytest.mark.parametrize("name", ["laws_agree", "laws_agree_in_kind", "stick_slip_alone", "two_blocks_agree"])
def test_laws_are_compared_whichever_comes_first(name: str) -> None:
    names = ["nonlinear", "linearized"]
    verdict = judge_claim(name, evidence(_under(names), laws={law: {} for law in names}))
    assert verdict.verdict == HOLDS, verdict.reason


def test_runs_that_did_not_complete_are_not_evidence() -> None:
    world = paper_world()
    for name, value in {"status": 1, "synchronized": 0, "mean_distance": np.nan}.items():
        at(world["mean_distance"], name, value, a=ONE_OF_MANY)
    assert judge(CLAIMS["minus_synchronizes"], evidence(world)).verdict == HOLDS
    at(world["mean_distance"], "status", 1)
    assert judge(CLAIMS["minus_synchronizes"], evidence(world)).verdict == NOT_TESTABLE


def test_conventions_are_those_of_the_study() -> None:
    world = paper_world()
    alterations.reached(0, initial="plus", contact="symmetric", start="moving")(world)
    own = judge(CLAIMS["plus_does_not_synchronize"], evidence(world, contact="symmetric"))
    # Under its own convention a study is judged by its runs, in which plus does not synchronize here.
    assert own.verdict == HOLDS
    assert own.conventions == dict.fromkeys(sorted(own.conventions), HOLDS)
    assert len(own.conventions) == 4


@pytest.mark.parametrize("chain", [Chain(3, coupling=2.0), Chain(3, pulling=1.0), Chain(3, threshold=(1.0, 1.0, 1.1))])
def test_eq_1_is_that_of_the_papers_chain_only(chain: Chain) -> None:
    assert equation_difference(Chain(3), np.random.default_rng(1)) == 0
    assert equation_difference(chain, np.random.default_rng(1)) > 0


def test_eq_2_is_what_a_run_solves() -> None:
    """Eq. 1 is solved by SciPy with units, from a state in which all blocks slip."""
    mass, spring, friction, slope, speed = 3.0, 7.0, 5.0, 0.4, 0.6
    root = np.sqrt(spring * mass)
    a, v = slope * friction / root, speed * root / friction
    model = Model(Chain(3), law_of("nonlinear", a), v=v)
    start = InitialState("start", (-0.8, -0.65, -0.8), (1.1 * v, 0.9 * v, v))
    length, time = friction / spring, np.sqrt(mass / spring)
    springs = spring * np.array([[2.0, -1.0, 0.0], [-1.0, 4.0, -1.0], [0.0, -1.0, 2.0]])

    def motion(t: float, state: np.ndarray) -> np.ndarray:
        position, velocity = np.split(state, 2)
        pull = spring * np.array([1.0, 2.0, 1.0]) * speed * t - springs @ position
        return np.concatenate([velocity, (pull - friction / (1.0 + slope * velocity)) / mass])

    first = np.concatenate([length * np.array(start.position), length / time * np.array(start.velocity)])
    found = solve_ivp(motion, (0.0, time), first, "DOP853", rtol=1e-12, atol=1e-14).y[:, -1]
    assert (found[3:] > 0.0).all()
    end = Runner(model).state_after(model.begin(start), 1.0)
    assert end.velocity == pytest.approx(found[3:] * time / length, rel=1e-9)
    position = end.position + model.sliding_offset + v
    assert position == pytest.approx(found[:3] / length, rel=1e-9)


@pytest.mark.parametrize(
    ("shares", "expected"),
    [
        ({"linearized": (20, 20), "nonlinear": (20, 20)}, "at all 20 values of a with a > 0, under both laws"),
        ({"minus": (0, 20), "plus": (0, 20)}, "at none of the 20 values of a with a > 0, from both states"),
        ({"linearized, minus": (20, 20)}, "at all 20 values of a with a > 0 (linearized, minus)"),
        ({"linearized": (20, 20), "nonlinear": (19, 20)}, "at 100 % (linearized) and 95.0 % (nonlinear) of the values"),
        ({"linearized": (20, 20), "nonlinear": (0, 20)}, "at 100 % (linearized) and 0 % (nonlinear) of the values"),
        ({"linearized": (20, 20), "nonlinear": (19, 19)}, "at 100 % (linearized) and 100 % (nonlinear) of the values"),
        # Few values are counted.
        ({"linearized": (3, 3), "nonlinear": (3, 3)}, "at 3 of 3 (linearized) and 3 of 3 (nonlinear) of the values"),
    ],
)
def test_what_is_true_everywhere_is_said_in_words(shares, expected):
    text = at_values({name: Share(*counts) for name, counts in shares.items()}, "a > 0")
    assert text.startswith(expected)
    (first, *_) = shares.values()
    alone = at_values(Share(*first), "a > 0")
    assert "(" not in alone
    assert "law" not in alone


def test_all_pairs_of_laws_and_states_are_named_as_such():
    names = [f"{law}, {state}" for law in ("linearized", "nonlinear") for state in ("minus", "plus")]
    text = at_values(dict.fromkeys(names, Share(10, 10)))
    assert text == "at all 10 values of a, from both states, under both laws"
    assert at_values(dict.fromkeys(names[:3], Share(10, 10))).endswith(f"({'; '.join(names[:3])})")
