"""The summary of the synchronized orbit: its contents, and its flags where there is no orbit."""

import numpy as np
import pytest
from scipy.optimize import curve_fit

from burridge_knopoff import Chain, FormulaLaw, Model, Symmetry, law_of, multipliers, simulate
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbits
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.periodic_orbits.known_orbits import KnownOrbits
from burridge_knopoff.periodic_orbits.pitchfork import branching_orbit
from burridge_knopoff.periodic_orbits.synchronized_bifurcations import (
    bifurcations_of,
    critical_a,
    critical_a_error,
    grazing_a,
    symmetric_period_doubling_a,
)
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.summaries import orbits
from burridge_knopoff.summaries.amplitude import sweep
from burridge_knopoff.summaries.orbit_flags import BifurcationSide, CriticalStability
from burridge_knopoff.summaries.orbits import COMPARISON, effective_a, summarize
from tests.normal_forms import CRITICAL, antisymmetric, orbit_at


def models(laws=PAPER_LAWS, chain=None, **options):
    return [Model(law, a=0.1, chain=chain or Chain(3), **options) for law in laws]


@pytest.fixture(scope="module")
def dataset():
    return summarize(models(), [0.0, 0.05, 0.1])


@pytest.mark.slow
def test_curves_agree_with_the_orbits(dataset):
    assert dataset["status"].values.tolist() == [[1, 0, 0]] * 2
    assert dataset.attrs["v"] == 0.1
    for law in PAPER_LAWS:
        for a in (0.05, 0.1):
            orbit = synchronized_orbits(Model(law, a=0.0)).at(a)
            point = dataset.sel(law=law, a=a)
            values = point["multiplier"].sel(part="real").values + 1j * point["multiplier"].sel(part="imaginary").values
            expected = multipliers(orbit)
            assert values[0] == pytest.approx(expected.transverse, abs=1e-12)
            assert values[1] == pytest.approx(1.0, abs=1e-12)
            assert values[2:4] == pytest.approx(expected.symmetry_preserving[:2], abs=1e-12)
            assert values[4:].tolist() == [0.0, 0.0]
            assert values[0] == point["transverse_multiplier"].item()
            assert point["period"].item() == pytest.approx(orbit.period, abs=1e-13)
            assert point["lateral_slip_time"].item() == pytest.approx(orbit.period - orbit.stick_time(0), abs=1e-12)
            assert point["residual"].item() <= 1e-14
    assert np.isnan(dataset["period"].sel(a=0.0)).all()


def test_the_bifurcation_follows_from_the_orbits(dataset):
    assert (dataset["bifurcation_kind"] == BifurcationKind.PITCHFORK).all()
    assert (dataset["bifurcation_side"] == BifurcationSide.SUPERCRITICAL).all()
    assert (dataset["branch_offset"] > 0.0).all()
    assert (dataset["branch_multiplier"] < 1.0).all()
    assert (dataset["branch_residual"] <= 1e-14).all()
    assert (abs(dataset["amplitude_exponent"] - 0.5) < 2.0 * dataset["amplitude_exponent_error"]).all()
    assert (dataset["amplitude_exponent_error"] < 1e-6).all()
    assert (dataset["hysteresis"] < 1e-9).all()
    assert (dataset["sweep_asymmetry"].sel(sweep_offset=dataset["sweep_offset"] > 0) > 4e-3).all()


def test_the_papers_orbit_loses_its_stability_at_a_c(dataset):
    assert (dataset["critical_stability"] == CriticalStability.LOST).all()
    assert dataset["attracts_within_synchrony"].values.tolist() == [[-1, 1, 1]] * 2


def test_a_c_of_an_orbit_that_repels_symmetric_perturbations_is_no_end_of_synchrony():
    """At coupling 1.5 it is 0.26574379590, where the largest modulus of the symmetric multipliers is 2.1."""
    unstable = summarize(models(("linearized",), chain=Chain(3, coupling=1.5)), [0.02, 0.1])
    assert unstable["critical_a"].item() == pytest.approx(0.26574379590, abs=1e-11)
    assert unstable["critical_stability"].item() == CriticalStability.UNSTABLE
    attracts, symmetric = (
        unstable["attracts_within_synchrony"].values[0],
        unstable["multiplier"].sel(mode="symmetric_1"),
    )
    assert attracts.tolist() == (np.hypot(*symmetric.transpose("part", ...).values)[0] < 1.0).astype(int).tolist()
    assert attracts[1] == 0
    # A run would leave the orbit.
    assert np.isnan(unstable["sweep_asymmetry"]).all()
    assert np.isnan(unstable["hysteresis"]).all()
    assert "no end of synchrony" in orbits.digest(unstable)


@pytest.mark.parametrize(("slope", "expected"), [(3.0, CriticalStability.LOST), (-3.0, CriticalStability.GAINED)])
def test_stability_may_be_lost_or_gained_as_a_grows(slope, expected):
    form = antisymmetric(lambda d, mu: (1.0 + slope * mu) * d, lambda d, mu: 1.0 + slope * mu)
    family = KnownOrbits(orbit_at(form, -0.01, 0.0, Symmetry.SYNCHRONIZED, Chain(2)))
    assert orbits.critical_stability(family, CRITICAL) == expected


def test_the_transition_is_recomputed(dataset):
    """Each number is recomputed, the fit with another routine."""
    family, part = synchronized_orbits(models()[1]), dataset.sel(law="nonlinear")
    edges = bifurcations_of(family)
    critical = critical_a(edges)
    assert part["critical_a"].item() == pytest.approx(critical, abs=1e-14)
    assert part["critical_a_error"].item() == pytest.approx(critical_a_error(family, critical), abs=1e-11)
    assert part["grazing_a"].item() == pytest.approx(grazing_a(edges, block=1), abs=1e-12)
    assert part["symmetric_period_doubling_a"].item() == pytest.approx(symmetric_period_doubling_a(edges), abs=1e-12)
    d = part["branch_asymmetry"].values
    # Five values per decade, starting at a thousandth of v.
    assert d == pytest.approx(0.1 * 10 ** (np.arange(13) / 5 - 3), rel=1e-3)
    assert d[::5] == pytest.approx([1e-4, 1e-3, 1e-2], rel=1e-12)
    orbit = branching_orbit(family.at(critical), d[7])
    for name, value in {
        "offset": orbit.model.parameter("a") - critical,
        "period": orbit.period,
        "residual": orbit.residual,
        "multiplier": abs(multipliers(orbit).whole[0]),
        "mean_distance": orbit.mean_distance,
    }.items():
        assert part[f"branch_{name}"].values[7] == pytest.approx(value, rel=1e-7, abs=1e-14), name
    small = slice(0, 6)
    offset, error = part["branch_offset"].values[small], part["critical_a_error"].item()

    def fit(ends, shift=0.0):
        def law(x, c, exponent, k):
            return c + exponent * np.log(x / 1e-5) + k * x / 1e-5

        return curve_fit(law, offset[ends] + shift, np.log(d[small][ends]))

    values, covariance = fit(slice(None))
    shorter = [fit(ends)[0][1] - values[1] for ends in (slice(0, 4), slice(2, 6))]
    expected = np.sqrt(covariance[1, 1] + np.abs(shorter).max() ** 2 + (fit(slice(None), error)[0][1] - values[1]) ** 2)
    assert part["amplitude_exponent"].item() == pytest.approx(values[1], abs=1e-8)
    assert part["amplitude_exponent_error"].item() == pytest.approx(expected, rel=0.05)
    coefficient = np.exp(values[0] - values[1] * np.log(1e-5))
    assert part["amplitude_coefficient"].item() == pytest.approx(coefficient, rel=1e-7)
    assert 0.0 < part["amplitude_coefficient_error"].item() < 1e-5
    offsets = [-2e-3, -1e-3, 1e-3, 2e-3, 4e-3, 8e-3, 1.6e-2]
    assert part["sweep_offset"].values.tolist() == offsets
    up, down = (part["sweep_asymmetry"].sel(direction=name).values for name in ("upward", "downward"))
    assert up == pytest.approx(sweep(family, critical + np.array(offsets)), abs=1e-9)
    assert down == pytest.approx(sweep(family, critical + np.array(offsets[::-1]))[::-1], abs=1e-9)
    assert part["hysteresis"].item() == np.abs(up - down).max()


def test_laws_with_the_same_slope_are_compared(dataset):
    """The stored differences agree with those of independently computed orbits."""
    nonlinear = models()[1]
    scaled = effective_a(nonlinear, 0.1)
    assert scaled == pytest.approx(0.1 / 1.01**2, rel=1e-15)
    pair = [synchronized_orbits(model).at(a) for model, a in zip(models(), (scaled, 0.1), strict=True)]
    point = dataset.sel(a=0.1)
    assert point["effective_a"].item() == scaled
    expected = (multipliers(pair[1]).transverse - multipliers(pair[0]).transverse).real
    assert point["effective_multiplier_difference"].item() == pytest.approx(expected, abs=1e-12)
    assert point["effective_period_difference"].item() == pytest.approx(pair[1].period - pair[0].period, abs=1e-12)
    critical = dataset["critical_a"].values
    assert dataset["effective_critical_a_difference"].item() == effective_a(nonlinear, critical[1]) - critical[0]


@pytest.mark.parametrize(("blocks", "v", "status"), [(2, 0.1, 3), (5, 0.1, 3), (3, 1000.0, 2)])
def test_a_missing_orbit_is_a_flag(blocks, v, status):
    # With symmetric contact so fast a driver makes blocks slip backward: no block stops just once per period.
    none = summarize(models(chain=Chain(blocks), v=v, contact="symmetric"), [0.1, 0.2])
    assert (none["status"] == status).all()
    for name in ("period", "critical_a", "grazing_a", "multiplier", "branch_offset", "hysteresis"):
        assert np.isnan(none[name]).all()
    assert (none["bifurcation_kind"] == -1).all()
    assert (none["bifurcation_side"] == -1).all()


@pytest.mark.slow
def test_other_laws_are_included(dataset, monkeypatch):
    """The laws have the order of the study, and the comparison of the paper's laws is missing."""
    # Branching orbits are computed for the paper's laws only.
    monkeypatch.setattr(orbits, "ASYMMETRIES", orbits.ASYMMETRIES[:6])
    monkeypatch.setattr(orbits, "OFFSETS", orbits.OFFSETS[:1])
    other = summarize(models(("exponential", "nonlinear", "carlson_langer")), [0.0, 0.1])
    assert other["law"].values.tolist() == ["exponential", "nonlinear", "carlson_langer"]
    # Friction that drops at the start of a slip drives the motion at a = 0 as well.
    assert other["status"].values.tolist() == [[1, 0], [1, 0], [2, 0]]
    assert not set(COMPARISON) & set(other)
    assert set(COMPARISON) < set(dataset)
    for name in ("period", "transverse_multiplier", "center_stick_time"):
        same = dataset[name].sel(law="nonlinear", a=0.1), other[name].sel(law="nonlinear", a=0.1)
        assert same[0].item() == pytest.approx(same[1].item(), abs=1e-12)
    critical = other["critical_a"].sel(law="exponential").item()
    # If friction drops, a stick of block 2 does not begin with duration 0: the orbit ends or jumps.
    assert np.isnan(other["grazing_a"].sel(law="carlson_langer"))
    # Φ = exp(−aU') weakens less than 1 − aU' and more than 1/(1 + aU').
    assert dataset["critical_a"].values[0] < critical < dataset["critical_a"].values[1]


def test_an_asymmetric_chain_has_no_synchronized_orbit():
    none = summarize(models(("linearized",), chain=Chain(3, threshold=(1.0, 1.0, 0.9))), [0.1])
    assert none["status"].values.tolist() == [[2]]
    assert np.isnan(none["critical_a"]).all()


@pytest.mark.parametrize(
    ("formula", "status"), [("1 + 0*u", 1), ("1 + 0.1*u", 2), ("0.9 + 0*u", 0), ("1 - a*u", 1), ("1 - (1 - a)*u", 2)]
)
def test_constant_friction_is_neutral(formula, status):
    law = FormulaLaw(formula, name="mine")
    model = Model(law.at(**dict.fromkeys(law.missing, 0.1)))
    assert summarize([model], [0.0])["status"].values.tolist() == [[status]]


def test_offsets_of_sweeps_scale_with_the_chain(monkeypatch):
    """With thresholds ten times as high, a_c and all other values of a are a tenth."""
    swept = []
    monkeypatch.setattr(orbits, "sweep", lambda orbits, values: swept.append(values) or np.zeros(len(values)))
    model = Model("linearized", a=0.0, threshold=10.0)
    critical = summarize([model], [0.005])["critical_a"].item()
    assert critical == pytest.approx(0.00869729047, abs=1e-9)
    assert swept[0] - critical == pytest.approx(0.1 * np.array(orbits.OFFSETS), abs=1e-12)


@pytest.mark.parametrize("c", [1.0, -1.0])
@pytest.mark.parametrize("rises", [1.0, -1.0])
def test_orbits_that_branch_off_where_synchrony_is_unstable_are_supercritical(c, rises):
    """Of d → (1 ± μ)d − cd³: the multiplier may increase or decrease through 1 as a increases, and ±μ = cd²."""
    form = antisymmetric(
        lambda d, mu: (1.0 + rises * mu) * d - c * d**3, lambda d, mu: 1.0 + rises * mu - 3.0 * c * d**2
    )
    family = KnownOrbits(orbit_at(form, -0.01, 0.0, Symmetry.SYNCHRONIZED, Chain(2)))
    asymmetry = 0.1 * np.array(orbits.ASYMMETRIES)
    names = [name for name in orbits.VARIABLES if name.startswith("branch_")]
    values = {name: np.full((1, len(asymmetry)), np.nan) for name in names}
    values |= {"bifurcation_side": np.array([-1]), "critical_a_error": np.array([1e-13])}
    values |= {name: np.array([np.nan]) for name in orbits.VARIABLES if name.startswith("amplitude_")}
    orbits._fill_branch(values, 0, family, CRITICAL, asymmetry)
    assert values["bifurcation_side"][0] == (BifurcationSide.SUPERCRITICAL if c > 0.0 else BifurcationSide.SUBCRITICAL)
    square = (0.5 * asymmetry) ** 2
    assert values["branch_offset"][0] == pytest.approx(c * rises * square, abs=1e-12)
    assert values["branch_multiplier"][0] == pytest.approx(1.0 - 2.0 * c * square, abs=1e-7)
    assert values["amplitude_exponent"][0] == pytest.approx(0.5)
    assert values["amplitude_coefficient"][0] == pytest.approx(2.0)


def test_the_orbit_of_a_law_without_a_and_one_without_stops():
    """Runs have their periods; without stops a perturbation of x_1 − x_3 has two multipliers, and none is listed."""
    belt = law_of({"belt": {"formula": "mud + (mus - mud)*exp(-u/v0)"}}, mus=1.0, mud=0.5, v0=0.5)
    cubic = law_of({"cubic": {"formula": "1 - a*u + b*u**3"}}, a=0.3, b=0.3)
    state = {"position": [-0.9, -1.0, -0.9], "velocity": [0.7, 0.72, 0.7]}
    for law, grid, v, listed in ((belt, [0.0], 1.0, [True]), (cubic, [0.5, 0.6], 0.7, [False, True])):
        model = Model(law, v=v)
        part = summarize([model], grid)
        periods = [simulate(model.at(a=a) if "a" in law.names else model, state).period for a in grid]
        np.testing.assert_allclose(part["period"].values[0], periods, rtol=1e-8)
        assert np.isfinite(part["transverse_multiplier"].values[0]).tolist() == listed
