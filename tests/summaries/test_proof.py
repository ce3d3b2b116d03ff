"""The summary of the proofs: its numbers, text and bytes, and studies to which it does not apply."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from burridge_knopoff import Model
from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbits
from burridge_knopoff.periodic_orbits.floquet import multipliers
from burridge_knopoff.periodic_orbits.flow import flow
from burridge_knopoff.periodic_orbits.synchronized_bifurcations import bifurcations_of, critical_a
from burridge_knopoff.summaries import proof

PAPER, NONLINEAR = (Model(law, a=0.0) for law in ("linearized", "nonlinear"))
TOLERANCE = 1e-13


@pytest.fixture(scope="module")
def dataset():
    return proof.summarize([PAPER, NONLINEAR])


@pytest.fixture(scope="module")
def linearized(dataset):
    return dataset.sel(law="linearized")


@pytest.mark.slow
@pytest.mark.parametrize("model", [PAPER, NONLINEAR], ids=["linearized", "nonlinear"])
def test_every_interval_agrees_with_double_precision(dataset, model):
    family, part = synchronized_orbits(model), dataset.sel(law=model.law.name)
    a_c = critical_a(bifurcations_of(family))
    for name, a in (("given", 0.08), ("critical", a_c)):
        orbit, interval = family.at(a), part.sel(orbit=name)
        assert interval["a"].values == pytest.approx([a, a], abs=2e-15)
        assert interval["period"].values == pytest.approx([orbit.period] * 2, abs=TOLERANCE)
        at = {(block, kind): time for time, block, kind in orbit.events}
        first = at[1, 1]
        state = flow(orbit.model, orbit.reference, first).state().position[:2]
        assert interval["position"].values == pytest.approx(np.stack([state] * 2, axis=1), abs=TOLERANCE)
        times = [*((at[event] - first) % orbit.period for event in ((0, 1), (0, 0), (1, 0))), orbit.period]
        assert interval["event_time"].values == pytest.approx(np.stack([times] * 2, axis=1), abs=TOLERANCE)
        multiplier = multipliers(orbit)
        expected = [multiplier.transverse.real, multiplier.symmetry_preserving[0].real]
        assert interval["multiplier"].values == pytest.approx(np.stack([expected] * 2, axis=1), abs=1e-11)
    assert part["critical_a"].values == pytest.approx([a_c] * 2, abs=2e-15)


@pytest.mark.slow
def test_intervals_are_narrow_and_rounded_outward(dataset):
    for name in ("critical_a", "a", "period", "event_time", "position", "multiplier", "multiplier_slope"):
        low, high = (dataset[name].sel(end=end).values for end in proof.END)
        assert (low <= high).all()
        assert (high - low < (1e-6 if name == "multiplier_slope" else 1e-10)).all()
    low, high = dataset["critical_a"].sel(end="low"), dataset["critical_a"].sel(end="high")
    assert (high - low < proof.LARGEST_WIDTH).all()
    assert (dataset["critical_a_width"] < [1e-50, 1e-17]).all()
    assert dataset["family_between"].values[0].tolist() == dataset["only_between"].values[0].tolist() == [0.08, 0.1]
    assert np.isnan(dataset["family_between"].values[1]).all()
    assert dataset["only_between"].values[1, 0] < low[1] < high[1] < dataset["only_between"].values[1, 1]
    assert dataset["pieces"].values.tolist()[1] == 0 < dataset["pieces"].values.tolist()[0]
    assert (dataset["least_friction"] > 0.97).all()
    assert (dataset["least_spring_force"] > 0.89).all()


@pytest.mark.slow
@pytest.mark.parametrize("law", ["linearized", "nonlinear"])
def test_the_digits_are_those_between_the_doubles(dataset, law):
    middle, error = dataset["critical_a_digits"].sel(law=law).item().strip("[]").split(" +/- ")
    low, high = map(Fraction, dataset["critical_a"].sel(law=law).values.tolist())
    assert low < Fraction(middle) < high
    assert Fraction(error) < Fraction(1, 10**17 if law == "nonlinear" else 10**40)


@pytest.mark.slow
def test_the_text_has_the_numbers_and_the_assumptions(dataset):
    text = proof.digest(dataset)
    for law in ("linearized", "nonlinear"):
        assert f"{law} law: a_c = {dataset['critical_a_digits'].sel(law=law).item()}\n" in text
    for name in ("critical_a", "only_between", "period", "multiplier", "event_time"):
        for number in dataset[name].values.ravel().tolist():
            assert repr(number) in text
    assert text.count("For every a from 0.08 to 0.1 there is such an orbit") == 1
    assert "\nAssumed: " in text
    assert max(map(len, text.splitlines())) <= 120


@pytest.mark.slow
def test_the_file_is_reproducible(linearized, tmp_path):
    for name in ("one", "other"):
        dataset = proof.summarize([PAPER])
        write_summary(dataset, tmp_path / f"{name}.nc")
        assert (dataset["multiplier"].values == linearized["multiplier"].values).all()
    assert (tmp_path / "one.nc").read_bytes() == (tmp_path / "other.nc").read_bytes()
