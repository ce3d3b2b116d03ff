"""Loss of synchrony, grazing and period doubling, compared with independent computations."""

from dataclasses import replace

import numpy as np
import pytest

from burridge_knopoff import BifurcationKind, Chain, Model, Symmetry, multipliers
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbits
from burridge_knopoff.periodic_orbits.flow import flow
from burridge_knopoff.periodic_orbits.known_orbits import KnownOrbits
from burridge_knopoff.periodic_orbits.pitchfork import displace_end_blocks
from burridge_knopoff.periodic_orbits.synchronized_bifurcations import (
    bifurcations_of,
    critical_a,
    critical_a_error,
    finite_difference_multiplier,
    grazing_a,
    symmetric_period_doubling_a,
)
from burridge_knopoff.study.paper import PAPER_LAWS
from tests.normal_forms import CRITICAL, NormalForm, antisymmetric, orbit_at
from tests.periodic_orbits.exact import after_a_period, exact_transverse_multiplier, slipping_state


def transverse(orbit):
    return multipliers(orbit).transverse.real


@pytest.fixture(scope="module")
def bifurcations(families):
    return {law: bifurcations_of(families[law]) for law in PAPER_LAWS}


@pytest.fixture(scope="module")
def critical(bifurcations):
    return {law: critical_a(bifurcations[law]) for law in PAPER_LAWS}


def test_the_bifurcations_of_the_papers_orbits(bifurcations, law):
    assert [bifurcation.kind for bifurcation in bifurcations[law]] == [
        BifurcationKind.GRAZING,
        BifurcationKind.PITCHFORK,
        BifurcationKind.PERIOD_DOUBLING,
    ]


def test_critical_a_has_the_proved_digits(critical):
    """The digits are those proved in `proof`."""
    proved = {"linearized": 0.0869729046660773, "nonlinear": 0.0887172229711765}
    assert critical == pytest.approx(proved, abs=1e-14)


def test_critical_a_in_exact_arithmetic(families, critical, law):
    """In 40-digit arithmetic the multiplier at a_c is 1; its slope converts the deviation into an error of a_c."""
    orbits, a = families[law], critical[law]
    slope = (transverse(orbits.at(a + 1e-4)) - transverse(orbits.at(a - 1e-4))) / 2e-4
    assert slope > 5.0
    assert abs(exact_transverse_multiplier(orbits.at(a)) - 1.0) / slope < 1e-12
    assert critical_a_error(orbits, a) < 1e-11


def test_grazing_a_in_exact_arithmetic(families, bifurcations, law):
    """In 40-digit arithmetic block 2 sticks on one side of the grazing and does not on the other."""
    a = grazing_a(bifurcations[law], block=1)
    for side, sticks in ((-1, False), (1, True)):
        orbit = families[law].at(a + side * 2e-12)
        run = after_a_period(orbit, *slipping_state(orbit))
        assert (2 in {block for _, block, _ in run.events}) == sticks
        assert (orbit.stick_time(1) > 0.0) == sticks
    # The end blocks stick at every a.
    assert np.isnan(grazing_a(bifurcations[law], block=0))


def test_the_symmetric_multiplier_is_minus_1_at_the_period_doubling(families, bifurcations, law):
    a = symmetric_period_doubling_a(bifurcations[law])
    assert multipliers(families[law].at(a)).symmetry_preserving[0] == pytest.approx(-1.0, abs=1e-12)


def test_without_bifurcations_critical_values_are_nan():
    assert np.isnan([critical_a([]), symmetric_period_doubling_a([]), grazing_a([], block=1)]).all()


def test_grazing_next_to_an_orbit_that_is_not_found():
    """With stiff coupling it lies between values of a at which the multipliers are very different."""
    orbits = synchronized_orbits(Model("linearized", a=0.05, coupling=30.0))
    a = grazing_a(bifurcations_of(orbits), block=1)
    assert 0.025 < a < 0.0375
    assert orbits.at(a - 1e-9).stick_time(1) == 0.0 < orbits.at(a + 1e-9).stick_time(1)


@pytest.mark.parametrize("lost", [(0.0, 0.03), (0.05, 0.06), (0.2, 1.0)])
def test_bifurcations_around_a_gap_of_the_orbit_are_found(lost):
    """The branch may be interrupted below, above, or on both sides of a bifurcation.

    The middle block of the map begins to stick at a = 0.035, and the end blocks lose synchrony at a = 0.1.
    """

    def map(x, mu):
        d = 0.5 * (x[0] - x[2])
        return np.array([1.0, 0.0, -1.0]) * ((1.0 + mu) * d - d**3) + np.array([0.0, 0.5 * x[1] + mu + 0.065, 0.0])

    def derivative(x, mu):
        slope = 1.0 + mu - 0.75 * (x[0] - x[2]) ** 2
        return np.array([[0.5 * slope, 0.0, -0.5 * slope], [0.0, 0.5, 0.0], [-0.5 * slope, 0.0, 0.5 * slope]])

    form = NormalForm(
        map,
        derivative,
        borders=lambda x, mu: np.array([1.0, x[1], 1.0]),
        exists=lambda mu: not lost[0] <= mu + CRITICAL <= lost[1],
    )
    orbits = KnownOrbits(orbit_at(form, -0.02, 0.0, Symmetry.SYNCHRONIZED, Chain(3)))
    # An orbit on the other side of the gap.
    below = orbit_at(form, -0.06, 0.0, Symmetry.SYNCHRONIZED, Chain(3))
    orbits.orbits[below.a] = below
    located = bifurcations_of(orbits)
    assert [bifurcation.kind for bifurcation in located] == [BifurcationKind.GRAZING, BifurcationKind.PITCHFORK]
    assert critical_a(located) == pytest.approx(CRITICAL, abs=1e-14)
    assert grazing_a(located, block=1) == pytest.approx(0.035, abs=1e-14)
    assert np.isnan(grazing_a(located, block=0))


@pytest.mark.parametrize("a", [0.02, 0.09, 0.2])
def test_finite_differences_agree_with_the_tangent_map(families, law, a):
    orbit = families[law].at(a)
    assert finite_difference_multiplier(orbit) == pytest.approx(transverse(orbit), abs=1e-9)


def test_differences_of_blocks_1_and_3_decay_below_a_c_and_grow_above(families, critical, law):
    for offset in (-0.002, 0.002):
        orbit = families[law].at(critical[law] + offset)
        start, end = (
            flow(orbit.model, displace_end_blocks(orbit.reference, 1e-8), turns * orbit.period).state()
            for turns in (1, 101)
        )
        first, last = (state.position[0] - state.position[2] for state in (start, end))
        assert last / first == pytest.approx(transverse(orbit) ** 100, rel=1e-5)
        assert (abs(last) > abs(first)) == (offset > 0.0)


def test_critical_a_does_not_depend_on_v_under_the_linearized_law(families, critical):
    """Divided by v, the linearized equations do not contain v; under the nonlinear law a_c moves with a·v."""
    a = {
        law: critical_a(bifurcations_of(synchronized_orbits(replace(families[law].model, v=0.05))))
        for law in PAPER_LAWS
    }
    assert a["linearized"] == pytest.approx(critical["linearized"], abs=1e-13)
    assert critical["linearized"] < a["nonlinear"] < critical["nonlinear"] - 5e-4


@pytest.mark.parametrize(("strength", "threshold"), [(25.0, 1.0), (0.04, 1.0), (1.0, 0.125), (4.0, 3.0)])
def test_transitions_are_found_on_the_scale_of_the_chain(critical, bifurcations, strength, threshold):
    """Springs stiffer by a factor make all motion faster by its square root; a times the threshold is what matters."""
    springs = {"coupling": strength, "pulling": (strength, 2.0 * strength, strength)}
    orbits = synchronized_orbits(Model("linearized", a=0.0, blocks=3, threshold=threshold, **springs))
    factor = strength**0.5 / threshold
    assert orbits.model.chain.a_unit == pytest.approx(factor)
    located = bifurcations_of(orbits)
    assert critical_a(located) == pytest.approx(factor * critical["linearized"], rel=1e-9)
    assert grazing_a(located, block=1) == pytest.approx(
        factor * grazing_a(bifurcations["linearized"], block=1), rel=1e-9
    )
    assert critical_a_error(orbits, critical_a(located)) < 1e-10 * factor


def test_two_blocks_desynchronize_in_a_period_doubling():
    """Each block does in one period what the other does in the next, so that the transverse multiplier is −1."""
    orbits = synchronized_orbits(Model("linearized", a=0.05, blocks=2))
    located = bifurcations_of(orbits)
    a = critical_a(located)
    assert multipliers(orbits.at(a)).transverse == pytest.approx(-1.0, abs=1e-12)
    # It is not a period doubling of synchronized motion.
    assert np.isnan(symmetric_period_doubling_a(located))


def test_a_c_is_that_of_an_orbit_that_attracts_within_synchrony(bifurcations, critical):
    """At coupling 1.2 the orbit repels symmetric perturbations at its a_c; with weak thresholds a_c is five times as
    large and its orbit attracts them.
    """
    weak, stiff = (
        bifurcations_of(synchronized_orbits(Model("linearized", a=0.1, chain=chain)))
        for chain in (Chain(3, threshold=0.2), Chain(3, coupling=1.2))
    )
    assert critical_a(stiff) == pytest.approx(0.19534254, abs=1e-8)
    assert critical_a([*stiff, *weak]) == pytest.approx(5.0 * critical["linearized"], rel=1e-9)


def test_five_blocks_desynchronize_where_the_leading_multiplier_is_1():
    orbits = synchronized_orbits(Model("linearized", a=0.08, blocks=5))
    a = critical_a(bifurcations_of(orbits))
    assert [abs(multipliers(orbits.at(a + side)).transverse) > 1.0 for side in (-1e-6, 1e-6)] == [False, True]


def test_the_error_of_critical_a_follows_from_the_error_of_the_multiplier():
    """A multiplier with slope 5 that is too small by 0.01 reaches 1 at an a larger by 0.002."""
    form = antisymmetric(lambda d, mu: (0.99 + 5.0 * mu) * d, lambda d, mu: 1.0 + 5.0 * mu)
    orbits = KnownOrbits(orbit_at(form, -0.01, 0.0, Symmetry.SYNCHRONIZED, Chain(2)))
    assert critical_a_error(orbits, CRITICAL) == pytest.approx(0.002, rel=1e-9)
