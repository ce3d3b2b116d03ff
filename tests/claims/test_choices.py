"""The effect of halving and doubling the study's own tolerances on the evidence and on verdicts."""

import numpy as np
import pytest

from burridge_knopoff.claims.choices import other_tolerances
from burridge_knopoff.claims.conventions import rounded_state_changes
from burridge_knopoff.claims.ledger import judge, ledger
from burridge_knopoff.claims.verdict import FAILS, HOLDS, Range
from burridge_knopoff.motion.kind import MotionKind
from tests.claims.verdict_texts import CLAIMS
from tests.claims.worlds import evidence, paper_world

BELOW = CLAIMS["regular_below"].parameters["a"]


def by_name(world):
    return dict(other_tolerances(evidence(world)))


def test_each_tolerance_is_halved_and_doubled():
    names = list(by_name(paper_world()))
    assert len(names) == len(set(names)) == 14
    assert {"agreement.relative_tolerance is 0.2 (here 0.1)", "motion.zero_exponent is 0.00025 (here 0.0005)"} <= set(
        names
    )
    assert {"motion.standard_errors is 6 (here 3)", "synchronization_threshold is 5e-07 (here 1e-06)"} <= set(names)
    assert by_name({}) == {}


def test_a_tolerance_of_agreement_decides_where_laws_part():
    world = paper_world()
    # The second law is 15 % off: beyond the tolerance of 10 %, within twice that.
    plus = {"initial": "plus"}
    for name, dims in (("agreement", plus), ("two_blocks", {})):
        world[name]["mean_distance"].loc[{"law": "nonlinear", **dims}] = 0.161
    others = by_name(world)
    for claim in ("laws_agree", "two_blocks_agree"):
        verdicts = {name: judge(CLAIMS[claim], other).verdict for name, other in others.items()}
        assert verdicts.pop("agreement.relative_tolerance is 0.2 (here 0.1)") == HOLDS
        assert set(verdicts.values()) == {FAILS}


@pytest.mark.parametrize(
    ("exponent", "name", "expected"),
    [
        # An exponent of 0.0015 is not chaotic at twice the threshold; 0.0008 is chaotic at half of it.
        (0.0015, "motion.chaotic_exponent is 0.002 (here 0.001)", "not testable"),
        (0.0008, "motion.chaotic_exponent is 0.0005 (here 0.001)", FAILS),
    ],
)
def test_a_tolerance_of_motion_decides_what_is_chaos(exponent, name, expected):
    world = paper_world()
    world["lyapunov"]["lyapunov_exponent"].loc[{"exponent": 0, "initial": "plus"}] = exponent
    kind = MotionKind.CHAOTIC if exponent > 0.001 else MotionKind.UNDETERMINED
    for summary in ("lyapunov", "agreement"):
        world[summary]["run_kind" if summary == "lyapunov" else "kind"].loc[{"initial": "plus"}] = kind
    other = by_name(world)[name]
    changed = other.summaries["agreement"]["kind"].sel(initial="plus").values
    assert (changed == (MotionKind.UNDETERMINED if exponent > 0.001 else MotionKind.CHAOTIC)).all()
    assert (other.summaries["agreement"]["kind"].sel(initial="minus") == world["agreement"]["kind"][:, 0]).all()
    assert judge(CLAIMS["plus_not_periodic"], other).verdict == (HOLDS if expected == FAILS else expected)


def test_the_kind_of_an_attractor_does_not_change():
    world = paper_world()
    world["lyapunov"]["lyapunov_exponent"].loc[{"exponent": 0, "initial": "plus"}] = 0.0008
    world["lyapunov"]["run_kind"].loc[{"initial": "plus"}] = MotionKind.UNDETERMINED
    other = by_name(world)["motion.chaotic_exponent is 0.0005 (here 0.001)"]
    assert (other.summaries["lyapunov"]["run_kind"].sel(initial="plus") == MotionKind.CHAOTIC).all()
    assert (other.summaries["agreement"]["kind"] == world["agreement"]["kind"]).all()


def test_the_threshold_of_synchrony_decides_which_runs_synchronize():
    world = paper_world()
    world["mean_distance"]["mean_distance"].loc[{"initial": "minus"}] = 1.5e-6
    world["mean_distance"]["synchronized"].loc[{"initial": "minus"}] = 0
    found = {name: judge(CLAIMS["minus_synchronizes"], other).own for name, other in by_name(world).items()}
    assert found.pop("synchronization_threshold is 2e-06 (here 1e-06)") == HOLDS
    assert set(found.values()) == {FAILS}


def test_the_evidence_itself_is_not_changed():
    world, same = paper_world(), paper_world()
    list(other_tolerances(evidence(world)))
    assert all(world[name].identical(same[name]) for name in same)


def test_states_that_round_to_the_papers_and_reach_another_attractor_are_listed():
    world = paper_world()
    assert rounded_state_changes(evidence(world), ["minus", "plus"], ["linearized"], BELOW) == []
    rounded = world["attractors"]["rounded_branch"]
    rounded.loc[{"law": "linearized", "initial": "plus", "a": [0.05, 0.2], "corner": 1}] = 0
    # An unknown attractor does not count as another one.
    rounded.loc[{"law": "linearized", "initial": "plus", "a": 0.03}] = -1
    text = "some states that round to plus reach another attractor at a = 0.05 (linearized)"
    assert rounded_state_changes(evidence(world), ["plus"], ["linearized", "nonlinear"], BELOW) == [text]
    assert rounded_state_changes(evidence(world), ["plus"], ["linearized"], Range(first=0.08, last=0.08)) == []
    names = ("plus_does_not_synchronize", "minus_synchronizes", "plus_mean_distance", "friction_keeps_sign")
    content = ledger("test", [CLAIMS[name] for name in names], evidence(world), [])
    assert [claim["changes"] for claim in content["claims"]] == [text, "", "", ""]
    assert np.all([claim["verdict"] == HOLDS for claim in content["claims"]])
