"""The claims in studies with other settings, values of a and laws than the paper's."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np
import pytest

from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.ledger import judge
from burridge_knopoff.claims.paper import CLAIMS
from burridge_knopoff.claims.verdict import HOLDS, NOT_TESTABLE
from burridge_knopoff.study.paper import PAPER_LAWS
from tests.claims.alterations import judge_claim
from tests.claims.worlds import Summaries, evidence, paper_world


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
SPRINGS = "the study's chain has other springs, masses or friction than the paper's"


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


@pytest.fixture(scope="module")
def one_law() -> Evidence:
    return evidence(_under(["linearized"]), laws={"linearized": {}})


@pytest.mark.parametrize("name", CLAIMS)
def test_claims_about_one_law_are_judged_without_the_other(one_law: Evidence, name: str) -> None:
    """No claim fails because a law is missing: it is judged from the law that it concerns, or not testable."""
    verdict = judge_claim(name, one_law)
    needed = CLAIMS[name].parameters.get("laws", [CLAIMS[name].parameters.get("law", "nonlinear")])
    if "nonlinear" in needed:
        assert (verdict.verdict, verdict.reason) == (NOT_TESTABLE, "Not testable here: the study has no nonlinear law.")
    else:
        assert verdict.verdict == HOLDS, verdict.reason


@pytest.fixture(scope="module")
def paper_evidence() -> Evidence:
    return evidence(paper_world())


@pytest.fixture(scope="module")
def three_laws() -> list[Evidence]:
    """The world with a third law after the others, and before them, whose numbers would contradict every claim."""
    world = {}
    for key, item in paper_world().items():
        dimensions = [dimension for dimension in ("law", "other_law") if dimension in item.dims]
        names = {dimension: [*item[dimension].values, "stribeck"] for dimension in dimensions}
        world[key] = item.reindex(names, fill_value=-1)
    orders = [*PAPER_LAWS, "stribeck"], ["stribeck", *PAPER_LAWS]
    return [evidence(world, laws={law: {} for law in order}) for order in orders]


@pytest.mark.parametrize("name", CLAIMS)
def test_an_additional_law_changes_no_verdict(three_laws: list[Evidence], paper_evidence: Evidence, name: str) -> None:
    last, first = (judge_claim(name, data) for data in three_laws)
    assert last == judge_claim(name, paper_evidence)
    compared = name in ("laws_agree", "laws_agree_in_kind", "stick_slip_alone", "two_blocks_agree")
    assert first.verdict == (NOT_TESTABLE if compared else HOLDS)
    assert ("compared with its first one, the stribeck law" in first.reason) == compared


@pytest.mark.parametrize("name", ["laws_agree", "laws_agree_in_kind", "stick_slip_alone", "two_blocks_agree"])
def test_laws_are_compared_whichever_comes_first(name: str) -> None:
    names = ["nonlinear", "linearized"]
    verdict = judge_claim(name, evidence(_under(names), laws={law: {} for law in names}))
    assert verdict.verdict == HOLDS, verdict.reason
