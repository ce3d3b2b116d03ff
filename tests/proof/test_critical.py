"""The proved loss of synchrony: a_c, compared with double precision and 50 digits, and the family of orbits."""

from dataclasses import replace
from itertools import pairwise

import pytest
from flint import arb, fmpq

from burridge_knopoff.periodic_orbits.floquet import multipliers
from burridge_knopoff.periodic_orbits.synchronized_bifurcations import bifurcations_of, critical_a
from burridge_knopoff.proof import critical
from burridge_knopoff.proof.balls import ProofError, arithmetic, width
from burridge_knopoff.proof.critical import prove_branch, prove_critical
from burridge_knopoff.proof.krawczyk import enclose
from burridge_knopoff.proof.orbit import arcs_of, equations, prove_orbit
from tests.proof.conftest import holds
from tests.proof.exact import exact_orbit


@pytest.fixture(scope="module")
def critical_orbit(family):
    return prove_critical(family.at(critical_a(bifurcations_of(family))))


@pytest.fixture(scope="module")
def branch(family):
    return prove_branch(family.at(0.086), fmpq(86, 1000), fmpq(88, 1000))


@pytest.mark.slow
def test_the_interval_contains_a_c_of_50_digits_and_of_double_precision(critical_orbit, family):
    guess = [float(value) for value in (*critical_orbit.orbit.enclosure.inner, critical_orbit.a)]
    exact = exact_orbit(guess, None)
    assert holds(critical_orbit.a, exact.a)
    for ball, number in zip(critical_orbit.orbit.enclosure.inner, exact.unknown, strict=True):
        assert holds(ball, number)
    assert holds(critical_orbit.orbit.symmetric_multiplier, exact.symmetric)
    assert width(critical_orbit.a) < 1e-50
    assert abs(critical_a(bifurcations_of(family)) - float(critical_orbit.a)) < 2e-15


def test_the_multiplier_passes_1_at_a_c(critical_orbit, family):
    assert critical_orbit.orbit.multiplier.contains(1)
    assert width(critical_orbit.orbit.multiplier) < 1e-45
    for side, below in ((-1e-12, True), (1e-12, False)):
        with arithmetic():
            a = critical_orbit.a.mid() + arb(side)
            multiplier = prove_orbit(family.at(float(critical_orbit.a) + side), a).multiplier
            assert bool(multiplier < 1) == below
            assert bool(multiplier > 1) != below
            assert abs((multiplier - 1) / arb(side) - critical_orbit.orbit.slope) < 1e-9
    assert critical_orbit.uniqueness_range.contains(critical_orbit.a)
    assert width(critical_orbit.uniqueness_range) > 2e-4


def test_a_guess_far_from_a_c_is_refused(family):
    """Newton's method may converge to anything from there, but Krawczyk's operator rejects it."""
    arcs, guess = arcs_of(family.at(0.2))
    with pytest.raises(ProofError, match="^unknown"):
        enclose(equations(arcs, critical=True), [*map(arb, guess), arb(0.2)], [1e-3] * 7)


def test_a_range_is_covered_without_gaps(branch):
    with arithmetic():
        assert branch[0].orbit.a.contains(arb(86) / 1000)
        assert branch[-1].orbit.a.contains(arb(88) / 1000)
        for left, right in pairwise(branch):
            assert left.orbit.a.overlaps(right.orbit.a)
            assert left.orbit.a.mid() < right.orbit.a.mid()


def test_the_family_contains_the_orbits_in_double_precision(branch, family):
    for a in (0.08605, 0.0869, 0.08751, 0.08799):
        orbit = family.at(a)
        (piece,) = [piece for piece in branch if piece.orbit.a.contains(arb(a))]
        assert piece.orbit.period.contains(arb(orbit.period))
        spectrum = multipliers(orbit)
        assert piece.orbit.multiplier.contains(arb(spectrum.transverse.real))
        assert piece.orbit.symmetric_multiplier.contains(arb(float(spectrum.symmetry_preserving[0].real)))
        with arithmetic():
            piece.check_contains(prove_orbit(orbit, arb(a)).enclosure, arb(a))
        assert piece.orbit.slope > 0


def test_an_orbit_of_another_a_is_not_in_the_family(branch, family):
    for a, piece, at in ((0.09, branch[0], branch[0].orbit.a.mid()), (0.0861, branch[-1], arb(0.0861))):
        other = prove_orbit(family.at(a), arb(a)).enclosure
        with pytest.raises(ProofError, match="family"):
            piece.check_contains(other, at)


def test_pieces_that_do_not_join_are_refused(branch):
    """The box of one piece is moved away from the orbit, so that neighbouring pieces no longer share an orbit."""
    first, second = branch[:2]
    moved = replace(first, middle=[first.middle[0] + arb(0.01), *first.middle[1:]])
    edge = fmpq(86, 1000) + (fmpq(88, 1000) - fmpq(86, 1000)) / len(branch)
    critical._check_same_orbit(first, second, edge)
    with pytest.raises(ProofError):
        critical._check_same_orbit(moved, second, edge)


def test_every_pair_of_neighbours_is_joined(branch, family, monkeypatch):
    joined = []
    check = critical._check_same_orbit
    monkeypatch.setattr(critical, "_check_same_orbit", lambda *pair: (joined.append(pair), check(*pair)))
    pieces = prove_branch(family.at(0.086), fmpq(86, 1000), fmpq(88, 1000))
    assert [pair[:2] for pair in joined] == list(pairwise(pieces))
    assert len(pieces) == len(branch) > 2


def test_a_range_beyond_the_order_of_events_is_refused(family, monkeypatch):
    """At 0.0757 all three blocks start at the same time; the family continues with other arcs."""
    monkeypatch.setattr(critical, "MAX_HALVINGS", 3)
    with pytest.raises(ProofError, match=r"a = 0\.075\d*:.*(block|unknown)"):
        prove_branch(family.at(0.0765), fmpq(75, 1000), fmpq(76, 1000))
