"""States that round to the paper's, and the attractors that they reach."""

from burridge_knopoff.claims.ledger import ledger
from burridge_knopoff.claims.paper import CLAIMS
from burridge_knopoff.claims.range import Range
from burridge_knopoff.claims.rounding import rounded_state_changes
from burridge_knopoff.claims.verdict import HOLDS
from tests.claims.worlds import evidence, paper_world

BELOW = CLAIMS["regular_below"].parameters["a"]


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
    text = "some states that round to plus reach another attractor at {} of a (linearized)"
    # The last claim is about all values of a.
    expected = [text.format("1 value"), "", "", text.format("2 values")]
    assert [claim["changes"] for claim in content["claims"]] == expected
    assert content["rounding"] == ["plus: at a = 0.05, 0.2 (linearized)"]
    assert ledger("test", [], evidence(world, v=0.2), [])["rounding"] == []
    assert all(claim["verdict"] == HOLDS for claim in content["claims"])
