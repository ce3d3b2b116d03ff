"""Kinds of bifurcations from multipliers and orbits, and what is reported about them."""

from types import SimpleNamespace

import numpy as np
import pytest

from burridge_knopoff import Chain, ChainState, Model, Symmetry
from burridge_knopoff.periodic_orbits import bifurcations
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.periodic_orbits.bifurcations import Bifurcation, locate_bifurcations
from burridge_knopoff.periodic_orbits.following import BranchOrbit
from burridge_knopoff.periodic_orbits.parameter_line import line_along_a
from burridge_knopoff.periodic_orbits.periodic import orbit_of
from tests import normal_forms
from tests.normal_forms import CRITICAL, THREE, MapModel, followed, orbit_at, pitchfork
from tests.periodic_orbits.stand_in import stand_in

LINE = line_along_a(Chain(3))


@pytest.mark.parametrize(
    ("values", "kind"),
    [
        # A pair on the unit circle.
        ((0.6 + 0.8j, 0.6 - 0.8j, 0.2), BifurcationKind.NEIMARK_SACKER),
        # A real pair whose product is 1, together with a complex pair that is closer to the unit circle.
        ((2.0, 0.5, 0.7 + 0.6j, 0.7 - 0.6j), None),
        # A real multiplier closer to the unit circle than the pair.
        ((1.000001, 0.8 + 0.61j, 0.8 - 0.61j, 0.1), BifurcationKind.NEIMARK_SACKER),
        # Pairs that are complex, and real up to rounding, near the point where they meet on the real axis.
        ((1.0 + 2e-6j, 1.0 - 2e-6j, 0.1), BifurcationKind.NEIMARK_SACKER),
        ((1.0 + 5e-7j, 1.0 - 5e-7j, 0.1), None),
    ],
)
def test_a_pair_with_product_1_distinguishes_a_torus_from_a_saddle(values, kind):
    saddle = np.array([2.0, 0.5])
    point = SimpleNamespace(multipliers=SimpleNamespace(symmetry_preserving=np.array(values), symmetry_breaking=saddle))
    assert bifurcations.kind_at(point, (BifurcationKind.NEIMARK_SACKER, "symmetry_preserving")) == kind
    # The test applies to symmetry-breaking and to symmetry-preserving perturbations.
    point = SimpleNamespace(multipliers=SimpleNamespace(symmetry_preserving=saddle, symmetry_breaking=np.array(values)))
    assert bifurcations.kind_at(point, (BifurcationKind.NEIMARK_SACKER, "symmetry_breaking")) == kind


@pytest.mark.parametrize(
    ("kind", "sticks", "shortest"),
    [
        (BifurcationKind.GRAZING, [0.5, 0.9e-4, np.inf], 0.0),
        (BifurcationKind.GRAZING, [0.5, 1.1e-4, np.inf], 1.1e-4),
        (BifurcationKind.PERIOD_DOUBLING, [0.5, 0.9e-4, np.inf], 0.9e-4),
    ],
)
def test_a_short_stick_counts_as_0_at_a_grazing(kind, sticks, shortest):
    """Within 1e-10 of the grazing, a duration that vanishes like a root is shorter than 1e-4."""
    orbit = SimpleNamespace(model=Model("linearized", a=0.1))
    point = SimpleNamespace(orbit=orbit, grazing_distances=SimpleNamespace(stick=np.array(sticks)))
    assert Bifurcation(0.1, 1e-9, kind, point, point, None, is_turning_point=False).stick_time == shortest


@pytest.mark.parametrize(("before", "expected"), [(2.0004, 2.0), (3.9996, 4.0), (6.01, 6.0)])
def test_the_period_at_a_bifurcation_is_that_of_the_orbits_before_it(before, expected):
    """The period of a branch that joins an orbit is two or three times that of this orbit."""
    points = [SimpleNamespace(orbit=SimpleNamespace(period=period)) for period in (2.0, before)]
    assert (
        Bifurcation(0.1, 1e-9, BifurcationKind.PERIOD_DOUBLING, *points, None, is_turning_point=False).period
        == expected
    )


@pytest.mark.parametrize(
    ("distance", "slope", "beyond", "a", "error", "turns"),
    [
        (1e-3, 0.5, 0.2, 0.1005, 5e-4, False),
        (1e-3, -0.5, -0.2, 0.0995, 5e-4, False),
        (1e-3, -0.5, 0.2, 0.0995, 5e-4, True),
        (1e-3, 0.5, -0.2, 0.1005, 5e-4, True),
        (1e-3, 0.5, None, 0.1005, 5e-4, False),
        (1e-11, 0.01, 0.2, 0.1, 1e-12, False),
    ],
)
def test_an_orbit_grazes_at_the_length_that_is_left(distance, slope, beyond, a, error, turns):
    point = stand_in(
        BranchOrbit, line=LINE, value=0.1, distance_to_grazing=distance, tangent=[9.0, slope], is_grazing=True
    )
    following = [] if beyond is None else [stand_in(BranchOrbit, line=LINE, tangent=[-9.0, beyond], is_grazing=False)]
    (bifurcation,) = locate_bifurcations([point, *following])
    assert (bifurcation.kind, bifurcation.is_turning_point) == (BifurcationKind.GRAZING, turns)
    assert (bifurcation.a, bifurcation.error) == (
        pytest.approx(a, abs=1e-12),
        pytest.approx(error, rel=1e-9, abs=0.0),
    )
    assert bifurcation.at is bifurcation.before is point
    assert bifurcation.after is (following[0] if following else None)


@pytest.mark.parametrize(("away", "kind"), [(0.9e-4, BifurcationKind.PITCHFORK), (1.1e-4, BifurcationKind.FOLD)])
def test_a_fold_next_to_a_simpler_orbit_is_where_that_one_branches(away, kind):
    """At a distance from the synchronized orbit whose symmetry breaks."""
    model = MapModel(pitchfork(1.0), Chain(2))
    start = ChainState(0.5 * away * np.array([1.0, -1.0]), np.full(2, 0.5), np.zeros(2, dtype=bool))
    point = SimpleNamespace(orbit=orbit_of(model, start, 1.0, Symmetry.ASYMMETRIC))
    assert bifurcations.kind_at(point, (BifurcationKind.FOLD, "symmetry_preserving")) == kind


@pytest.mark.parametrize(
    ("symmetry", "period", "kind"),
    [
        (Symmetry.SYMMETRIC, 2.0, BifurcationKind.PITCHFORK),
        (Symmetry.ASYMMETRIC, 1.0, BifurcationKind.PERIOD_DOUBLING),
        (Symmetry.ASYMMETRIC, 2.0, None),
    ],
)
def test_the_beginning_of_a_branch_determines_its_bifurcation(symmetry, period, kind):
    orbit = SimpleNamespace(symmetry=Symmetry.ASYMMETRIC, period=2.0)
    assert bifurcations._branch_point_kind(orbit, SimpleNamespace(symmetry=symmetry, period=period)) == kind


@pytest.mark.parametrize("c", [0.0, 1.0])
def test_a_multiplier_1_is_no_bifurcation_where_another_symmetry_breaks(c):
    """x = 0 of x → (1 + μ)x − cx³ has the multiplier 1 + μ, but x → −x is no mirror symmetry of the chain."""
    form = normal_forms.on_line(lambda x, mu: (1.0 + mu) * x - c * x**3, lambda x, mu: 1.0 + mu - 3.0 * c * x**2)
    branch, bifurcations = followed(orbit_at(form, -0.01, 0.0))
    assert [point.multipliers.unstable_count for point in (branch[0], branch[-1])] == [0, 1]
    assert bifurcations == []


def test_two_real_multipliers_whose_product_is_1_are_no_bifurcation():
    form = normal_forms.linear(lambda mu: np.diag([2.0 * (1.0 + mu), 0.5, 0.1]))
    _, bifurcations = followed(orbit_at(form, -0.01, 0.0, chain=THREE))
    assert bifurcations == []


def test_bifurcations_within_a_step_come_in_the_order_of_the_branch():
    """A pair leaves the unit circle at μ = −0.0004 and a multiplier reaches −1 at 0.0007, or the reverse."""
    turn = np.array([[0.6, -0.8], [0.8, 0.6]])

    def matrix(mu):
        whole = np.zeros((3, 3))
        whole[:2, :2], whole[2, 2] = (1.0004 + mu) * turn, -1.0 - (mu - 0.0007)
        return whole

    kinds = BifurcationKind.NEIMARK_SACKER, BifurcationKind.PERIOD_DOUBLING
    for mu, order in ((-0.01, 1), (0.01, -1)):
        _, bifurcations = followed(orbit_at(normal_forms.linear(matrix), mu, 0.0, chain=THREE))
        assert bifurcations[0].before is bifurcations[1].before
        assert tuple(item.kind for item in bifurcations) == kinds[::order]
        assert [item.value - CRITICAL for item in bifurcations] == pytest.approx([-0.0004, 0.0007][::order], abs=1e-12)


@pytest.mark.parametrize(("hidden", "error"), [(0.0, 1e-11), (3e-9, 1e-8), (3e-8, 1e-7)])
@pytest.mark.parametrize("rate", [1.0, 5.0])
def test_the_error_of_a_bifurcation_is_the_bracket_in_which_its_sign_changes(hidden, error, rate):
    """The multiplier is −1 as far as `hidden` from μ = 0."""
    form = normal_forms.linear(lambda mu: np.diag([-1.0 - rate * mu * (abs(mu) > hidden)]))
    _, (bifurcation,) = followed(orbit_at(form, -0.01, 0.0, chain=Chain(1)))
    assert abs(bifurcation.value - CRITICAL) <= bifurcation.error
    assert bifurcation.error == pytest.approx(error, rel=1e-2, abs=0.0)


def test_a_multiplier_that_remains_1_or_is_lost_is_not_a_bifurcation():
    """The sign does not change within 1e-7, or there is no map there."""
    forms = (
        normal_forms.linear(lambda mu: np.diag([-1.0 - mu * (abs(mu) > 1.1e-7)])),
        normal_forms.linear(lambda mu: np.diag([-1.0 - mu]), exists=lambda mu: abs(mu) > 1e-4),
    )
    for form in forms:
        branch, bifurcations = followed(orbit_at(form, -0.01, 0.0, chain=Chain(1)))
        assert branch[-1].value > CRITICAL
        assert bifurcations == []
