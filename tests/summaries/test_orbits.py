"""The summary of the synchronized orbit: what it holds, and what it says where there is none."""

import numpy as np
import pytest

from burridge_knopoff import Chain, Model, law_of
from burridge_knopoff.stability.family import Family
from burridge_knopoff.stability.orbit import multipliers, transverse_multiplier
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.summaries.orbits import COMPARISON, effective_a, summarize


def models(laws=PAPER_LAWS, chain=None, **options):
    return [Model(chain or Chain(3), law_of(law, 0.1), **options) for law in laws]


@pytest.fixture(scope="module")
def found():
    return summarize(models(), [0.0, 0.05, 0.1])


def test_the_curve_is_that_of_the_orbits(found):
    assert found["status"].values.tolist() == [[1, 0, 0]] * 2
    assert found.attrs["v"] == 0.1
    for law in PAPER_LAWS:
        for a in (0.05, 0.1):
            orbit = Family(Model(Chain(3), law_of(law, 0.0))).at(a)
            point = found.sel(law=law, a=a)
            values = point["multiplier"].sel(part="real").values + 1j * point["multiplier"].sel(part="imaginary").values
            assert values == pytest.approx(multipliers(orbit), abs=1e-12)
            assert values[0] == point["transverse_multiplier"].item()
            assert point["period"].item() == pytest.approx(orbit.period, abs=1e-13)
            assert point["lateral_slip_time"].item() == pytest.approx(orbit.lateral_slip_time, abs=1e-12)
            assert point["residual"].item() <= 1e-14
    assert np.isnan(found["period"].sel(a=0.0)).all()


def test_the_bifurcation_is_told_from_the_orbits(found):
    meanings = {
        name: dict(zip(found[name].attrs["flag_values"], found[name].attrs["flag_meanings"].split(), strict=True))
        for name in ("bifurcation_kind", "bifurcation_side")
    }
    assert [meanings["bifurcation_kind"][value] for value in found["bifurcation_kind"].values] == ["pitchfork"] * 2
    assert [meanings["bifurcation_side"][value] for value in found["bifurcation_side"].values] == ["supercritical"] * 2
    assert (found["branch_offset"] > 0.0).all()
    assert (found["branch_multiplier"] < 1.0).all()
    assert (found["branch_residual"] <= 1e-14).all()
    assert (abs(found["amplitude_exponent"] - 0.5) < 1e-5).all()
    assert (found["hysteresis"] < 1e-9).all()
    ends = found["sweep_asymmetry"]
    assert (ends.sel(sweep_offset=found["sweep_offset"] > 0) > 4e-3).all()


def test_the_law_at_the_same_slope(found):
    """The stored differences are those of orbits found for themselves."""
    nonlinear = models()[1]
    scaled = effective_a(nonlinear, 0.1)
    assert scaled == pytest.approx(0.1 / 1.01**2, rel=1e-15)
    pair = [Family(model).at(a) for model, a in zip(models(), (scaled, 0.1), strict=True)]
    point = found.sel(a=0.1)
    assert point["effective_a"].item() == scaled
    expected = transverse_multiplier(pair[1]) - transverse_multiplier(pair[0])
    assert point["effective_multiplier_difference"].item() == pytest.approx(expected, abs=1e-12)
    assert point["effective_period_difference"].item() == pytest.approx(pair[1].period - pair[0].period, abs=1e-12)
    critical = found["critical_a"].values
    assert found["effective_critical_a_difference"].item() == effective_a(nonlinear, critical[1]) - critical[0]


@pytest.mark.parametrize(("blocks", "v", "status"), [(2, 0.1, 3), (5, 0.1, 3), (3, 1000.0, 2)])
def test_no_orbit_is_told_not_a_crash(blocks, v, status):
    # Under a symmetric contact so fast a driver makes blocks slip backward: no block stops once a period.
    none = summarize(models(chain=Chain(blocks), v=v, contact="symmetric"), [0.1, 0.2])
    assert (none["status"] == status).all()
    for name in ("period", "critical_a", "grazing_a", "multiplier", "branch_offset", "hysteresis"):
        assert np.isnan(none[name]).all()
    assert (none["bifurcation_kind"] == -1).all()
    assert (none["bifurcation_side"] == -1).all()


def test_other_laws_have_their_rows(found):
    """In the order of the study, without a comparison that is the paper's."""
    other = summarize(models(("exponential", "nonlinear", "carlson_langer")), [0.0, 0.1])
    assert other["law"].values.tolist() == ["exponential", "nonlinear", "carlson_langer"]
    # Static friction that drops at the start of a slip feeds motion at a = 0 too.
    assert other["status"].values.tolist() == [[1, 0], [1, 0], [2, 0]]
    assert not set(COMPARISON) & set(other)
    assert set(COMPARISON) < set(found)
    for name in ("period", "transverse_multiplier", "center_stick_time"):
        same = found[name].sel(law="nonlinear", a=0.1), other[name].sel(law="nonlinear", a=0.1)
        assert same[0].item() == pytest.approx(same[1].item(), abs=1e-12)
    critical = other["critical_a"].sel(law="exponential").item()
    # Under a drop a stick of block 2 does not begin at length 0: the orbit is lost, or jumps.
    assert np.isnan(other["grazing_a"].sel(law="carlson_langer"))
    # Φ = exp(−aU') weakens less than 1 − aU' and more than 1/(1 + aU').
    assert found["critical_a"].values[0] < critical < found["critical_a"].values[1]


def test_an_asymmetric_chain_has_no_synchronized_orbit():
    none = summarize(models(chain=Chain(3, threshold=(1.0, 1.0, 0.9))), [0.1])
    assert (none["status"] == 2).all()
    assert np.isnan(none["critical_a"]).all()
