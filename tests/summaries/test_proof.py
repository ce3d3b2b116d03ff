"""The summary of what is proved: its numbers, its words, its bytes, and where it does not apply."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest
from flint import arb

from burridge_knopoff import Chain, FormulaLaw, Model, law_of
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbits
from burridge_knopoff.periodic_orbits.floquet import multipliers
from burridge_knopoff.periodic_orbits.flow import flow
from burridge_knopoff.periodic_orbits.synchronized_bifurcations import bifurcations_of, critical_a
from burridge_knopoff.proof.balls import ProofError
from burridge_knopoff.proof.scope import is_covered
from burridge_knopoff.summaries import proof
from burridge_knopoff.summaries.results import write_results
from tests.refused import refused

PAPER, NONLINEAR = (Model(Chain(3), law_of(law, 0.0)) for law in ("linearized", "nonlinear"))
TOLD = 1e-13


@pytest.fixture(scope="module")
def found():
    return proof.summarize([PAPER, NONLINEAR])


@pytest.fixture(scope="module")
def linearized(found):
    return found.sel(law="linearized")


@pytest.mark.parametrize("model", [PAPER, NONLINEAR], ids=["linearized", "nonlinear"])
def test_every_interval_is_about_the_number_of_the_double_code(found, model):
    family, of_law = synchronized_orbits(model), found.sel(law=model.law.name)
    a_c = critical_a(bifurcations_of(family))
    for name, a in (("given", 0.08), ("critical", a_c)):
        orbit, one = family.at(a), of_law.sel(orbit=name)
        assert one["a"].values == pytest.approx([a, a], abs=2e-15)
        assert one["period"].values == pytest.approx([orbit.period] * 2, abs=TOLD)
        at = {(block, kind): time for time, block, kind in orbit.events}
        first = at[1, 1]
        state = flow(orbit.model, orbit.reference, first)[0].state().position[:2]
        assert one["position"].values == pytest.approx(np.stack([state] * 2, axis=1), abs=TOLD)
        times = [*((at[event] - first) % orbit.period for event in ((0, 1), (0, 0), (1, 0))), orbit.period]
        assert one["event_time"].values == pytest.approx(np.stack([times] * 2, axis=1), abs=TOLD)
        multiplier = multipliers(orbit)
        expected = [multiplier.transverse.real, multiplier.keeping[0].real]
        assert one["multiplier"].values == pytest.approx(np.stack([expected] * 2, axis=1), abs=1e-11)
    assert of_law["critical_a"].values == pytest.approx([a_c] * 2, abs=2e-15)


def test_intervals_are_narrow_and_open_to_the_right_sides(found):
    for name in ("critical_a", "a", "period", "event_time", "position", "multiplier", "multiplier_slope"):
        low, high = (found[name].sel(end=end).values for end in proof.END)
        assert (low <= high).all()
        assert (high - low < (1e-6 if name == "multiplier_slope" else 1e-10)).all()
    low, high = found["critical_a"].sel(end="low"), found["critical_a"].sel(end="high")
    assert (high - low < proof.NARROW).all()
    assert (found["critical_a_width"] < [1e-50, 1e-17]).all()
    assert found["family_between"].values[0].tolist() == found["only_between"].values[0].tolist() == [0.08, 0.1]
    assert np.isnan(found["family_between"].values[1]).all()
    assert found["only_between"].values[1, 0] < low[1] < high[1] < found["only_between"].values[1, 1]
    assert found["pieces"].values.tolist()[1] == 0 < found["pieces"].values.tolist()[0]
    assert (found["least_friction"] > 0.97).all()
    assert (found["least_spring_force"] > 0.89).all()


@pytest.mark.parametrize("law", ["linearized", "nonlinear"])
def test_the_digits_are_those_between_the_doubles(found, law):
    middle, error = found["critical_a_digits"].sel(law=law).item().strip("[]").split(" +/- ")
    low, high = map(Fraction, found["critical_a"].sel(law=law).values.tolist())
    assert low < Fraction(middle) < high
    assert Fraction(error) < Fraction(1, 10**17 if law == "nonlinear" else 10**40)


def test_the_words_hold_the_numbers_and_what_is_assumed(found):
    text = proof.digest(found)
    for law in ("linearized", "nonlinear"):
        assert f"{law} law: a_c = {found['critical_a_digits'].sel(law=law).item()}\n" in text
    for name in ("critical_a", "only_between", "period", "multiplier", "event_time"):
        for number in found[name].values.ravel().tolist():
            assert repr(number) in text
    assert text.count("For every a from 0.08 to 0.1 there is such an orbit") == 1
    assert "\nAssumed: " in text
    assert max(map(len, text.splitlines())) <= 120


def test_the_same_bytes(linearized, tmp_path):
    for name in ("one", "other"):
        dataset = proof.summarize([PAPER])
        write_results(dataset, proof, {str(tmp_path / f"{name}.{suffix}"): {} for suffix in ("nc", "txt")})
        assert (dataset["multiplier"].values == linearized["multiplier"].values).all()
    for suffix in ("nc", "txt"):
        assert (tmp_path / f"one.{suffix}").read_bytes() == (tmp_path / f"other.{suffix}").read_bytes()


def test_v_is_only_a_scale(linearized):
    other = proof.summarize([replace(PAPER, v=0.4, contact="symmetric")]).sel(law="linearized")
    for name in ("critical_a", "period", "multiplier"):
        assert (other[name] == linearized[name]).all()
    assert other["position"].values == pytest.approx(4.0 * linearized["position"].values, rel=1e-12)
    for name in ("least_spring_force", "least_friction"):
        assert 1.0 - other[name].values == pytest.approx(4.0 * (1.0 - linearized[name].values))


OTHERS = [
    replace(PAPER, chain=Chain(2)),
    replace(PAPER, chain=Chain(4)),
    replace(PAPER, chain=Chain(3, coupling=1.1)),
    replace(PAPER, chain=Chain(3, pulling=1.0)),
    replace(PAPER, chain=Chain(3, threshold=(1.0, 0.9, 1.0))),
    replace(PAPER, chain=Chain(3, ends="ring")),
    replace(PAPER, law=law_of("exponential", 0.08)),
    replace(NONLINEAR, v=0.2),
    replace(NONLINEAR, chain=Chain(3, coupling=1.1)),
    replace(PAPER, law=FormulaLaw(0.08, "1 - a*u/2")),
    replace(PAPER, v=2.0, contact="symmetric"),
]


@pytest.mark.parametrize("model", OTHERS)
def test_other_models_are_not_covered(model):
    assert not is_covered(model)
    with pytest.raises(ProofError, match=r"law \w+: not covered"):
        proof.summarize([model])


@pytest.mark.parametrize(
    "model",
    [
        PAPER,
        NONLINEAR,
        replace(NONLINEAR, contact="symmetric"),
        replace(PAPER, v=3.0),
        replace(PAPER, v=1.0, contact="symmetric"),
        replace(PAPER, law=FormulaLaw(0.08, "1 - a*u", name="mine")),
        replace(PAPER, chain=Chain(3, pulling=(1.0, 2.0, 1.0), coupling=(1.0, 1.0))),
    ],
)
def test_what_is_covered_does_not_depend_on_names_or_on_v(model):
    assert is_covered(model)


def test_a_family_that_loses_its_certificate_is_no_proof(monkeypatch):
    """If a_c lay beyond the range that is covered, or its interval were wide, there would be no summary."""
    monkeypatch.setattr(proof, "RANGE", ((8, 100), (82, 1000)))
    with pytest.raises(ProofError, match="not in the range of a that is covered"):
        proof.summarize([PAPER])
    monkeypatch.setattr(proof, "RANGE", ((86, 1000), (88, 1000)))
    monkeypatch.setattr(proof, "GIVEN", (86, 1000))
    monkeypatch.setattr(proof, "NARROW", 1e-60)
    with pytest.raises(ProofError, match=r"a_c: got an interval of width .*, expected below 1e-60"):
        proof.summarize([PAPER])


@pytest.mark.parametrize("loose", range(3))
@pytest.mark.parametrize("contact", ["one_sided", "symmetric"])
def test_under_a_symmetric_contact_every_stuck_block_has_to_hold_a_pull_back(contact, loose):
    """Whether the given orbit, the critical one or one of the branch between them is the one that might let go."""
    tightness = [1.0] * 3
    tightness[loose] = 3.0
    one, other, third = (
        SimpleNamespace(
            a=0.08, tightest=lambda value=value: arb(value), symmetric_multiplier=arb(0.5), multiplier=arb(0.5)
        )
        for value in tightness
    )
    critical = SimpleNamespace(orbit=other, a=arb(0.0869))
    told = replace(PAPER, v=1.0, contact=contact), one, critical, [SimpleNamespace(orbit=third)]
    if contact == "one_sided":
        proof._check(*told)
    else:
        with refused("a = 0.08, v = 1.0: stuck blocks are not known to hold", error=ProofError):
            proof._check(*told)
