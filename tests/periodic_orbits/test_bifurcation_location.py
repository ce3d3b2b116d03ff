"""Location and kind of bifurcations on hand-made branches with known values, tangents and orbits."""

from types import SimpleNamespace

import numpy as np
import pytest

from burridge_knopoff import Chain, Model, OrbitError, Symmetry, law_of
from burridge_knopoff.periodic_orbits import bifurcations
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.periodic_orbits.bifurcations import Bifurcation, locate_bifurcations
from burridge_knopoff.periodic_orbits.floquet import Multipliers
from burridge_knopoff.periodic_orbits.following import BranchOrbit
from burridge_knopoff.periodic_orbits.parameter_line import line_along_a
from tests.periodic_orbits.stand_in import only, stand_in

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


@pytest.fixture
def branch(monkeypatch):
    """Return a function that makes a branch from functions of the length: a, and the multiplier minus `at`."""

    def point_at(value, a=lambda length: length, at=-1.0):
        def point(length, slope=1.0):
            orbit = SimpleNamespace(symmetry=Symmetry.ASYMMETRIC, period=1.0)
            fields = {"value": a(length), "multipliers": only(at + value(length)), "length": length, "tangent": [slope]}
            return stand_in(BranchOrbit, line=LINE, orbit=orbit, **fields)

        monkeypatch.setattr(bifurcations, "step_along", lambda first, length: point(length))
        return point

    return point_at


@pytest.mark.parametrize(
    ("slopes", "kind"), [((1.0, -1.0), BifurcationKind.FOLD), ((1.0, 1.0), None), ((-1.0, -1.0), None)]
)
def test_a_branch_turns_back_in_a_at_a_fold(monkeypatch, branch, slopes, kind):
    """If the branch does not turn back, a symmetry other than the mirror symmetry breaks."""
    point = branch(lambda length: length - 0.3, at=1.0)
    monkeypatch.setattr(
        bifurcations, "minimal_form", lambda orbit, _: SimpleNamespace(symmetry=orbit.symmetry, period=1.0)
    )
    root = bifurcations._root(
        point(0.0, slopes[0]), point(0.5, slopes[1]), (BifurcationKind.FOLD, "symmetry_preserving")
    )
    assert (None if root is None else root[1].kind) == kind
    if root is not None:
        assert root[0] == pytest.approx(0.3)
        assert root[1].is_turning_point


@pytest.mark.parametrize(
    ("place", "dead", "error"),
    [
        # Noise that hides the sign within 3e-9, and noise that hides it within 3e-8.
        (lambda length: length, 3e-9, 1e-8),
        (lambda length: length, 3e-8, 1e-7),
        (lambda length: 3.0 * length, 0.0, 3e-11),
        # The branch turns back there, so that a is the same on both sides.
        (lambda length: -1e6 * (length - 0.3) ** 2, 3e-9, 1e-10),
        (lambda length: 0.0, 0.0, 1e-12),
    ],
)
def test_the_place_of_a_bifurcation_is_known_within_where_the_sign_changes(branch, place, dead, error):
    """The error is at least the rounding error of a."""
    point = branch(lambda length: np.expm1(3.0 * (length - 0.3)) if abs(length - 0.3) > dead else 0.0, place)
    (bifurcation,) = bifurcations._roots(point(0.0), point(0.5))
    assert bifurcation.a == pytest.approx(place(0.3))
    assert bifurcation.error == pytest.approx(error, rel=1e-3, abs=0.0)
    assert (bifurcation.before.length, bifurcation.after.length) == (0.0, 0.5)


def test_noise_of_one_sign_is_not_a_bifurcation(monkeypatch, branch):
    """If noise hides the sign within 3e-9, the bracket of the bifurcation has a half-width of 1e-8."""
    point = branch(lambda length: length - 0.3 if abs(length - 0.3) > 3e-9 else 1e-15)
    monkeypatch.setattr(bifurcations, "brentq", lambda value, low, high, **_: 0.3)
    (bifurcation,) = bifurcations._roots(point(0.0), point(0.5))
    assert bifurcation.error == pytest.approx(1e-8, rel=1e-3, abs=0.0)


def test_a_value_that_remains_0_is_not_a_bifurcation(monkeypatch, branch):
    """There is no bifurcation if the sign is the same 1e-7 away on both sides, or if an orbit is not found."""

    def lost(first, length):
        raise OrbitError("none")

    point = branch(lambda length: length - 0.3 if abs(length - 0.3) > 1.1e-7 else 0.0)
    assert bifurcations._roots(point(0.0), point(0.5)) == []
    monkeypatch.setattr(bifurcations, "step_along", lost)
    assert bifurcations._roots(point(0.0), point(0.5)) == []


def test_bifurcations_between_two_orbits_come_in_the_order_of_the_branch(monkeypatch):
    """A pair leaves the unit circle, one multiplier reaches 1 and one reaches −1; another one would do so later."""

    def point(length):
        pair = (1.0 + length - 0.1) * np.array([0.6 + 0.8j, 0.6 - 0.8j])
        keeping = np.array([*pair, -1.0 - (length - 0.4), 1.0 + 0.1 * (length - 0.7)])
        multipliers = Multipliers(keeping, np.array([1.0 + length - 0.2]), power=1)
        orbit = SimpleNamespace(symmetry=Symmetry.SYNCHRONIZED)
        fields = {"value": 0.1 + length, "multipliers": multipliers, "length": length, "tangent": [1.0]}
        return stand_in(BranchOrbit, line=LINE, orbit=orbit, **fields)

    monkeypatch.setattr(bifurcations, "step_along", lambda first, length: point(length))
    roots = bifurcations._roots(point(0.0), point(0.5))
    assert [bifurcation.a for bifurcation in roots] == pytest.approx([0.2, 0.3, 0.5])
    assert [bifurcation.kind for bifurcation in roots] == [
        BifurcationKind.NEIMARK_SACKER,
        BifurcationKind.PITCHFORK,
        BifurcationKind.PERIOD_DOUBLING,
    ]


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
    orbit = SimpleNamespace(model=Model(Chain(3), law_of("linearized", 0.1)))
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


@pytest.mark.parametrize(
    ("upward", "downward", "expected"),
    [
        ([(0.13, BifurcationKind.PERIOD_DOUBLING)], [(0.118, BifurcationKind.PERIOD_DOUBLING)], 0.118),
        ([(0.121, BifurcationKind.PERIOD_DOUBLING)], [(0.118, BifurcationKind.PERIOD_DOUBLING)], 0.121),
        ([(0.121, BifurcationKind.FOLD), (0.124, BifurcationKind.PERIOD_DOUBLING)], [], 0.124),
        ([], [(0.1, BifurcationKind.PITCHFORK), (0.09, BifurcationKind.PERIOD_DOUBLING)], 0.09),
        ([(0.121, BifurcationKind.FOLD)], [], None),
    ],
)
def test_a_branch_joins_a_simpler_one_at_the_nearest_bifurcation_of_the_latter(monkeypatch, upward, downward, expected):
    """The search goes in both directions, over the length of the last steps and twice the last change of a."""
    calls, original = [], locate_bifurcations

    def followed(orbit, interval, *, parameter, upward):
        assert parameter == "a"
        calls.append((orbit, *interval))
        return upward

    def located(branch):
        if branch not in (True, False):
            return original(branch)
        roots = upward if branch else downward
        return [Bifurcation(a, 1e-9, kind, "simple", None, None, is_turning_point=True) for a, kind in roots]

    monkeypatch.setattr(bifurcations, "follow", followed)
    monkeypatch.setattr(bifurcations, "locate_bifurcations", located)
    simple = SimpleNamespace(symmetry=Symmetry.ASYMMETRIC, period=1.0)
    orbit = SimpleNamespace(symmetry=Symmetry.ASYMMETRIC, period=2.0)
    point = stand_in(BranchOrbit, line=LINE, orbit=orbit, value=0.11, length=0.02, is_grazing=False)
    end = stand_in(BranchOrbit, line=LINE, orbit=orbit, value=0.12, length=0.03, reduced_orbit=simple, is_grazing=False)
    roots = list(original([point, end]))
    assert calls == [(simple, pytest.approx(0.05), pytest.approx(0.19))] * 2
    if expected is None:
        assert roots == []
        return
    (bifurcation,) = roots
    assert (bifurcation.a, bifurcation.error, bifurcation.kind, bifurcation.at) == (
        expected,
        1e-9,
        BifurcationKind.PERIOD_DOUBLING,
        "simple",
    )
    assert bifurcation.before is point
    assert bifurcation.after is None
    assert not bifurcation.is_turning_point


@pytest.mark.parametrize(
    ("symmetry", "away", "kind"),
    [
        (Symmetry.ASYMMETRIC, 0.9e-4, BifurcationKind.PITCHFORK),
        (Symmetry.ASYMMETRIC, 1.1e-4, BifurcationKind.FOLD),
        (Symmetry.SYNCHRONIZED, 0.0, BifurcationKind.FOLD),
    ],
)
def test_a_fold_next_to_a_simpler_orbit_is_where_that_one_branches(monkeypatch, symmetry, away, kind):
    """Synchronized orbits have no simpler form."""
    orbit, simple = (SimpleNamespace(symmetry=s, period=2.0) for s in (symmetry, Symmetry.SYMMETRIC))
    monkeypatch.setattr(bifurcations, "minimal_form", lambda orbit, tolerance: simple if away <= tolerance else orbit)
    assert bifurcations.kind_at(SimpleNamespace(orbit=orbit), (BifurcationKind.FOLD, "symmetry_preserving")) == kind
    assert (
        bifurcations.kind_at(SimpleNamespace(orbit=orbit), (BifurcationKind.PERIOD_DOUBLING, "symmetry_preserving"))
        == BifurcationKind.PERIOD_DOUBLING
    )


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
