"""Uncertainty exponents of boundaries that are known, and their errors."""

import numpy as np
import pytest

from burridge_knopoff.basins.pair_separation import BATCHES, SEPARATIONS, PairCounts, follow_pairs
from burridge_knopoff.basins.uncertainty import FITTED_FROM, ExponentKind, uncertainty_exponent
from tests.basins.boundaries import cantor, disc, half_plane, striped

UNIT = (0.0, 1.0)
X = np.log(SEPARATIONS)
CANTOR = [(cantor(parts), 1.0 - np.log(2) / np.log(parts)) for parts in (3, 4, 10)]


def exponent_of(label, count, seed=4):
    return uncertainty_exponent(follow_pairs(label, UNIT, UNIT, count, seed))


def pair_counts(fraction, noise=0.01, counts=None):
    """Return pairs with these fractions, up to a scatter of the batches."""
    scatter = np.exp(noise * np.random.default_rng(1).standard_normal((BATCHES, len(fraction))))
    number = np.full(len(fraction), 500) if counts is None else np.array(counts)
    return PairCounts(fraction * scatter, np.ones_like(scatter), number, number)


@pytest.mark.parametrize(("label", "alpha"), [(half_plane, 1.0), (disc, 1.0), *CANTOR])
def test_known_exponents(label, alpha):
    exponent = exponent_of(label, 4000)
    value, error = exponent.alpha
    assert exponent.kind == ExponentKind.SINGLE
    assert error < 0.04
    assert value == pytest.approx(alpha, abs=3.0 * error + 0.01)
    slope, slope_error = (part[FITTED_FROM:] for part in exponent.local)
    assert np.abs(slope - alpha).max() < 0.25
    assert np.mean(np.abs(slope - alpha) < 3.0 * slope_error + 0.1) > 0.8


@pytest.mark.slow
@pytest.mark.parametrize(("label", "alpha"), CANTOR[:2])
def test_the_error_is_the_scatter_over_seeds(label, alpha):
    alphas = np.array([exponent_of(label, 1200, seed).alpha for seed in range(40)])
    miss = np.abs(alphas[:, 0] - alpha) / alphas[:, 1]
    assert 0.45 < (miss < 1.0).mean() < 0.9
    assert (miss < 2.5).mean() > 0.85
    assert alphas[:, 0].mean() == pytest.approx(alpha, abs=4.0 * alphas[:, 0].std() / np.sqrt(len(alphas)))
    # The error of a few seeds includes a change of the slope, which is larger than two standard errors by chance.
    assert np.median(alphas[:, 1]) == pytest.approx(alphas[:, 0].std(ddof=1), rel=0.45)


def test_a_boundary_without_a_single_exponent():
    exponent = exponent_of(striped, 2000)
    assert exponent.kind == ExponentKind.VARYING
    assert np.isnan(exponent.alpha).all()
    assert exponent.change[0] > 0.5
    assert exponent.local[0][:4] == pytest.approx(0.0, abs=0.15)
    assert exponent.local[0][-3:] == pytest.approx(1.0, abs=0.15)


def test_there_is_no_exponent_if_too_few_pairs_differ():
    for label in (lambda x: np.zeros(len(x), dtype=int), lambda x: np.full(len(x), -1)):
        exponent = exponent_of(label, 400)
        assert exponent.kind == ExponentKind.UNKNOWN
        assert np.isnan([*exponent.alpha, *exponent.change, *exponent.local[0]]).all()
    assert exponent_of(half_plane, 0).kind == ExponentKind.UNKNOWN
    assert np.isnan(exponent_of(half_plane, 0).fraction).all()


def test_exponent_of_counts():
    """f = 3 ε^0.4; four separations with eight pairs are enough, and separations after a gap do not count."""
    fraction = 3.0 * np.array(SEPARATIONS) ** 0.4
    assert uncertainty_exponent(pair_counts(fraction, 0.0)).alpha == pytest.approx((0.4, 0.0), abs=1e-9)
    exponent = uncertainty_exponent(pair_counts(fraction))
    assert exponent.kind == ExponentKind.SINGLE
    assert exponent.alpha[0] == pytest.approx(0.4, abs=3.0 * exponent.alpha[1])
    assert exponent.fraction[1] == pytest.approx(fraction * 0.01 / np.sqrt(BATCHES), rel=0.5)
    few = [500] * FITTED_FROM + [8, 8, 8, 8, 7] + [500] * (len(SEPARATIONS) - FITTED_FROM - 5)
    bent = np.where(np.arange(len(SEPARATIONS)) > FITTED_FROM + 3, 1e-3 * fraction, fraction)
    assert uncertainty_exponent(pair_counts(bent, 0.0, few)).alpha[0] == pytest.approx(0.4, abs=1e-9)
    pairs = pair_counts(fraction)
    pairs.different_weight[2:, -1] = 0.0
    two = uncertainty_exponent(pairs)
    pairs.different_weight[1:, -1] = 0.0
    alone = uncertainty_exponent(pairs)
    # Those of two batches count, which makes f fall more steeply towards the smallest separation.
    assert two.alpha[0] > 0.5
    pairs.different_count[-1] = 7
    assert alone.alpha == uncertainty_exponent(pairs).alpha
    assert np.isfinite(alone.alpha).all()
    few[FITTED_FROM + 3] = 7
    assert uncertainty_exponent(pair_counts(bent, 0.0, few)).kind == ExponentKind.UNKNOWN


@pytest.mark.parametrize(("bend", "enters"), [(0.25, True), (0.0, False)])
def test_the_error_includes_a_change_of_the_exponent(bend, enters):
    """f = ε^0.5·exp(…) with a local exponent that tends to 0.5 − bend/2 and 0.5 + bend/2 at the ends."""
    z = (X - X[FITTED_FROM]) / (X[-1] - X[FITTED_FROM])
    fraction = np.exp((X[-1] - X[FITTED_FROM]) * ((0.5 - 0.5 * bend) * z + 0.5 * bend * z**2) - 1.0)
    exponent = uncertainty_exponent(pair_counts(fraction, 0.05))
    value, error = exponent.alpha
    assert exponent.kind == ExponentKind.SINGLE
    assert value == pytest.approx(0.5, abs=0.03)
    assert (error > 0.08) == enters
    if enters:
        assert abs(value - (0.5 + 0.5 * bend)) < 1.2 * error


@pytest.mark.parametrize(
    ("bend", "noise", "counts"),
    [(0.31, 0.0, True), (-0.31, 0.0, True), (0.29, 0.0, False), (0.4, 0.7, True), (0.4, 0.8, False), (0.4, 1.0, False)],
)
def test_a_change_counts_if_it_is_large_and_beyond_its_error(bend, noise, counts):
    """The slope is 0.5 at first, 0.5 + bend at last: a change of 3.4 errors at a noise of 0.7, of 2.9 at 0.8."""
    z = (X - X[FITTED_FROM]) / (X[-1] - X[FITTED_FROM])
    fraction = np.exp((X[-1] - X[FITTED_FROM]) * (0.5 * z + 0.5 * bend * z**2) - 1.0)
    exponent = uncertainty_exponent(pair_counts(fraction, noise))
    assert exponent.kind == (ExponentKind.VARYING if counts else ExponentKind.SINGLE)
    assert exponent.change[0] == pytest.approx(bend, abs=0.01 + 4.0 * exponent.change[1])
