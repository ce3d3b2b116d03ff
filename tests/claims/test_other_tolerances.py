"""The effect of halving and doubling the study's own tolerances on the evidence and on verdicts."""

import numpy as np
import pytest

from burridge_knopoff.claims.ledger import judge, ledger
from burridge_knopoff.claims.other_tolerances import other_tolerances
from burridge_knopoff.claims.paper import CLAIMS
from burridge_knopoff.claims.range import Range
from burridge_knopoff.claims.rounding import rounded_state_changes
from burridge_knopoff.claims.verdict import FAILS, HOLDS
from burridge_knopoff.motion.kind import MotionKind
from tests.claims.worlds import evidence, paper_world

BELOW = CLAIMS["regular_below"].parameters["a"]


def by_name(world):
    return dict(other_tolerances(evidence(world)))


def test_each_tolerance_is_halved_and_doubled():
    names = list(by_name(paper_world()))
    assert len(names) == len(set(names)) == 14
    assert {
        "agreement.relative_tolerance were 0.2 (it is 0.1)",
        "motion.zero_exponent were 0.00025 (it is 0.0005)",
    } <= set(names)
    assert {"motion.standard_errors were 6 (it is 3)", "synchronization_threshold were 5e-07 (it is 1e-06)"} <= set(
        names
    )
    assert by_name({}) == {}


def test_a_tolerance_of_agreement_decides_where_laws_part():
    world = paper_world()
    # The second law is 15 % off: beyond the tolerance of 10 %, within twice that.
    plus = {"initial": "plus"}
    for name, dims in (("runs", plus), ("agreement", plus), ("two_blocks", {})):
        world[name]["mean_distance"].loc[{"law": "nonlinear", **dims}] = 0.161
    others = by_name(world)
    for claim in ("laws_agree", "two_blocks_agree"):
        verdicts = {name: judge(CLAIMS[claim], other).verdict for name, other in others.items()}
        assert verdicts.pop("agreement.relative_tolerance were 0.2 (it is 0.1)") == HOLDS
        assert set(verdicts.values()) == {FAILS}


@pytest.mark.parametrize(
    ("exponent", "name", "kind"),
    [
        # An exponent of 0.0015 is not chaotic at twice the threshold; 0.0008 is chaotic at half of it.
        (0.0015, "motion.chaotic_exponent were 0.002 (it is 0.001)", MotionKind.UNDETERMINED),
        (0.0008, "motion.chaotic_exponent were 0.0005 (it is 0.001)", MotionKind.CHAOTIC),
    ],
)
def test_a_tolerance_of_motion_decides_what_is_chaos(exponent, name, kind):
    world = paper_world()
    world["runs"]["lyapunov_exponent"].loc[{"exponent": 0, "initial": "plus"}] = exponent
    settled = by_name(world)[name].summaries
    # Without attractors the runs alone decide.
    del world["attractors"]
    alone = by_name(world)
    assert (alone[name].summaries["lyapunov"]["run_kind"].sel(initial="plus") == kind).all()
    kinds = alone[name].summaries["agreement"]["kind"]
    assert (kinds.sel(initial="plus") == kind).all()
    same = alone["motion.longest_period were 4000 (it is 2000)"].summaries["agreement"]["kind"]
    assert (kinds == same).sel(initial="minus").all()
    # A run of undetermined kind has the kind of the attractor that it has reached.
    of_attractor = MotionKind.QUASIPERIODIC if kind == MotionKind.UNDETERMINED else kind
    assert (settled["agreement"]["kind"].sel(initial="plus", a=slice(0.01, 0.09)) == of_attractor).all()


def test_a_tolerance_of_motion_decides_which_exponents_are_zero():
    world = paper_world()
    for summary in ("runs", "lyapunov"):
        world[summary]["lyapunov_exponent"].loc[{"exponent": 0, "initial": "plus"}] = 4e-4
    assert judge(CLAIMS["plus_largest_exponent"], evidence(world)).verdict == HOLDS
    verdicts = {name: judge(CLAIMS["plus_largest_exponent"], other).own for name, other in by_name(world).items()}
    for name in (
        "motion.zero_exponent were 0.00025 (it is 0.0005)",
        "motion.chaotic_exponent were 0.0005 (it is 0.001)",
    ):
        assert verdicts[name] == (FAILS if "zero" in name else HOLDS)


def test_the_threshold_of_synchrony_decides_which_runs_synchronize():
    world = paper_world()
    for summary in ("runs", "mean_distance"):
        world[summary]["mean_distance"].loc[{"initial": "minus"}] = 1.5e-6
    world["mean_distance"]["synchronized"].loc[{"initial": "minus"}] = 0
    found = {name: judge(CLAIMS["minus_synchronizes"], other).own for name, other in by_name(world).items()}
    assert found.pop("synchronization_threshold were 2e-06 (it is 1e-06)") == HOLDS
    assert set(found.values()) == {FAILS}


def test_the_evidence_itself_is_not_changed():
    world, same = paper_world(), paper_world()
    list(other_tolerances(evidence(world)))
    assert all(world[name].identical(same[name]) for name in same)


@pytest.mark.slow
def test_states_that_round_to_the_papers_and_reach_another_attractor_are_listed():
    world = paper_world()
    assert rounded_state_changes(evidence(world), ["minus", "plus"], ["linearized"], BELOW) == {}
    rounded = world["attractors"]["rounded_branch"]
    rounded.loc[{"law": "linearized", "initial": "plus", "a": [0.05, 0.2], "corner": 1}] = 0
    # An unknown attractor does not count as another one.
    rounded.loc[{"law": "linearized", "initial": "plus", "a": 0.03}] = -1
    (differs,) = rounded_state_changes(evidence(world), ["plus"], ["linearized", "nonlinear"], BELOW).values()
    assert differs["a"].values[differs].tolist() == [0.05]
    assert rounded_state_changes(evidence(world), ["plus"], ["linearized"], Range(first=0.08, last=0.08)) == {}
    names = ("plus_does_not_synchronize", "minus_synchronizes", "plus_mean_distance", "friction_keeps_sign")
    content = ledger("test", [CLAIMS[name] for name in names], evidence(world), [])
    text = "some states that round to plus reach another attractor at 1 value of a (linearized)"
    assert [claim["changes"] for claim in content["claims"]] == [text, "", "", ""]
    assert content["rounding"] == ["plus: at a = 0.05, 0.2 (linearized)"]
    assert ledger("test", [], evidence(world, v=0.2), [])["rounding"] == []
    assert np.all([claim["verdict"] == HOLDS for claim in content["claims"]])
