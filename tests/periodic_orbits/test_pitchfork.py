"""Branching orbits at the loss of synchrony, compared with independent runs and the normal form of a pitchfork."""

import numpy as np
import pytest

from burridge_knopoff import InitialState, Model, OrbitError, Symmetry, multipliers, simulate
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbits
from burridge_knopoff.periodic_orbits.pitchfork import branching_orbit, end_block_asymmetry
from burridge_knopoff.periodic_orbits.synchronized_bifurcations import bifurcations_of, critical_a
from burridge_knopoff.study.paper import PAPER_LAWS
from tests.periodic_orbits.exact import slipping_state


@pytest.fixture(scope="module")
def critical(families):
    """{law: the synchronized orbit at a_c}."""
    return {law: families[law].at(critical_a(bifurcations_of(families[law]))) for law in PAPER_LAWS}


def test_the_branch_is_the_attractor_beyond(families, critical, law):
    """An independent run from a slightly asymmetric state ends on the orbit found by Newton's method."""
    orbit = branching_orbit(critical[law], 1e-2)
    a = orbit.a
    assert a > critical[law].a
    assert orbit.symmetry == Symmetry.ASYMMETRIC
    assert orbit.reference.stuck[[0, 2]].all()
    assert end_block_asymmetry(orbit) == pytest.approx(1e-2, abs=1e-14)
    assert orbit.residual <= 1e-14
    position, velocity = slipping_state(families[law].at(a))
    position[0] += 1e-3
    near = InitialState("near", position, velocity)
    run = simulate(Model(law, a=a), near, transient=8000.0, window=100 * orbit.period, batches=2)
    assert run.mean_distance == pytest.approx(orbit.mean_distance, rel=1e-9)
    # After the last stop of a period both blocks stick, at the distance x_1 − x_3.
    both = run.event_position[:, 0] - run.event_position[:, 2]
    stuck = (run.event_velocity[:, 0] == 0.0) & (run.event_velocity[:, 2] == 0.0)
    assert np.abs(both[stuck]) == pytest.approx(1e-2, abs=1e-9)


def test_the_pitchfork(families, critical, law):
    """Offsets are positive and grow as d² up to the next even order; the multipliers agree with the normal form."""
    d = np.array([2e-4, 4e-4, 8e-4])
    branch = [branching_orbit(critical[law], float(value)) for value in d]
    offset = np.array([orbit.a for orbit in branch]) - critical[law].a
    assert (offset > 0.0).all()
    assert offset / d**2 == pytest.approx(offset[2] / d[2] ** 2, rel=3e-5)
    # Near a pitchfork the decay rate on the branch is twice the growth rate of the central orbit.
    gains = [multipliers(families[law].at(orbit.a)).transverse.real - 1.0 for orbit in branch]
    losses = [1.0 - abs(multipliers(orbit).whole[0]) for orbit in branch]
    assert np.array(losses) / gains == pytest.approx(2.0, rel=2e-3)


def test_an_orbit_does_not_depend_on_the_guess(critical, law):
    direct = branching_orbit(critical[law], 1e-2)
    by_way = branching_orbit(critical[law], 1e-2, branching_orbit(critical[law], 5e-3))
    assert by_way.a == pytest.approx(direct.a, abs=1e-14)
    assert by_way.reference.vector() == pytest.approx(direct.reference.vector(), abs=1e-13)


def test_mirror_images_exist_together(critical):
    first, second = (branching_orbit(critical["linearized"], side * 5e-3) for side in (1, -1))
    assert first.a == pytest.approx(second.a, abs=1e-13)
    assert first.reference.mirrored().vector() == pytest.approx(second.reference.vector(), abs=1e-12)


def test_an_asymmetry_beyond_the_branch_is_refused(critical):
    with pytest.raises(OrbitError):
        branching_orbit(critical["linearized"], 0.2)


def test_a_pitchfork_of_five_blocks():
    """The distance between its orbits also grows as the root of the distance from a_c."""
    orbits = synchronized_orbits(Model("linearized", a=0.08, blocks=5))
    at = orbits.at(critical_a(bifurcations_of(orbits)))
    offset = [branching_orbit(at, d).a - at.a for d in (5e-4, 1e-3)]
    assert offset[1] / offset[0] == pytest.approx(4.0, rel=1e-3)
