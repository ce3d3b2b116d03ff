"""Slopes of drawn catalogues, whose slope is known, and the test of the fit on true and on false distributions."""

import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import kstest, norm

from burridge_knopoff.catalogue import slope
from burridge_knopoff.catalogue.slope import fit_slope, format_p_value
from tests.conftest import quick_first
from tests.refused import refused


def draw_magnitudes(b, low, high, count, seed):
    """Draw magnitudes from exp(−bm) between two magnitudes, by the inverse of their distribution."""
    share = np.random.default_rng(seed).random(count)
    if b == 0.0:
        return low + (high - low) * share
    if high == np.inf:
        return low - np.log1p(-share) / b
    return low - np.log1p(share * np.expm1(-b * (high - low))) / b


@pytest.mark.parametrize(
    ("b", "low", "high"), quick_first([(1.0, 0.0, 2.0), (0.5, -3.0, 4.0), (-0.4, 0.0, 3.0), (0.0, 1.0, 2.0)], 1)
)
def test_slope_and_its_error(b, low, high, monkeypatch):
    monkeypatch.setattr(slope, "BOOTSTRAP_SIZE", 1)
    fits = [fit_slope(draw_magnitudes(b, low, high, 200, seed), low, high) for seed in range(300)]
    slopes = np.array([item.b for item in fits])
    errors = np.array([item.scatter for item in fits])
    assert abs(slopes.mean() - b) < 4.0 * slopes.std() / np.sqrt(300)
    assert slopes.std() == pytest.approx(errors.mean(), rel=0.15)
    for width, share in ((1.0, 0.683), (2.0, 0.954)):
        covered = np.mean(np.abs(slopes - b) < width * errors)
        assert abs(covered - share) < 4.0 * np.sqrt(share * (1.0 - share) / 300)


@pytest.mark.parametrize(
    ("b", "low", "high", "count"),
    quick_first([(1.0, 2.0, np.inf, 50), (0.0, 1.0, 2.0, 20), (-5.0, 0.0, 3.0, 40), (0.5, -4.0, 1.0, 2500)], 1),
)
def test_p_is_uniform_where_the_distribution_is_the_fitted_one(b, low, high, count):
    """The slope is fitted to the events that are tested (H. W. Lilliefors, J. Am. Stat. Assoc. 62 (1967) 399)."""
    # The numbers of events differ, so that each catalogue has its own bootstrap.
    p = np.array([fit_slope(draw_magnitudes(b, low, high, count + k, k), low, high).p_value for k in range(200)])
    assert 0.015 < (p < 0.05).mean() < 0.1
    assert abs((p < 0.5).mean() - 0.5) < 0.13
    assert kstest(p, "uniform").pvalue > 0.001
    assert p.min() > 0.0


def draw_bursts(b, high, seed):
    """Draw times and magnitudes of 100 bursts of 5 events on average, whose magnitudes are alike within a burst.

    Each magnitude alone is distributed as exp(−bm) from 0 to `high`: the bursts are those of a Gaussian copula.
    """
    generator = np.random.default_rng(seed)
    size = generator.geometric(0.2, generator.poisson(100))
    begin, common = np.repeat([generator.random(len(size)), generator.standard_normal(len(size))], size, axis=1)
    share = norm.cdf(np.sqrt(0.8) * common + np.sqrt(0.2) * generator.standard_normal(len(begin)))
    return begin + 1e-3 * generator.random(len(begin)), -np.log1p(share * np.expm1(-b * high)) / b


def test_the_scatter_and_p_of_events_in_bursts(monkeypatch):
    """As independent events they have an error that is too small by a factor of two, and p below 0.05 half the time."""
    monkeypatch.setattr(slope, "BOOTSTRAP_SIZE", 99)
    drawn = [draw_bursts(0.7, 4.0, seed) for seed in range(200)]
    fits = [fit_slope(magnitude, 0.0, 4.0, time=time) for time, magnitude in drawn]
    independent = [fit_slope(magnitude, 0.0, 4.0) for _, magnitude in drawn]
    slopes, scatter = (np.array([getattr(fit, name) for fit in fits]) for name in ("b", "scatter"))
    assert slopes.mean() == pytest.approx(0.7, abs=4.0 * slopes.std() / np.sqrt(200))
    assert np.sqrt((scatter**2).mean()) == pytest.approx(slopes.std(ddof=1), rel=0.2)
    assert 0.58 < (abs(slopes - 0.7) < scatter).mean() < 0.8
    assert np.mean([fit.scatter for fit in independent]) < 0.65 * slopes.std()
    assert 0.01 < np.mean([fit.p_value < 0.05 for fit in fits]) < 0.1
    assert np.mean([fit.p_value < 0.05 for fit in independent]) > 0.3


@pytest.mark.slow
@pytest.mark.parametrize("high", [4.0, np.inf])
def test_independent_events_have_the_scatter_of_the_fisher_information(high, monkeypatch):
    monkeypatch.setattr(slope, "BOOTSTRAP_SIZE", 1)
    ratios = []
    for seed in range(200):
        magnitude = draw_magnitudes(0.7, 0.0, high, 400, seed)
        time = np.random.default_rng(1000 + seed).random(400)
        with_times, without = (fit_slope(magnitude, 0.0, high, time=given) for given in (time, None))
        assert with_times.b == without.b
        ratios.append(with_times.scatter / without.scatter)
    # What is left of the correlation of batches raises the error by 5 % on average.
    assert 0.98 < np.sqrt(np.mean(np.square(ratios))) < 1.1


def test_the_error_covers_a_slope_that_changes_within_the_range(monkeypatch):
    """The rate is exp(−m²/4), and its local slope m/2 rises from 0 to 2."""
    monkeypatch.setattr(slope, "BOOTSTRAP_SIZE", 1)
    share = np.random.default_rng(1).random(20_000)
    magnitude = np.sqrt(2.0) * norm.ppf(0.5 + share * (norm.cdf(4.0 / np.sqrt(2.0)) - 0.5))
    fit = fit_slope(magnitude, 0.0, 4.0)
    halves = [fit_slope(magnitude, low, low + 2.0) for low in (0.0, 2.0)]
    assert [half.b for half in halves] == pytest.approx([0.5, 1.4], abs=0.1)
    assert all(abs(half.b - fit.b) <= 1.05 * fit.error for half in halves)
    assert fit.scatter < 0.02
    assert fit.error == pytest.approx(np.hypot(fit.scatter, fit.spread))
    # A straight line has a spread by chance in one case of twenty.
    lines = [fit_slope(draw_magnitudes(0.7, 0.0, 4.0, 500, seed), 0.0, 4.0) for seed in range(200)]
    assert 0.0 < np.mean([line.spread > 0.0 for line in lines]) < 0.1


def test_times_that_do_not_fit_the_magnitudes_are_refused():
    magnitude = draw_magnitudes(1.0, 0.0, np.inf, 100, 1)
    for time in (np.arange(99.0), np.append(np.arange(99.0), np.inf)):
        with refused("time", "(100,)"):
            fit_slope(magnitude, 0.0, time=time)


def test_events_in_few_parts_of_a_catalogue_have_no_scatter():
    """All large events lie in a single burst: nothing tells whether the next burst is like it."""
    magnitude = np.concatenate([draw_magnitudes(1.0, 5.0, np.inf, 100, 1), np.zeros(2)])
    fit = fit_slope(magnitude, 5.0, time=np.append(np.linspace(0.0, 1.0, 100), [-500.0, 500.0]))
    assert np.isfinite(fit.b)
    assert np.isnan([fit.scatter, fit.error]).all()


def test_p_rejects_a_rate_that_bends():
    """The rate is lower by half at the lower end, where a catalogue is incomplete."""
    refused_count = 0
    for seed in range(30):
        magnitude = draw_magnitudes(0.7, 0.0, 4.0, 2000, seed)
        mask = np.random.default_rng(1000 + seed).random(2000) < 1.0 - np.exp(-2.0 * magnitude) / 2.0
        refused_count += fit_slope(magnitude[mask], 0.0, 4.0).p_value < 0.05
    assert refused_count > 24


@pytest.mark.parametrize("width", [0.1, 0.5])
def test_rounded_magnitudes_require_a_range_of_whole_bins(width):
    """The range ends half a bin outside the outer centres; b is too high between them and too low a bin further out."""
    magnitude = draw_magnitudes(0.81, -5.0, 5.0, 100_000, 1)
    rounded = width * np.round(magnitude / width)
    assert fit_slope(rounded, -2.0 - width / 2, 2.0 + width / 2).b == pytest.approx(0.81, abs=0.025)
    assert fit_slope(rounded, -2.0, 2.0).b > 0.81 * (1.0 + 0.4 * width)
    assert fit_slope(rounded, -2.0 + 1e-9 - width, 2.0).b < 0.81 * (1.0 - 0.4 * width)


@pytest.mark.slow
@pytest.mark.parametrize("width", [0.1, 0.5])
@pytest.mark.parametrize("last", [2.0, 10.0])
def test_the_bias_by_rounding_is_that_of_the_page(width, last):
    """docs/catalogues.md: w²/(12 s²) half a bin outside the centres, 2w/range and bw/2 on them."""
    b, low, high = 0.8, -width / 2, last + width / 2
    magnitude = draw_magnitudes(b, low, high, 2_000_000, 1)
    rounded = width * np.round(magnitude / width)
    true = fit_slope(magnitude, low, high).b
    fraction = 1.0 - fit_slope(rounded, low, high).b / true
    assert fraction == pytest.approx(width**2 / (12.0 * magnitude.var()), rel=0.1, abs=0.001)
    on_centres = fit_slope(rounded, -1e-9, last + 1e-9).b / true - 1.0
    assert max(2.0 * width / last, b * width / 2.0) < on_centres < 2.0 * width / last + 1.2 * b * width / 2.0


@pytest.mark.parametrize("b", [1000.0, -1000.0, 1e6])
@pytest.mark.parametrize("high", [3.0, 300.0])
def test_steep_slopes_have_a_fit(b, high):
    """The product of slope and width is far beyond the range of the exponential function."""
    steep = np.random.default_rng(1).exponential(1.0 / abs(b), 400)
    magnitude = steep if b > 0.0 else high - steep
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        fit = fit_slope(magnitude, 0.0, high)
    assert abs(fit.b - b) < 3.0 * fit.error
    assert fit.error == pytest.approx(abs(b) / 20.0, rel=0.2)
    assert fit.p_value > 0.05
    assert abs(fit.b) == pytest.approx(fit_slope(steep, 0.0).b, rel=1e-6)


def test_infinite_magnitudes():
    """An event whose slips cancel has the magnitude −∞, below every range."""
    magnitude = draw_magnitudes(1.0, 0.0, np.inf, 100, 1)
    assert fit_slope(np.append(magnitude, -np.inf), 0.0) == fit_slope(magnitude, 0.0)
    with refused("magnitude", "to inf"):
        fit_slope(np.append(magnitude, np.inf), 0.0)
    for low in (-np.inf, np.nan, np.inf):
        with refused(f"low: {low}"):
            fit_slope(magnitude, low)


@pytest.mark.parametrize("number", [np.nan, -np.nan])
def test_nan_magnitudes_are_refused(number):
    """NaN belongs to no range, so the other magnitudes would be taken for the whole catalogue."""
    with refused("magnitude"):
        fit_slope(np.append(draw_magnitudes(1.0, 0.0, np.inf, 100, 1), number), 0.0)


@pytest.mark.parametrize("far", [1e4, 1e62, 1e100, 1e155, 1e200, 1e308])
def test_an_end_far_beyond_all_events_does_not_change_the_fit(far):
    magnitude = draw_magnitudes(0.9, 0.0, np.inf, 200, 4)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        whole, fit, rising = (
            fit_slope(magnitude, 0.0),
            fit_slope(magnitude, 0.0, far),
            fit_slope(-magnitude, -far, 0.0),
        )
    assert (fit.b, fit.error, fit.p_value) == (whole.b, whole.error, whole.p_value)
    assert (rising.b, rising.error, rising.p_value) == (-whole.b, whole.error, whole.p_value)
    assert (fit.high, rising.low) == (far, -far)


@settings(max_examples=60)
@given(
    st.floats(-300.0, 300.0),
    st.sampled_from([np.inf, 1.0, 3.0, 900.0, 1100.0]),
    st.booleans(),
    st.sampled_from([0.0, 1e5, 1e300]),
)
def test_slopes_scale_with_the_magnitudes(exponent, width, rises, beyond):
    """This holds in any unit, for an end at the largest event, far beyond it, or without an end."""
    size, magnitude = 10.0**exponent, draw_magnitudes(1.0, 0.0, 3.0, 50, 2)
    high = width * float(magnitude.max())
    expected, inside = fit_slope(magnitude, 0.0, high), size * magnitude
    # Rounding does not push the largest event out.
    end = max(size * high, float(inside.max()), beyond if width > 1.0 and beyond > 1e4 * size else 0.0)
    if end > size * high * 1.01:
        expected = fit_slope(magnitude, 0.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        if rises and np.isfinite(end):
            fit, sign = fit_slope(-inside, -end, 0.0), -1.0
        else:
            fit, sign = fit_slope(inside, 0.0, end), 1.0
    assert fit.b * size == pytest.approx(sign * expected.b, rel=1e-9)
    assert fit.error * size == pytest.approx(expected.error, rel=1e-9)
    assert fit.p_value == pytest.approx(expected.p_value, abs=0.002)


@pytest.mark.parametrize(
    ("size", "low", "high"),
    [
        (1.0, -1e308, 1e308),
        (1.0, -1e308, np.inf),
        (1e306, 0.0, np.inf),
        (1e307, -1.7e308, 1.7e308),
        (1e307, -1.7e308, np.inf),
        (1e-307, 0.0, 1e308),
    ],
)
def test_magnitudes_and_ends_at_the_limit_of_numbers(size, low, high):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        fit = fit_slope(size * draw_magnitudes(1.0, 0.0, np.inf, 200, 4), low, high)
    assert np.isfinite([fit.b, fit.error, fit.p_value]).all()
    assert fit.error > 0.0


def test_magnitudes_that_hardly_differ_have_no_slope():
    with refused("magnitude", "between 0 and inf"):
        fit_slope(1e-310 * draw_magnitudes(1.0, 0.0, np.inf, 200, 4), 0.0)


def test_small_p_is_written_as_a_bound():
    assert format_p_value(1e-3) == format_p_value(0.00499) == "p < 0.005"
    assert (format_p_value(0.005), format_p_value(0.012), format_p_value(1.0)) == ("p = 0.01", "p = 0.01", "p = 1.00")


def test_events_outside_the_range_do_not_count():
    magnitude = draw_magnitudes(1.0, 0.0, 3.0, 1000, 1)
    with_others = np.concatenate([magnitude, [-5.0, 9.0]])
    assert fit_slope(with_others, 0.0, 3.0) == fit_slope(magnitude, 0.0, 3.0)


def test_another_distribution_is_rejected():
    """A bump of large events is not a straight line."""
    magnitude = np.concatenate(
        [draw_magnitudes(1.0, 0.0, 5.0, 2000, 1), np.random.default_rng(2).normal(4.0, 0.2, 300)]
    )
    assert fit_slope(magnitude, 0.0, 5.0).p_value < 0.005


def test_too_few_or_equal_magnitudes_are_refused():
    with refused("magnitude: 3"):
        fit_slope(np.array([0.5, 1.0, 1.5]), 0.0, 2.0)
    with refused("magnitude: 1 to 1"):
        fit_slope(np.ones(20), 0.0, 2.0)


def test_magnitudes_in_two_dimensions_are_refused():
    with refused("magnitude", "(events,)"):
        fit_slope(np.arange(20.0).reshape(2, 10), 0.0)
