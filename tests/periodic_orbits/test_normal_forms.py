"""Branches and bifurcations of normal forms against their closed forms, on both sides of each bifurcation."""

import numpy as np
import pytest

from burridge_knopoff import BifurcationKind, Chain, Symmetry, locate_bifurcations
from burridge_knopoff.periodic_orbits.following import follow
from tests import normal_forms
from tests.normal_forms import CRITICAL, STEPS, antisymmetric, border_collision, followed, neimark_sacker, orbit_at

#: Values of μ from which branches are followed to the other side of the bifurcation.
SIDES = pytest.mark.parametrize("mu", [-0.01, 0.01])
SUPER_AND_SUBCRITICAL = pytest.mark.parametrize("c", [1.0, -1.0])
PAIR = Chain(2)


def check(bifurcation, kind, *, before, after, turns=False):
    """Require a bifurcation at μ = 0 with numbers of unstable multipliers on both sides; None if the branch ends."""
    assert bifurcation.kind == kind
    assert bifurcation.value == pytest.approx(CRITICAL, abs=1e-12)
    assert bifurcation.error < 1e-10
    assert bifurcation.is_turning_point == turns
    counts = [point and point.multipliers.unstable_count for point in (bifurcation.before, bifurcation.after)]
    assert counts == [before, after]
    assert bifurcation.loses_stability == (before == 0 and after != 0)
    assert bifurcation.keeps_stability == (before == after == 0)


def leading(branch):
    """Return the parameter μ, the position of block 1 and the leading multiplier of each orbit."""
    rows = [(point.value - CRITICAL, point.orbit.reference.position[0], point.multipliers.whole[0]) for point in branch]
    mu, x, multiplier = np.array(rows).T
    return mu.real, x.real, multiplier


@pytest.mark.parametrize("x", [0.1, -0.1])
def test_fold(x):
    """The orbits exist on one side only, and the branch continues from the stable to the unstable ones, or back."""
    branch, (bifurcation,) = followed(orbit_at(normal_forms.fold(), 0.01, x))
    mu, place, multiplier = leading(branch)
    assert place**2 == pytest.approx(mu, abs=1e-11)
    assert multiplier == pytest.approx(1.0 - 2.0 * place, abs=1e-11)
    assert place.min() < -0.09 < 0.09 < place.max()
    check(bifurcation, BifurcationKind.FOLD, before=int(x < 0.0), after=int(x > 0.0), turns=True)
    assert bifurcation.at.multipliers.whole[0] == pytest.approx(1.0, abs=1e-6)


def test_fold_of_synchronized_orbits():
    form = normal_forms.NormalForm(
        lambda x, mu: np.full(2, x.mean() + mu - x.mean() ** 2),
        lambda x, mu: np.full((2, 2), 0.5 - x.mean()),
    )
    _, (bifurcation,) = followed(orbit_at(form, 0.01, [0.1, 0.1], Symmetry.SYNCHRONIZED, PAIR))
    check(bifurcation, BifurcationKind.FOLD, before=0, after=1, turns=True)


@SIDES
@SUPER_AND_SUBCRITICAL
def test_period_doubling(mu, c):
    branch, (bifurcation,) = followed(orbit_at(normal_forms.period_doubling(c), mu, 0.0))
    values, _, multiplier = leading(branch)
    assert multiplier == pytest.approx(-(1.0 + values))
    assert np.ptp(values) > 0.018
    check(bifurcation, BifurcationKind.PERIOD_DOUBLING, before=int(mu > 0.0), after=int(mu < 0.0))
    assert bifurcation.period == pytest.approx(1.0)


@SUPER_AND_SUBCRITICAL
def test_doubled_orbits_begin_at_the_period_doubling(c):
    """They exist for μ > 0 and are stable, or for μ < 0 and are unstable."""
    branch, (bifurcation,) = followed(orbit_at(normal_forms.period_doubling(c), 0.01 * c, 0.1, time=2))
    mu, x, multiplier = leading(branch[:-1])
    assert x**2 == pytest.approx(mu / c, abs=1e-10)
    assert multiplier == pytest.approx((1.0 - 2.0 * mu) ** 2)
    assert {point.orbit.period for point in branch} == {2.0}
    assert branch[-1].reduced_orbit.period == pytest.approx(1.0)
    check(bifurcation, BifurcationKind.PERIOD_DOUBLING, before=int(c < 0.0), after=None)
    assert (bifurcation.period, bifurcation.at.orbit.period) == (pytest.approx(2.0), pytest.approx(1.0))


@SIDES
@SUPER_AND_SUBCRITICAL
def test_pitchfork(mu, c):
    branch, (bifurcation,) = followed(orbit_at(normal_forms.pitchfork(c), mu, 0.0, Symmetry.SYNCHRONIZED, PAIR))
    values, _, multiplier = leading(branch)
    assert multiplier == pytest.approx(1.0 + values)
    assert np.ptp(values) > 0.018
    check(bifurcation, BifurcationKind.PITCHFORK, before=int(mu > 0.0), after=int(mu < 0.0))


@SUPER_AND_SUBCRITICAL
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_asymmetric_orbits_begin_at_the_pitchfork(c, side):
    branch, (bifurcation,) = followed(
        orbit_at(normal_forms.pitchfork(c), 0.01 * c, [0.1 * side, -0.1 * side], chain=PAIR)
    )
    mu, d, multiplier = leading(branch[:-1])
    assert d**2 == pytest.approx(mu / c, abs=1e-10)
    assert multiplier == pytest.approx(1.0 - 2.0 * mu)
    assert {point.orbit.symmetry for point in branch} == {Symmetry.ASYMMETRIC}
    assert branch[-1].reduced_orbit.symmetry == Symmetry.SYNCHRONIZED
    check(bifurcation, BifurcationKind.PITCHFORK, before=int(c < 0.0), after=None)


def alternating():
    """d → −g(d), g = αd + βd³, α = 2 + μ/2, β = 1 − α: at d = ±1 alternately, where g' = −(1 + μ)."""

    def coefficients(mu):
        return 2.0 + 0.5 * mu, -1.0 - 0.5 * mu

    def map(d, mu):
        alpha, beta = coefficients(mu)
        return -(alpha * d + beta * d**3)

    def slope(d, mu):
        alpha, beta = coefficients(mu)
        return -(alpha + 3.0 * beta * d**2)

    return antisymmetric(map, slope)


@SIDES
def test_an_orbit_that_is_its_own_mirror_image_loses_the_symmetry_in_a_pitchfork(mu):
    """The multiplier ν of the return after half a period is −1, and that of the period is ν²."""
    branch, (bifurcation,) = followed(orbit_at(alternating(), mu, [1.0, -1.0], Symmetry.SYMMETRIC, PAIR))
    values, _, multiplier = leading(branch)
    assert multiplier == pytest.approx((1.0 + values) ** 2)
    assert {point.orbit.period for point in branch} == {2.0}
    check(bifurcation, BifurcationKind.PITCHFORK, before=int(mu > 0.0), after=int(mu < 0.0))


def test_orbits_that_are_not_their_own_mirror_image_begin_there():
    """They alternate between p and −q with pq = 2/(2 + μ) and p² + q² = 1 + pq."""
    product = 2.0 / 2.01
    p = 0.5 * (np.sqrt(1.0 + 3.0 * product) + np.sqrt(1.0 - product))
    branch, (bifurcation,) = followed(orbit_at(alternating(), 0.01, [p, -p], chain=PAIR, time=2))
    mu, d, multiplier = leading(branch[:-1])
    product = 2.0 / (2.0 + mu)
    assert d**2 + (product / d) ** 2 == pytest.approx(1.0 + product)
    alpha, beta = 2.0 + 0.5 * mu, -1.0 - 0.5 * mu
    expected = alpha**2 + 3.0 * alpha * beta * (1.0 + product) + 9.0 * beta**2 * product**2
    assert multiplier == pytest.approx(expected, abs=1e-6)
    assert branch[-1].reduced_orbit.symmetry == Symmetry.SYMMETRIC
    check(bifurcation, BifurcationKind.PITCHFORK, before=0, after=None)


@SIDES
@pytest.mark.parametrize("angle", [0.4, 1.2, 2.8])
def test_neimark_sacker(mu, angle):
    branch, (bifurcation,) = followed(orbit_at(neimark_sacker(angle), mu, 0.0))
    values, _, multiplier = leading(branch)
    assert np.abs(multiplier) == pytest.approx(1.0 + values)
    assert np.abs(np.angle(multiplier)) == pytest.approx(angle)
    check(bifurcation, BifurcationKind.NEIMARK_SACKER, before=2 * (mu > 0.0), after=2 * (mu < 0.0))


@SIDES
@pytest.mark.parametrize(("left", "right"), [(0.5, -0.4), (-0.5, 0.9), (0.5, -1.5), (-1.2, 0.3), (-1.2, -1.5)], ids=str)
def test_border_collision_through_which_a_branch_continues(mu, left, right):
    """The orbits are at μ/(1 − s), and multipliers jump from one slope s to the other."""
    slopes = (left, right) if mu < 0.0 else (right, left)
    branch, (bifurcation,) = followed(orbit_at(border_collision(left, right), mu, mu / (1.0 - slopes[0])))
    values, x, multiplier = leading(branch)
    slope = np.where(x > 0.0, right, left)
    assert x == pytest.approx(values / (1.0 - slope), abs=1e-10)
    assert multiplier == pytest.approx(slope)
    assert np.ptp(values) > 0.018
    assert [point.orbit.stop_counts for point in branch] == [(int(place > 0.0), 1) for place in x]
    before, after = (int(abs(slope) > 1.0) for slope in slopes)
    check(bifurcation, BifurcationKind.GRAZING, before=before, after=after)


@pytest.mark.parametrize("upward", [True, False])
@pytest.mark.parametrize(("stable", "unstable"), [(0.5, 1.5), (-0.4, 3.0)])
def test_border_collision_in_which_two_orbits_vanish(stable, unstable, upward):
    """A non-smooth fold: the stable and the unstable orbit, on either side of the border, exist at the same μ."""
    slopes = (stable, unstable) if upward else (unstable, stable)
    mu = -0.01 if upward else 0.01
    for first, second in ((0, 1), (1, 0)):
        orbit = orbit_at(border_collision(*slopes), mu, mu / (1.0 - slopes[first]))
        if (orbit.reference.position[0] > 0.0) != first:
            pytest.fail("the orbit is not on its side")
        branch, (bifurcation,) = followed(orbit)
        values, x, multiplier = leading(branch)
        slope = np.where(x > 0.0, slopes[1], slopes[0])
        assert x == pytest.approx(values / (1.0 - slope), abs=1e-10)
        assert multiplier == pytest.approx(slope)
        assert (values * mu > -1e-12).all()
        before, after = (int(slopes[k] > 1.0) for k in (first, second))
        check(bifurcation, BifurcationKind.GRAZING, before=before, after=after, turns=True)


def test_a_branch_ends_where_the_map_jumps():
    branch, (bifurcation,) = followed(orbit_at(border_collision(0.5, -0.4, jump=0.05), -0.01, -0.02))
    check(bifurcation, BifurcationKind.GRAZING, before=0, after=None)
    assert branch[-1].is_grazing


def test_a_branch_ends_where_there_is_no_orbit_beyond_the_border():
    """Of x → x/2 + μ for x < 0 and x → −1 for x > 0."""
    form = normal_forms.on_line(
        lambda x, mu: -1.0 if x > 0.0 else 0.5 * x + mu,
        lambda x, mu: 0.5 * (x <= 0.0),
        borders=lambda x, mu: np.array([x[0], np.inf]),
    )
    _, (bifurcation,) = followed(orbit_at(form, -0.01, -0.02))
    check(bifurcation, BifurcationKind.GRAZING, before=0, after=None)


def test_a_branch_turns_at_the_end_of_the_range_of_the_law():
    """The orbits ±2a of x → sx + a, s = 1/2 for x > 0 and 3/2 for x < 0, meet at a = 0; there is no law below."""
    form = normal_forms.on_line(
        lambda x, mu: (0.5 if x > 0.0 else 1.5) * x + mu + CRITICAL,
        lambda x, mu: 0.5 if x > 0.0 else 1.5,
        borders=lambda x, mu: np.array([x[0], np.inf]),
        exists=lambda mu: mu >= -CRITICAL,
    )
    orbit = orbit_at(form, 0.01 - CRITICAL, 0.02)
    branch = follow(orbit, (0.0, 0.0101), STEPS, upward=False, parameter="a")
    x = np.array([point.orbit.reference.position[0] for point in branch])
    assert np.abs(x) == pytest.approx([2.0 * point.value for point in branch], abs=1e-10)
    assert x.min() < -0.02 < 0.02 == x.max()
    (bifurcation,) = locate_bifurcations(branch)
    assert (bifurcation.kind, bifurcation.is_turning_point) == (BifurcationKind.GRAZING, True)


def test_a_branch_does_not_continue_with_its_mirror_image():
    """The orbits d = ±2μ of d → d/2 ± μ, + for d > 0, meet at a border; there less symmetric orbits begin."""
    form = antisymmetric(
        lambda d, mu: 0.5 * d + np.copysign(mu, d),
        lambda d, mu: 0.5,
        borders=lambda x, mu: np.array([x[0] - x[1], x[1] - x[0]]),
    )
    branch, (bifurcation,) = followed(orbit_at(form, 0.01, [0.02, -0.02], chain=PAIR))
    mu, d, multiplier = leading(branch)
    assert d == pytest.approx(2.0 * mu, abs=1e-10)
    assert multiplier == pytest.approx(0.5)
    assert {point.orbit.stop_counts for point in branch} == {(1, 0)}
    check(bifurcation, BifurcationKind.GRAZING, before=0, after=None)


def test_a_fold_close_to_a_simpler_orbit_is_passed():
    """Of d → (1 + μ)d + d³ − 5000d⁵ the pair μ = −d² + 5000d⁴ folds at d = 0.01, before it meets d = 0."""
    form = antisymmetric(
        lambda d, mu: (1.0 + mu) * d + d**3 - 5000.0 * d**5,
        lambda d, mu: 1.0 + mu + 3.0 * d**2 - 25000.0 * d**4,
    )
    d = 0.014
    orbit = orbit_at(form, -(d**2) + 5000.0 * d**4, [d, -d], chain=PAIR)
    branch = follow(orbit, (CRITICAL - 0.01, CRITICAL + 0.01), upward=False, parameter="a")
    fold, end = locate_bifurcations(branch)
    assert (fold.kind, fold.is_turning_point) == (BifurcationKind.FOLD, True)
    assert fold.value == pytest.approx(CRITICAL - 5e-5, abs=1e-10)
    assert [point.multipliers.unstable_count for point in (fold.before, fold.after)] == [0, 1]
    check(end, BifurcationKind.PITCHFORK, before=1, after=None)


@pytest.mark.parametrize("upward", [True, False])
def test_doubled_orbits_between_two_period_doublings(upward):
    """Of x → −(1 + μ(0.02 − μ))x + x³ they exist for 0 < μ < 0.02 with x² = μ(0.02 − μ)."""

    def excess(mu):
        return mu * (0.02 - mu)

    form = normal_forms.on_line(
        lambda x, mu: -(1.0 + excess(mu)) * x + x**3, lambda x, mu: -(1.0 + excess(mu)) + 3.0 * x**2
    )
    orbit = orbit_at(form, 0.01, 0.01, time=2)
    branch = follow(orbit, (0.09, 0.13), STEPS, upward=upward, parameter="a")
    mu, x, _ = leading(branch[:-1])
    assert x**2 == pytest.approx(excess(mu), abs=1e-10)
    (bifurcation,) = locate_bifurcations(branch)
    assert bifurcation.kind == BifurcationKind.PERIOD_DOUBLING
    assert bifurcation.value == pytest.approx(CRITICAL + 0.02 * upward, abs=1e-10)
    assert bifurcation.after is None
