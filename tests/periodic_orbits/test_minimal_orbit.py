"""Reduction of orbits to forms of more symmetry or of a shorter period."""

import pytest

from burridge_knopoff import Chain, Symmetry
from burridge_knopoff.periodic_orbits.minimal_orbit import minimal_form
from tests.normal_forms import orbit_at, period_doubling, pitchfork


@pytest.mark.parametrize(("v", "largest"), [(0.1, 0.1), (1.0, 0.01)])
def test_a_doubled_orbit_reduces_to_the_single_one_within_a_tolerance(v, largest):
    """Half a period later ±√μ is 2√μ = 0.1 away; tolerances are for v = 0.1."""
    orbit = orbit_at(period_doubling(1.0), 0.0025, 0.05, time=2, v=v)
    assert minimal_form(orbit, 0.99 * largest) is orbit
    single = minimal_form(orbit, 1.01 * largest)
    assert single.period == pytest.approx(1.0)
    assert abs(single.reference.position[0]) < 1e-10


def test_an_asymmetric_orbit_reduces_to_the_synchronized_one_within_a_tolerance():
    """Its mirror image is 2√μ = 0.1 away."""
    orbit = orbit_at(pitchfork(1.0), 0.0025, [0.05, -0.05], chain=Chain(2))
    assert minimal_form(orbit, 0.099) is orbit
    assert minimal_form(orbit, 0.101).symmetry == Symmetry.SYNCHRONIZED


def test_an_orbit_found_with_a_multiple_of_its_period_reduces_to_it():
    """A stop-by-stop repetition has all stops a multiple of times."""
    orbit = orbit_at(period_doubling(1.0), 0.0025, 0.05, time=6)
    assert orbit.stop_counts == (6, 6)
    reduced = minimal_form(orbit, 1e-8)
    assert (reduced.period, reduced.stop_counts) == (pytest.approx(2.0), (2, 2))
